#include "04_conservative_voxelization/conservative_voxelizer.hpp"

#include <algorithm>
#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, VoxelizerParams& params)
{
    table.add("voxelizer", params.voxelizer, {"raster", "compute"}, "who finds the columns; both give the same voxels");
}

void add_parameters(ParameterTable& table, VoxelViewParams& params)
{
    table.add("level", params.level, 0, 6, "", "level of the pyramid that voxel views show, 0 = finest");
    table.add("shaded", params.shaded, "voxel view: shade the cubes");
}

ConservativeVoxelizer::ConservativeVoxelizer(gl::Shaders& shaders)
    : raster_mark_(shaders,
                   {"04_conservative_voxelization/conservative.vert", "04_conservative_voxelization/conservative.geom",
                    "04_conservative_voxelization/mark.frag"}),
      mark_small_(shaders, {"04_conservative_voxelization/mark_small.comp"}),
      mark_large_(shaders, {"04_conservative_voxelization/mark_large.comp"}),
      next_level_(shaders.load({"04_conservative_voxelization/occupancy_level.comp"})),
      statistics_("voxel statistics", sizeof(shared::VoxelStatistics))
{
}

void ConservativeVoxelizer::allocate(const VoxelGrid& grid, const VoxelizerParams& params)
{
    const glm::ivec3 size = grid.size();
    if (!occupancy_ || occupancy_.size() != size || occupancy_.levels() != grid.levels()) {
        occupancy_ = gl::texture_3d("occupancy", GL_R32UI, size, grid.levels());
        column_plane_ = gl::Framebuffer("column plane", glm::ivec2(std::max({size.x, size.y, size.z})));
    }
    if (!params.count_fragments)
        fragment_counts_ = {};
    else if (!fragment_counts_ || fragment_counts_.size() != size)
        fragment_counts_ = gl::texture_3d("fragment counts", GL_R32UI, size);
}

void ConservativeVoxelizer::free_scratch(bool occupancy_too)
{
    fragments_ = {};
    room_for_.forget();
    large_triangles_ = {};
    if (occupancy_too) occupancy_ = {};
}

std::vector<gl::Resource> ConservativeVoxelizer::resources() const
{
    std::vector<gl::Resource> resources = {occupancy_.resource(), fragments_.resource()};
    if (fragment_counts_) resources.push_back(fragment_counts_.resource());
    if (large_triangles_) resources.push_back(large_triangles_.resource());
    return resources;
}

void FragmentList::make_room(const std::vector<std::size_t>& of_materials)
{
    std::size_t total = 0;
    ranges_.clear();
    for (const std::size_t fragments : of_materials) {
        ranges_.push_back({GLuint(total), GLuint(fragments), 0, 0});
        total += fragments;
    }
    gl::require_storage("pairs of triangle and voxel", total, sizeof(glm::uvec2), "a smaller --set voxels=");
    fragments_ = gl::Buffer("fragments", total * sizeof(glm::uvec2));
    range_buffer_ = gl::Buffer("fragment ranges", ranges_);
}

void FragmentList::clear()
{
    for (shared::FragmentRange& range : ranges_) range.count = 0;
    range_buffer_.write(0, range_buffer_.bytes(), ranges_.data());
}

void FragmentList::bind() const
{
    range_buffer_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFragmentRangeBinding);
    fragments_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFragmentBinding);
}

bool FragmentList::take_counts()
{
    ranges_ = range_buffer_.read<shared::FragmentRange>();
    // The counts are right even where there was no room for all.
    const auto found_more = [](const shared::FragmentRange& range) { return range.count > range.capacity; };
    if (std::none_of(ranges_.begin(), ranges_.end(), found_more)) return true;
    // Some more than that, if it can be had, since what moves finds other numbers soon.
    std::vector<std::size_t> exact, more;
    std::size_t sum = 0;
    for (const shared::FragmentRange& range : ranges_) {
        exact.push_back(range.count);
        more.push_back(found_more(range) ? range.count + range.count / 4 : range.capacity);
        sum += more.back();
    }
    make_room(sum * sizeof(glm::uvec2) <= gl::most_storage_bytes() ? more : exact);
    return false;
}

std::size_t FragmentList::count() const
{
    std::size_t sum = 0;
    for (const shared::FragmentRange& range : ranges_) sum += range.count;
    return sum;
}

