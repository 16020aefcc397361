// bench_fetch: what one look-up of the walk volume and one of a pyramid cost on this machine, in a volume that fits into
// the caches and in one that does not. Prints JSON; tools/bench.py divides counted look-ups by it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "app/context.hpp"
#include "gl/pixel_pass.hpp"

using namespace conebook;

namespace {

// ms that one picture takes, the fastest of five.
double draw_ms(const gl::Program& program, const gl::Framebuffer& framebuffer, const gl::VertexArray& no_vertices,
               glm::ivec2 size)
{
    double fastest = HUGE_VAL;
    for (int i = 0; i < 5; ++i) {
        glFinish();
        const auto start = std::chrono::steady_clock::now();
        gl::draw_pixels(program, framebuffer, no_vertices, size);
        glFinish();
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
        fastest = std::min(fastest, elapsed.count());
    }
    return fastest;
}

}  // namespace

int main(int argc, char** argv)
try {
    if (argc != 2) throw std::runtime_error("usage: bench_fetch PIXELS ALONG A SIDE");
    const int pixels = std::atoi(argv[1]);
    if (pixels < 4 || pixels > 4096) throw std::runtime_error(std::string(argv[1]) + ": must be 4 .. 4096");
    const Context context = Context::headless();
    const char* root = std::getenv("CONEBOOK_ROOT");
    if (root == nullptr) throw std::runtime_error("CONEBOOK_ROOT is not set: the folder of the repository");
    gl::Shaders shaders(std::string(root) + "/shaders");
    const gl::VertexArray no_vertices;
    gl::Texture color;
    gl::Framebuffer framebuffer;
    const glm::ivec2 size(pixels);
    gl::fit_to_pixels(color, framebuffer, "sums", GL_RGBA32F, size);
    std::printf("[");
    bool first = true;
    for (const bool trilinear : {false, true})
        for (const double megabytes : {2.0, 50.0}) {
            const int texel_bytes = trilinear ? 8 : 4;
            const int side = int(std::cbrt(megabytes * 1e6 / texel_bytes));
            const gl::Texture volume = gl::texture_3d("volume", trilinear ? GL_RGBA16F : GL_R32UI, glm::ivec3(side));
            volume.clear();
            const GLenum filter = trilinear ? GL_LINEAR : GL_NEAREST;
            volume.set_filter(filter, filter);
            volume.set_wrap(GL_CLAMP_TO_EDGE);
            volume.bind(0);
            const gl::Program program =
                shaders.load({"common/fullscreen.vert", "14_speed_against_error/bench_fetch.frag"},
                             {{"TRILINEAR", trilinear ? "1" : "0"}});
            program.set("side", side);
            program.set("inverse_size", 1.0f / glm::vec2(size));
            // Two numbers of look-ups: their difference has nothing in it of what a pixel costs beside.
            constexpr int kFew = 16, kMany = 144;
            program.set("look_ups", kFew);
            const double few_ms = draw_ms(program, framebuffer, no_vertices, size);
            program.set("look_ups", kMany);
            const double many_ms = draw_ms(program, framebuffer, no_vertices, size);
            const double ns = 1e6 * std::max(many_ms - few_ms, 0.0) / (double(kMany - kFew) * pixels * pixels);
            std::printf("%s\n {\"look_up\": \"%s\", \"bytes\": %zu, \"ns\": %.4g}", first ? "" : ",",
                        trilinear ? "trilinear rgba16f" : "texel r32ui", volume.bytes(), ns);
            first = false;
        }
    std::printf("\n]\n");
    return 0;
} catch (const std::exception& error) {
    std::cerr << "bench_fetch: " << error.what() << "\n";
    return 1;
}
