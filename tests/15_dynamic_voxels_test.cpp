// Voxels of what moves among those of what stands still: bit for bit what a voxelization from nothing makes.
#include <bit>
#include <map>
#include <random>

#include "08_diffuse_cones/walk_volume.hpp"
#include "chapter_15_frames.hpp"
#include "moving_builder.hpp"
#include "scene_builder.hpp"

namespace conebook {
namespace {

// What voxels hold, whatever the order of their lists.
struct Voxels {
    std::vector<std::vector<GLuint>> occupancy;  // of all levels
    std::vector<GLuint> listed;                  // pack_voxel(), sorted
    std::map<GLuint, std::vector<GLuint>>
        faces;  // by pack_voxel() | face << 27: the bits of shared::VoxelFace and the sums
    std::vector<GLuint> walk;
    bool operator==(const Voxels&) const = default;
};

std::vector<GLuint> words_of(const gl::Buffer& buffer) { return buffer.read<GLuint>(); }

Voxels read_voxels(gl::Shaders& shaders, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
                   VoxelFaces& faces)
{
    Voxels v;
    for (int level = 0; level < grid.levels(); ++level)
        v.occupancy.push_back(gl::read_uints(voxelizer.occupancy(), level));
    v.listed = words_of(faces.voxel_list());
    v.listed.resize(faces.voxel_count());
    std::sort(v.listed.begin(), v.listed.end());
    const std::vector<GLuint> entries = gl::read_uints(faces.face_index());
    const std::vector<GLuint> list = words_of(faces.face_list()), means = words_of(faces.faces()),
                              sums = words_of(faces.edit().sums);
    constexpr std::size_t kMeanWords = sizeof(shared::VoxelFace) / sizeof(GLuint), kSumWords = 2 * shared::kSumCount;
    const glm::ivec3 size = grid.size();
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i] == 0u) continue;
        const auto x = GLuint(i % std::size_t(size.x)), y = GLuint(i / std::size_t(size.x) % std::size_t(size.y)),
                   z = GLuint(i / std::size_t(size.x) / std::size_t(size.y));
        std::size_t place = entries[i] >> 6;
        for (GLuint face = 0; face < 6; ++face) {
            if ((entries[i] >> face & 1u) == 0u) continue;
            const GLuint name = x | y << 9 | z << 18 | face << 27;
            EXPECT_EQ(list[place], name);
            std::vector<GLuint>& bits = v.faces[name];
            bits.assign(means.begin() + std::ptrdiff_t(place * kMeanWords),
                        means.begin() + std::ptrdiff_t((place + 1) * kMeanWords));
            bits.insert(bits.end(), sums.begin() + std::ptrdiff_t(place * kSumWords),
                        sums.begin() + std::ptrdiff_t((place + 1) * kSumWords));
            ++place;
        }
    }
    WalkVolume walk(shaders);
    walk.run(grid, faces);
    v.walk = gl::read_uints(walk.volume());
    return v;
}

Voxels moved(MovingFrames& frames)
{
    const LitVoxels::Parts parts = frames.light.voxels().parts();
    return read_voxels(frames.app().shaders(), parts.grid, parts.voxelizer, parts.faces);
}

// The same triangles in the same grid, from nothing; `triangles`: of them alone.
Voxels from_nothing(MovingFrames& frames, const std::vector<Range>* triangles = nullptr)
{
    gl::Shaders& shaders = frames.app().shaders();
    const VoxelGrid grid(frames.scene.bounds(), frames.params.scene.voxels.grid);
    ConservativeVoxelizer voxelizer(shaders);
    VoxelFaces faces(shaders, voxelizer);
    const std::vector<Range> all = {{0, GLuint(frames.scene.triangle_count())}};
    voxelizer.make(frames.scene, grid, frames.params.scene.voxels.voxelizer, triangles != nullptr ? *triangles : all);
    faces.run(frames.scene, grid, voxelizer);
    return read_voxels(shaders, grid, voxelizer, faces);
}

class OfScene : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, OfScene, testing::Values("door", "figure", "walking_lamp", "spinning_shapes"));

TEST_P(OfScene, RandomPosesAreThoseFromNothing)
{
    MovingFrames frames(asset(GetParam()), MovingFrames::small(32));
    std::mt19937 random(15);
    std::uniform_real_distribution<float> times(0.0f, float(frames.moving.duration_s()));
    frames.light_frame();
    const Voxels first = moved(frames);
    for (int i = 0; i < 20; ++i) {
        frames.params.time = times(random);
        frames.params.scene.voxels.voxelizer.voxelizer = i % 7 == 6 ? Voxelizer::raster : Voxelizer::compute;  // another one: all of it again
        frames.light_frame();
        ASSERT_EQ(moved(frames), from_nothing(frames)) << frames.params.time << " s";
    }
    // There and back.
    frames.params.time = 0.0f;
    frames.light_frame();
    EXPECT_EQ(moved(frames), first);
}

// A ball that moves through a wall, and out of the grid: 0 s inside, 1 s half in the wall and half outside, 2 s
// outside.
Scene ball_through_wall()
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f)), red = b.material(lambert({0.7f, 0.1f, 0.1f}));
    b.box({-1, -1, -1}, {1, 1, 1}, grey, true);
    b.sphere({0, 0, 0}, 0.3f, red, 16);
    b.point_light({0, 0.8f, 0.3f}, {3, 3, 3});
    Scene scene = b.build();
    make_move(scene, 1, {{0.1f, 0, 0}, {1.0f, 0.1f, 0}, {3.0f, 0, 0}});
    return scene;  // its bounds are the room's
}

