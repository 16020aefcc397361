// Which patches become lights: what a light sees, drawn small, and reduced to one patch a cell.
#pragma once

#include "19_vertex_radiosity/radiosity_map.hpp"

namespace conebook {

enum class Pick : int { maximum, flux };
enum class Borders : int { keep, drop };

struct PickParams {
    // Texels along a side of what a light sees, 16 .. 512: the flux of a texel goes to one patch.
    int m = 64;
    // Cells along a side, each of which makes one light, 1 .. 64 (the document has 8); halved until all views
    // together make at most 4096 lights. 0: up to 32, as long as they make at most 2048.
    int cells = 0;
    // Which of a cell's texels becomes the light: the brightest patch (the document), or one drawn by its share of
    // the flux.
    Pick pick = Pick::flux;
    // The document leaves out the cells on the border, and their light is lost.
    Borders borders = Borders::keep;
    bool operator==(const PickParams&) const = default;
};
void add_parameters(ParameterTable& table, PickParams& params);
// Throws std::runtime_error, which names both, when there are more cells than texels.
void check(const PickParams& params);
// How many lights a bounce has where nobody says: 2048, and fewer where so many patches would send a ray to each. 64 at least.
std::size_t usual_lights(std::size_t patches);
// Cells along a side of each of so many views.
int cells_of(const PickParams& params, std::size_t views, std::size_t patches);

// A map of what a light sees: a point light has six, or one where it is so far outside that it holds the whole scene.
struct LightView {
    int light = 0;         // index into GpuScene::lights()
    Camera camera;         // at the light
    float tangent = 0.0f;  // of half its angle; 0: parallel
};
std::vector<LightView> light_views(const std::vector<Light>& lights, const Bounds& bounds);

// A patch, or a point of one, that has become a light.
struct PickedLight {
    shared::PatchLight light;
    glm::vec3 incoming{0.0f};  // unit, the way the light travelled that it reflects; 0: it emits
    std::vector<PickedLight>
        parts;  // smaller ones with the same flux together, for patches that are near; may be empty
};

class LightPicker {
public:
    explicit LightPicker(gl::Shaders& shaders);

    // Draws one view and reduces it. `direct`: the radiosity map with the direct light of all patches.
    void look(const GpuScene& scene, const LightView& view, int number, const PatchBuffers& patches,
              const RadiosityMap& map, const PickParams& params, int cells);

    // Of the last look: one light a cell that has flux, in the order of the rows; its parts are what the levels before
    // picked in it, `depth` of them (or down to the map itself).
    std::vector<PickedLight> lights(const LightView& view, const GpuScene& scene, const PatchMesh& mesh,
                                    const PickParams& params, int depth) const;
    // What all cells reflect, W, also those that `borders` leaves out.
    glm::dvec3 reflected_flux() const;

    // A level of the last look, 0: the map itself, halved from one to the next. RGBA32F: position and number of the
    // patch (-1: none); normal and mean irradiance (-1: none); flux and area.
    struct Level {
        gl::Texture chosen, normal_energy, flux_area;
        gl::Framebuffer target;
    };
    const std::vector<Level>& levels() const { return levels_; }
    std::vector<gl::Resource> resources() const;

private:
    void make_levels(int side, int cells);
    gl::Program look_, reduce_;
    gl::VertexArray no_vertices_;
    gl::Buffer camera_buffer_;
    gl::Texture depth_;
    std::vector<Level> levels_;
};

}  // namespace conebook
