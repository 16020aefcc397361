#include "15_dynamic_scenes/dynamic_voxels.hpp"

#include <algorithm>
#include <stdexcept>

namespace conebook {

namespace {

void add_range(std::vector<Range>& ranges, Range range)
{
    if (range.count == 0) return;
    if (!ranges.empty() && ranges.back().end() == range.first)
        ranges.back().count += range.count;
    else
        ranges.push_back(range);
}

}  // namespace

void add_parameters(ParameterTable& table, DynamicVoxelParams& params)
{
    table.add("overlap", params.overlap, {"merge", "drop"},
              "voxels that hold what moves and what stands still: both, or what stands still alone");
}

TriangleSets triangle_sets(const Scene& scene)
{
    TriangleSets sets;
    std::vector<Range> moving;
    for (const Node& node : scene.nodes)
        if (node.dynamic && node.indices.count > 0) moving.push_back({node.indices.first / 3, node.indices.count / 3});
    std::sort(moving.begin(), moving.end(), [](const Range& a, const Range& b) { return a.first < b.first; });
    std::uint32_t next = 0;
    for (const Range& range : moving) {
        add_range(sets.still, {next, range.first - next});
        add_range(sets.moving, range);
        next = range.end();
    }
    add_range(sets.still, {next, std::uint32_t(scene.triangle_count()) - next});
    return sets;
}

DynamicVoxels::DynamicVoxels(gl::Shaders& shaders)
    : take_out_(shaders.load({"15_dynamic_scenes/take_out.comp"})),
      put_in_(shaders.load({"15_dynamic_scenes/put_in.comp"})),
      above_(shaders.load({"15_dynamic_scenes/occupancy_above.comp"})),
      collect_(shaders, {"15_dynamic_scenes/collect.comp"}),
      counters_("voxel statistics of what moves", sizeof(shared::VoxelStatistics)),
      counts_("counts of what moves", sizeof(shared::DynamicCounts))
{
}

FaceChange DynamicVoxels::run(App& app, const Scene& source, const GpuScene& scene, LitVoxels& voxels,
                              const DynamicVoxelParams& params)
{
    const LitVoxels::Parts parts = voxels.parts();
    params_ = params;
    parts.grid.fit(scene.bounds(), parts.params.grid);
    if (parts.params.update == Update::always) still_from_.forget();

    // What stands still: voxels and sums, once.
    app.pass("voxelize still", Scope::scene, [&] {
        if (!still_from_.differs(scene.still_revision(), parts.grid.revision(), parts.params.voxelizer)) return false;
        triangles_ = triangle_sets(source);
        parts.voxelizer.make(scene, parts.grid, parts.params.voxelizer, triangles_.still);
        fragments_.make_room(std::vector<std::size_t>(scene.materials().size(), 0));
        ++still_revision_;
        counted_ = {};  // the lists are without what moves
        return true;
    });
    app.pass("average still", Scope::scene, [&] {
        if (!parts.faces.run(scene, parts.grid, parts.voxelizer)) return false;
        still_ = parts.faces.counted();
        return true;
    });

    // What moves: out of the last voxels, into the new ones.
    if (triangles_.moving.empty() || !moving_from_.differs(still_revision_, scene.geometry_revision(), params))
        return {};
    const Revision from = parts.faces.revision();
    FaceLists& lists = parts.faces.edit();
    app.pass("take out", Scope::scene, [&] {
        take_out(parts, lists);
        return last_counted_.voxels > 0;
    });
    app.pass("put in", Scope::scene, [&] { put_in(scene, parts, lists); });
    app.pass("average moving", Scope::scene, [&] {
        parts.faces.add(scene, parts.grid, fragments_, still_.faces);
        parts.faces.divide(parts.grid, still_.faces, counted_.faces);
    });
    return change_since(from, parts.faces.revision());
}

FaceChange DynamicVoxels::change_since(Revision from, Revision to) const
{
    FaceChange change{from, to, glm::ivec3(511), glm::ivec3(0)};
    for (const shared::DynamicCounts& c : {last_counted_, counted_}) {
        if (c.voxels == 0) continue;
        change.low = glm::min(change.low, 511 - glm::ivec3(c.below_x, c.below_y, c.below_z));
        change.high = glm::max(change.high, glm::ivec3(c.high_x, c.high_y, c.high_z));
    }
    return change;
}

void DynamicVoxels::take_out(const LitVoxels::Parts& parts, FaceLists& lists)
{
    std::swap(list_, last_list_);
    last_counted_ = counted_;
    if (last_counted_.voxels == 0) return;
    parts.grid.bind();
    parts.voxelizer.occupancy().bind_image(0, 0, GL_WRITE_ONLY);
    lists.face_index.bind_image(1, 0, GL_WRITE_ONLY);
    last_list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kDynamicVoxelBinding);
    lists.sums.bind(GL_SHADER_STORAGE_BUFFER, shared::kSumBinding);
    lists.faces.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    take_out_.set("voxel_count", last_counted_.voxels);
    take_out_.use();
    gl::dispatch_items(last_counted_.voxels, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void DynamicVoxels::put_in(const GpuScene& scene, const LitVoxels::Parts& parts, FaceLists& lists)
{
    // Mark its voxels, which gives its fragments.
    parts.voxelizer.add(scene, parts.grid, parts.params.voxelizer, triangles_.moving, counters_, fragments_);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);

    // List them.
    gl::grow(list_, "voxels of what moves", fragments_.count() * sizeof(shared::DynamicVoxel), 0);
    counts_.clear();
    parts.grid.bind();
    parts.voxelizer.occupancy().bind_image(0, 0, GL_READ_WRITE);
    lists.face_index.bind_image(1, 0, GL_READ_ONLY);
    fragments_.bind();
    list_.bind(GL_SHADER_STORAGE_BUFFER, shared::kDynamicVoxelBinding);
    counts_.bind(GL_SHADER_STORAGE_BUFFER, shared::kDynamicCountBinding);
    const gl::Program& collect = collect_.with({{"DROP", params_.overlap == Overlap::drop ? "1" : "0"}});
    collect.use();
    for (const shared::FragmentRange& range : fragments_.ranges()) {
        collect.set("first_fragment", range.begin);
        collect.set("fragment_count", range.count);
        gl::dispatch_items(range.count, 64);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    counted_ = counts_.read_at<shared::DynamicCounts>(0);

    // Give them their places, behind those of what stands still.
    count_again(parts, lists);
    lists.face_index.bind_image(1, 0, GL_WRITE_ONLY);
    lists.face_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceListBinding);
    lists.voxel_list.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
    lists.faces.bind(GL_SHADER_STORAGE_BUFFER, shared::kFaceBinding);
    lists.sums.bind(GL_SHADER_STORAGE_BUFFER, shared::kSumBinding);
    put_in_.set("voxel_count", counted_.voxels);
    put_in_.set("first_face", still_.faces);
    put_in_.set("first_voxel", still_.voxels);
    put_in_.use();
    gl::dispatch_items(counted_.voxels, 64);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    carry_up(parts);
}

// How many voxels and faces there are now, wherever that is kept; room for them.
void DynamicVoxels::count_again(const LitVoxels::Parts& parts, FaceLists& lists) const
{
    lists.counted = still_;
    lists.counted.degenerate += counters_.read_at<shared::VoxelStatistics>(0).degenerate;
    lists.counted.voxels += counted_.new_voxels;
    lists.counted.faces += counted_.faces;
    const std::size_t voxels = lists.counted.voxels, faces = lists.counted.faces;
    if (faces >= (1u << 26))
        throw std::runtime_error("the voxels have more than 2^26 faces; use a smaller --set voxels=");
    gl::require_storage("faces of voxels, their sums", faces, kBytesOfSums, "a smaller --set voxels=");
    gl::grow(lists.voxel_list, "voxel list", voxels * sizeof(GLuint), still_.voxels * sizeof(GLuint));
    gl::grow(lists.face_list, "face list", faces * sizeof(GLuint), still_.faces * sizeof(GLuint));
    gl::grow(lists.sums, "face sums", faces * kBytesOfSums, still_.faces * kBytesOfSums);
    gl::grow(lists.faces, "faces", faces * sizeof(shared::VoxelFace), still_.faces * sizeof(shared::VoxelFace));
    lists.count_groups();
    lists.kept = still_.faces;
    parts.voxelizer.statistics_buffer().write(0, sizeof lists.counted, &lists.counted);
}

// What is occupied at the coarser levels, above the voxels of both lists.
void DynamicVoxels::carry_up(const LitVoxels::Parts& parts)
{
    const gl::Texture& occupancy = parts.voxelizer.occupancy();
    above_.use();
    for (int level = 1; level < parts.grid.levels(); ++level) {
        occupancy.bind_image(0, level - 1, GL_READ_ONLY);
        occupancy.bind_image(1, level, GL_WRITE_ONLY);
        above_.set("level", level);
        const auto above = [&](const gl::Buffer& list, GLuint voxels) {
            list.bind(GL_SHADER_STORAGE_BUFFER, shared::kDynamicVoxelBinding);
            above_.set("voxel_count", voxels);
            gl::dispatch_items(voxels, 64);
        };
        above(last_list_, last_counted_.voxels);
        above(list_, counted_.voxels);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }
}

std::vector<gl::Resource> DynamicVoxels::resources() const
{
    return {{"voxels of what moves", list_.bytes() + last_list_.bytes()},
            {"fragments of what moves", fragments_.resource().bytes}};
}

std::vector<Count> DynamicVoxels::counts() const
{
    return {{"voxels of what moves", double(counted_.voxels), ""},
            {"of them with what stands still", double(counted_.voxels - counted_.new_voxels), ""},
            {"of them lost to it", double(counted_.lost), ""},
            {"fragments of what moves", double(fragments_.count()), ""}};
}

}  // namespace conebook
