// make_assets [OUTPUT_DIR]: writes every scene of this project's own as OUTPUT_DIR/name.glb (default: assets/).
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "scenes.hpp"

int main(int argc, char** argv) {
    using namespace conebook::generator;
    try {
        if (argc > 2) {
            throw std::runtime_error("usage: make_assets [OUTPUT_DIR]");
        }
        const std::filesystem::path folder = argc == 2 ? argv[1] : CONEBOOK_ASSETS_DIR;
        if (!std::filesystem::is_directory(folder)) {
            throw std::runtime_error(folder.string() + ": no such folder");
        }
        for (const Asset& asset : {cornell_box(), cornell_area(), cornell_empty(), white_furnace(), thin_wall(),
                                   thin_wall_solid(), lights(), glossy_room(), emissive_shapes(), materials(),
                                   colonnade(), door(), walking_lamp(), spinning_shapes(), figure()}) {
            const auto file = folder / (asset.name + ".glb");
            write_glb(asset, file);
            std::printf("%-20s %8ju bytes\n", (asset.name + ".glb").c_str(),
                        static_cast<std::uintmax_t>(std::filesystem::file_size(file)));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_assets: %s\n", error.what());
        return 1;
    }
    return 0;
}