void ConservativeVoxelizer::mark(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
                                 const std::vector<Range>& triangles, const gl::Buffer& counters, FragmentList& list)
{
    list.clear();
    counters.clear();
    if (fragment_counts_) {
        fragment_counts_.clear();
        fragment_counts_.bind_image(1, 0, GL_READ_WRITE);
    }
    grid.bind();
    scene.bind_triangles();
    occupancy_.bind_image(0, 0, GL_READ_WRITE);
    list.bind();
    counters.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    const gl::Defines defines = {{"CONSERVATIVE", params.conservative ? "1" : "0"},
                                 {"COUNT_FRAGMENTS", params.count_fragments ? "1" : "0"}};
    if (Voxelizer(params.voxelizer) == Voxelizer::raster) {
        const glm::ivec3 size = grid.size();
        column_plane_.bind(glm::ivec2(std::max({size.x, size.y, size.z})));
        for (const Range& range : triangles) scene.draw_geometry(raster_mark_.with(defines), range);
        return;
    }
    large_triangles_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLargeTriangleBinding);
    const gl::Program &small = mark_small_.with(defines), &large_ones = mark_large_.with(defines);
    small.use();
    for (const Range& range : triangles) {
        small.set("first_triangle", range.first);
        small.set("triangle_count", range.count);
        gl::dispatch_items(range.count, 64);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    // The fewer triangles are large, the more work groups each of them gets.
    const std::size_t large = counters.read_at<shared::VoxelStatistics>(0).large;
    const std::size_t groups_of_triangle = std::clamp<std::size_t>(1024 / std::max<std::size_t>(large, 1), 1, 64);
    large_ones.use();
    large_ones.set("groups_of_triangle", int(groups_of_triangle));
    gl::dispatch_items(large * groups_of_triangle, 1);
}

void ConservativeVoxelizer::add(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
                                const std::vector<Range>& triangles, const gl::Buffer& counters, FragmentList& list)
{
    if (Voxelizer(params.voxelizer) == Voxelizer::compute &&
        large_triangles_.bytes() < scene.triangle_count() * sizeof(GLuint))
        large_triangles_ = gl::Buffer("large triangles", scene.triangle_count() * sizeof(GLuint));
    // A second time where the list was too short; marks stay the same.
    do {
        mark(scene, grid, params, triangles, counters, list);
    } while (!list.take_counts());
}

bool ConservativeVoxelizer::run(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params)
{
    if (!made_from_.differs(scene.geometry_revision(), grid.revision(), params)) return false;
    make(scene, grid, params, {{0, GLuint(scene.triangle_count())}});
    return true;
}

void ConservativeVoxelizer::make(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
                                 const std::vector<Range>& triangles)
{
    const bool compute = Voxelizer(params.voxelizer) == Voxelizer::compute;
    if (compute && !params.conservative) throw std::runtime_error("conservative=off is for voxelizer=raster only");
    ++revision_;
    allocate(grid, params);
    if (room_for_.differs(grid.revision()) || fragments_.ranges().size() != scene.materials().size()) {
        // In the mean over all places a triangle meets 1 + its box's sides + its areas along the axes in voxels: the
        // volume of its Minkowski sum with a voxel. Places that are not random, as of walls between two layers of
        // voxels, may find more; a quarter is left for them.
        const double side_m = double(grid.voxel_size_m());
        const auto mean = [&](const MaterialUse& use) {
            return double(use.triangles) + use.box_sides_m / side_m + use.seen_areas_m2 / (side_m * side_m);
        };
        double sum = 0.0;
        for (const MaterialUse& use : scene.material_uses()) sum += mean(use);
        const double share = std::min(1.25, double(gl::most_storage_bytes() / sizeof(glm::uvec2)) / std::max(sum, 1.0));
        std::vector<std::size_t> fragments;
        for (const MaterialUse& use : scene.material_uses()) fragments.push_back(std::size_t(share * mean(use)));
        fragments_.make_room(fragments);
    }
    occupancy_.clear();
    add(scene, grid, params, triangles, statistics_, fragments_);

    // Carry the marks to the coarser levels.
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    next_level_.use();
    for (int level = 1; level < grid.levels(); ++level) {
        occupancy_.bind_image(0, level - 1, GL_READ_ONLY);
        occupancy_.bind_image(1, level, GL_WRITE_ONLY);
        const glm::ivec3 groups = (glm::max(grid.size() >> level, glm::ivec3(1)) + 3) / 4;
        glDispatchCompute(GLuint(groups.x), GLuint(groups.y), GLuint(groups.z));
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

VoxelViewPass::VoxelViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "04_conservative_voxelization/voxel_view.frag"}))
{
}

const gl::Texture& VoxelViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy,
                                      const VoxelViewParams& params, const gl::Buffer& camera, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "voxel view", GL_RGBA16F, size);
    grid.bind();
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    occupancy.bind(shared::kOccupancyUnit);
    program_.set("level", std::min(params.level, grid.levels() - 1));
    program_.set("shaded", params.shaded);
    program_.set("show_heat", params.heat != nullptr);
    (params.heat != nullptr ? *params.heat : occupancy).bind(shared::kPackedColorUnit);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
