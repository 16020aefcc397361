#include "18_voxel_ray_marching/stream_out.hpp"

#include <cmath>
#include <stdexcept>

namespace conebook {

void add_parameters(ParameterTable& table, CubeParams& params)
{
    add_parameters(table, params.grid);
    table.add("cube", params.cube, {"scene", "40"},
              "what the voxels fill: the scene, or 40 m about the world's origin");
}

void fit_cube(VoxelGrid& grid, const Bounds& bounds, glm::dvec3 origin_ws, const CubeParams& params)
{
    if (params.cube == 0) {
        grid.fit(bounds, params.grid);
        return;
    }
    // Voxel = floor((x / S + 1/2) N), x in the world (Ropret 2013, equation 2.10).
    constexpr double kSide_m = 40.0;
    const double voxel_m = kSide_m / params.grid.voxels;
    shared::GridData data{};
    data.origin = glm::vec4(glm::vec3(glm::dvec3(-0.5 * kSide_m) - origin_ws), float(voxel_m));
    data.size = glm::ivec4(glm::ivec3(params.grid.voxels), 1);
    data.content_max = glm::vec4(glm::vec3(float(params.grid.voxels)), 0.0f);
    grid.fit(data);
}

void add_parameters(ParameterTable& table, CutParams& params)
{
    table.add("piece", params.piece, 0.25, 16.0, "voxels",
              "longest edge of a piece of a triangle; up to 0.75 no holes");
}

namespace {

// As in cut.glsl.
constexpr int kMostPoints = 16;
constexpr int kMostCells = 64;  // of a point of a double-sided triangle

// llvmpipe (Mesa 22.3) numbers the points that it tessellates in a draw with 16 bits and starts again at 0 without a
// word: triangles come twice then, and others never.
constexpr std::uint32_t kMostPatches = 65535 / (kMostPoints * kMostPoints);

// How often each triangle is drawn, so that the largest that there can be gets all its pieces.
int instances_for(double longest_edge_voxels, double piece)
{
    const double k = std::max(1.0, std::ceil(longest_edge_voxels / piece));
    const double rows = std::ceil(k / kMostPoints);  // of cells in a block
    if (rows > kMostCells)
        throw std::runtime_error("piece=" + std::to_string(piece) + ": a triangle may be " +
                                 std::to_string(long(longest_edge_voxels)) +
                                 " voxels long here, which is too many to cut; use cube=scene or fewer voxels");
    const double columns = std::max(1.0, std::min(rows, std::floor(kMostCells / rows)));
    return int(std::ceil(k / columns / kMostPoints));
}

}  // namespace

StreamOut::StreamOut(gl::Shaders& shaders)
    : cut_(shaders.load({"18_voxel_ray_marching/cut.vert", "18_voxel_ray_marching/cut.tesc",
                         "18_voxel_ray_marching/cut.tese", "18_voxel_ray_marching/cut.geom"})),
      light_(shaders.load({"18_voxel_ray_marching/light.comp"})),
      pieces_("pieces", sizeof(Piece) << 16),
      counts_("counts of pieces", 2 * sizeof(GLuint)),
      nowhere_("nothing is rasterized", {1, 1})
{
    GLuint query = 0;
    glCreateQueries(GL_PRIMITIVES_GENERATED, 1, &query);
    generated_ = gl::Handle<gl::delete_query>(query);
}

void StreamOut::cut(const GpuScene& scene, const VoxelGrid& grid, const CutParams& params)
{
    const double longest = double(glm::length(scene.bounds().extent()) / grid.voxel_size_m());
    const int instances = instances_for(1.001 * longest, double(params.piece));
    grid.bind();
    cut_.set("piece_edge", params.piece);
    for (;;) {
        // snippet: transform_feedback
        // What the geometry shader sends out goes into the buffer and no further. A query counts it; where there was no
        // room, the list is made longer and the triangles are drawn again.
        nowhere_.bind({1, 1});
        cut_.use();
        pieces_.bind(GL_TRANSFORM_FEEDBACK_BUFFER, 0);
        glEnable(GL_RASTERIZER_DISCARD);
        glBeginQuery(GL_PRIMITIVES_GENERATED, generated_.id());
        glBeginTransformFeedback(GL_POINTS);
        scene.draw_patches(cut_, instances, kMostPatches);
        glEndTransformFeedback();
        glEndQuery(GL_PRIMITIVES_GENERATED);
        glDisable(GL_RASTERIZER_DISCARD);
        glGetQueryObjectuiv(generated_.id(), GL_QUERY_RESULT, &count_);
        // end snippet
        if (std::size_t(count_) * sizeof(Piece) <= pieces_.bytes()) break;
        gl::require_storage("pieces", count_, sizeof(Piece), "fewer voxels or larger pieces");
        const std::size_t room = count_ + count_ / 8;  // what moves may need more later
        pieces_ = gl::Buffer("pieces", std::min(room * sizeof(Piece), gl::most_storage_bytes() / 32 * 32));
    }
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
}

void StreamOut::light(const GpuScene& scene, const ShadowMaps& shadow_maps)
{
    counts_.clear();
    light_.use();
    scene.bind_lights(light_);
    shadow_maps.bind(light_);
    pieces_.bind(GL_SHADER_STORAGE_BUFFER, shared::kPieceBinding);
    counts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kPieceCountBinding);
    light_.set("piece_count", count_);
    gl::dispatch_items(count_, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}

}  // namespace conebook