MovingFrames::Prepare instead(const Scene& scene)
{
    return [scene](Scene& file) { file = scene; };
}

TEST(DynamicVoxels, HalfAndWhollyOutsideTheGrid)
{
    MovingFrames frames(asset("cornell_box"), MovingFrames::small(32), instead(ball_through_wall()));
    std::size_t last = SIZE_MAX;
    for (const float time_s : {0.0f, 1.0f, 2.0f, 1.0f, 0.0f}) {
        frames.draw_at(time_s);
        ASSERT_EQ(moved(frames), from_nothing(frames)) << time_s << " s";
        const std::size_t voxels = frames.dynamic.counted().voxels;
        if (time_s == 2.0f) {
            EXPECT_EQ(voxels, 0u);
        }
        EXPECT_NE(voxels, last);
        last = voxels;
        for (const float value : frames.pixels()) ASSERT_TRUE(std::isfinite(value));
    }
}

TEST(DynamicVoxels, DropLosesTheCommonVoxelsAndNoOthers)
{
    MovingParams params = MovingFrames::small(32);
    params.dynamic.overlap = Overlap::drop;
    MovingFrames frames(asset("cornell_box"), params, instead(ball_through_wall()));
    const TriangleSets sets = triangle_sets(frames.app().scene());
    for (const float time_s : {0.0f, 1.0f, 0.9f, 2.0f}) {
        frames.params.time = time_s;
        frames.light_frame();
        const Voxels found = moved(frames), still = from_nothing(frames, &sets.still),
                     moves = from_nothing(frames, &sets.moving);
        Voxels expected = still;
        std::size_t lost = 0;
        for (std::size_t i = 0; i < still.occupancy[0].size(); ++i) {
            const bool common = still.occupancy[0][i] != 0u && moves.occupancy[0][i] != 0u;
            lost += common;
            if (still.occupancy[0][i] == 0u) expected.occupancy[0][i] = moves.occupancy[0][i];
        }
        for (const auto& [name, bits] : moves.faces)
            if (!std::binary_search(still.listed.begin(), still.listed.end(), name & 0x7ffffffu))
                expected.faces[name] = bits;
        EXPECT_EQ(found.occupancy[0], expected.occupancy[0]) << time_s;
        EXPECT_EQ(found.faces, expected.faces) << time_s;
        EXPECT_EQ(frames.dynamic.counted().lost, lost) << time_s;
        if (time_s == 1.0f) {
            EXPECT_GT(lost, 30u);
        }
    }
    // And what it loses comes back.
    frames.params.time = 1.0f;
    frames.params.dynamic.overlap = Overlap::merge;
    frames.light_frame();
    EXPECT_EQ(moved(frames), from_nothing(frames));
}

// Of each face that can be found, by pack_voxel() | face << 27: the same of the faces that its links lead to.
std::map<GLuint, std::vector<GLuint>> links_of(MovingFrames& frames)
{
    const VoxelFaces& faces = frames.light.voxels().faces();
    const std::vector<GLuint> list = words_of(faces.face_list()), links = words_of(frames.light.bounces().links()),
                              entries = gl::read_uints(faces.face_index());
    const auto count = std::size_t(frames.params.scene.bounces.links);
    std::map<GLuint, std::vector<GLuint>> found;
    for (const GLuint entry : entries)
        for (GLuint place = entry >> 6; place < (entry >> 6) + GLuint(std::popcount(entry & 63u)); ++place)
            for (std::size_t i = 0; i < count; ++i) {
                const GLuint link = links[place * count + i];
                found[list[place]].push_back(link < faces.face_count() ? list[link] : link);
            }
    return found;
}

// Only faces whose rays come by what has moved find their links again; a few others differ, where a rounding decides
// between two voxels.
TEST_P(OfScene, LinksAreThoseFromNothing)
{
    MovingParams params = MovingFrames::small(32);
    MovingFrames frames(asset(GetParam()), params);
    frames.light_frame();
    for (const float time_s : {0.4f, 1.3f, 1.5f}) {
        frames.params.time = time_s;
        frames.light_frame();
    }
    const auto found = links_of(frames);
    params.time = 1.5f;
    MovingFrames fresh(asset(GetParam()), params);
    fresh.light_frame();
    const auto expected = links_of(fresh);
    ASSERT_EQ(found.size(), expected.size());
    std::size_t links = 0, others = 0;
    for (const auto& [name, ends] : expected)
        for (std::size_t i = 0; i < ends.size(); ++i, ++links) others += found.at(name)[i] != ends[i];
    std::printf("%s: %zu of %zu links differ\n", GetParam(), others, links);
    EXPECT_LE(double(others), 1e-3 * double(links));
}

TEST(DynamicVoxels, ThreeHundredFramesDoNotGrow)
{
    MovingParams params = MovingFrames::small(16);
    params.scene.bounces.bounces = 2;
    params.scene.shadow_maps.shadow_map_size = 64;
    MovingFrames frames(asset("door"), params);
    const auto play = [&](int count) {
        for (int i = 0; i < count; ++i) {
            frames.params.time = float(frames.moving.duration_s()) * float(i % 50) / 50.0f;
            frames.light_frame();
        }
        return frames.bytes();
    };
    const std::size_t once = play(50);
    EXPECT_EQ(play(250), once);
}

}  // namespace
}  // namespace conebook
