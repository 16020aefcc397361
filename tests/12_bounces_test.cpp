// How light goes round along the links: against the rays' exact ends in a box, and against the same sums in double
// precision.
#include <cmath>

#include "chapter_12_frames.hpp"
#include "scene_builder.hpp"

namespace conebook {
namespace {

constexpr GLuint kSkyLink = 0xfffffffeu, kNoLink = 0xffffffffu;  // links.glsl

template <typename T>
std::vector<T> bound_buffer(int binding, std::size_t count)
{
    GLint id = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, GLuint(binding), &id);
    std::vector<T> values(count);
    glGetNamedBufferSubData(GLuint(id), 0, GLsizeiptr(count * sizeof(T)), values.data());
    return values;
}

// Chapter 12's faces of a scene made in code, and what they keep for the bounces.
class Linked {
public:
    Linked(const Scene& source, int voxels, const BounceParams& params, const ConeParams& cones)
        : frames_(asset("cornell_box")),  // for its context and its frame
          scene_(source),
          params_(voxel_params(voxels)),
          shadow_maps_(shaders()),
          voxels_(shaders(), scene_, params_),
          walk_(shaders()),
          emitters_(shaders(), source),
          bounces_(shaders()),
          cones_(cones)
    {
        EXPECT_TRUE(frames_.app().next_frame());
        shadow_maps_.draw(scene_, {});
        voxels_.voxelize(frames_.app(), scene_);
        voxels_.shade(frames_.app(), scene_, shadow_maps_);
        walk_.run(voxels_.grid(), voxels_.faces());
        emitters_.run(scene_, voxels_.grid(), voxels_.faces(), voxels_.shading(), {});
        voxels_.filter_coverage(frames_.app());
        bounces_.link(voxels_, walk_, emitters_, cones, params);
        run(params);
        const std::size_t count = voxels_.faces().face_count();
        faces = voxels_.faces().faces().read<shared::VoxelFace>();
        list = voxels_.faces().face_list().read<GLuint>();
        faces.resize(count);
        list.resize(count);
        direct = voxels_.shading().radiance().read<glm::vec4>();
        links = bound_buffer<GLuint>(shared::kLinkBinding, count * std::size_t(params.links));
        albedo = bound_buffer<GLuint>(shared::kAlbedoBinding, count);
        from_emitters = bound_buffer<glm::vec4>(shared::kFromEmittersBinding, count);
        shines = emitting(source);
    }
    std::vector<glm::vec4> run(const BounceParams& params)
    {
        bounces_.run(voxels_, cones_, params);
        return bounces_.reflected().read<glm::vec4>();
    }
    int count() const { return bounces_.count(); }
    const shared::GridData& grid() const { return voxels_.grid().data(); }

    std::vector<shared::VoxelFace> faces;
    std::vector<GLuint> list, links, albedo;
    std::vector<glm::vec4> direct, from_emitters;
    bool shines = false;

private:
    gl::Shaders& shaders() { return frames_.app().shaders(); }
    static LitVoxelParams voxel_params(int voxels)
    {
        LitVoxelParams params;
        params.grid.voxels = voxels;
        return params;
    }
    static bool emitting(const Scene& scene)
    {
        for (const Material& m : scene.materials)
            if (m.emission != glm::vec3(0.0f)) return true;
        return false;
    }
    Frames frames_;
    GpuScene scene_;
    LitVoxelParams params_;
    ShadowMaps shadow_maps_;
    LitVoxels voxels_;
    WalkVolume walk_;
    Emitters emitters_;
    Bounces bounces_;
    ConeParams cones_;
};

SceneBuilder lit_room(float shine = 0.0f)
{
    SceneBuilder b;
    b.box({-1, -0.7f, -0.8f}, {1, 0.7f, 0.8f}, b.material(lambert({0.8f, 0.5f, 0.3f})), true);
    if (shine > 0.0f) b.quad({-0.3f, 0.69f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, b.material(emitter(shine, 0.4f)));
    b.point_light({0.2f, 0.3f, -0.1f}, glm::vec3(2.0f, 1.5f, 1.0f));
    return b;
}

// Frame of a normal, as shaders/common/frame.glsl has it (Duff et al. 2017, listing 3).
glm::dmat3 frame_around(const glm::dvec3& n)
{
    const double s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return {glm::dvec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), glm::dvec3(b, s + n.y * n.y * a, -n.y), n};
}

// The direction of a face's ray: 64 sets, in every 8 x 8 voxels of a wall each of them once.
glm::dvec3 direction_of(const Linked& linked, const ConeSet& set, std::size_t face, int links, int ray)
{
    const GLuint entry = linked.list[face];
    const int voxel[3] = {int(entry & 7u), int(entry >> 9 & 7u), int(entry >> 18 & 7u)}, axis = int(entry >> 27) / 2;
    const int chosen = voxel[(axis + 1) % 3] + 8 * voxel[(axis + 2) % 3];
    return frame_around(glm::dvec3(linked.faces[face].normal)) *
           glm::dvec3(set.cones[std::size_t(chosen * links + ray)]);
}

class Links : public testing::TestWithParam<int> {};

// In an empty box it is known where every ray ends: on which wall, and where.
TEST_P(Links, OfAClosedBoxAreWhereTheRaysEnd)
{
    BounceParams params;
    params.links = GetParam();
    const Linked linked(lit_room().build(), 48, params, {});
    const ConeSet set = make_interleaved_cones(GetParam(), ConeTable::tilted, glm::radians(6.0), 64);
    const glm::dvec3 low(linked.grid().content_min), high(linked.grid().content_max);
    std::size_t open = 0, looks_away = 0, other_wall = 0, far_away = 0, compared = 0;
    for (std::size_t i = 0; i < linked.links.size(); ++i) {
        const std::size_t from = i / std::size_t(GetParam());
        const GLuint link = linked.links[i];
        if (link >= kSkyLink) {
            ++open;
            continue;
        }
        ASSERT_LT(link, linked.faces.size());
        const glm::dvec3 d = direction_of(linked, set, from, GetParam(), int(i % std::size_t(GetParam())));
        const shared::VoxelFace& met = linked.faces[link];
        if (glm::dot(glm::dvec3(met.normal), d) >= 1e-5) ++looks_away;
        // From the face's middle; edges of the room, where a voxel holds two walls, and grazing rays are left out.
        const glm::dvec3 o(linked.faces[from].position);
        int wall = -1;
        double exit = INFINITY;
        for (int a = 0; a < 3; ++a) {
            const double t = ((d[a] > 0.0 ? high[a] : low[a]) - o[a]) / d[a];
            if (std::abs(d[a]) > 1e-6 && t > 1e-3 && t < exit) {
                exit = t;
                wall = 2 * a + (d[a] > 0.0 ? 0 : 1);  // the side that looks against the ray
            }
        }
        const glm::dvec3 hit = o + exit * d;
        double to_edge = INFINITY;
        for (int a = 0; a < 3; ++a)
            if (a != wall / 2) to_edge = std::min({to_edge, hit[a] - low[a], high[a] - hit[a]});
        if (to_edge < 6.0 || std::abs(d[wall / 2]) < 0.3 || exit < 6.0) continue;
        ++compared;
        if (int(linked.list[link] >> 27) != wall) ++other_wall;
        // The run's middle is within a voxel of the wall, the face one of the eight around, and the ray begins up to one
        // and a quarter above its face's middle along the normal.
        const glm::dvec3 off = glm::dvec3(met.position) - hit;
        if (glm::length(off - glm::dot(off, d) * d) > 3.0) ++far_away;
    }
    EXPECT_EQ(open, 0u);
    EXPECT_EQ(looks_away, 0u);
    EXPECT_EQ(other_wall, 0u);
    EXPECT_EQ(far_away, 0u);
    EXPECT_GT(compared, linked.links.size() / 4);
    std::printf("%zu of %zu links compared\n", compared, linked.links.size());
}
INSTANTIATE_TEST_SUITE_P(Rays, Links, testing::Values(1, 5, 9, 16));

TEST(OpenLinks, OfAFloorAreTheSky)
{
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));
    const Linked linked(b.build(), 32, {}, {});
    for (const GLuint link : linked.links) ASSERT_EQ(link, kSkyLink);
}

// One step on the CPU: R = R0 + rho (mean over the links + what emitters send).
std::vector<glm::dvec3> bounced(const Linked& linked, const std::vector<glm::dvec3>& before, double sky)
{
    const std::size_t per_face = linked.links.size() / linked.faces.size();
    std::vector<glm::dvec3> after(before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < per_face; ++k) {
            const GLuint link = linked.links[i * per_face + k];
            sum += link < kSkyLink ? before[link] : glm::dvec3(link == kSkyLink ? sky : 0.0);
        }
        sum /= double(per_face);
        if (linked.shines) sum += glm::dvec3(linked.from_emitters[i]);
        const GLuint bits = linked.albedo[i];
        const glm::dvec3 albedo = glm::dvec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20 & 1023u) / 1023.0;
        after[i] = glm::dvec3(linked.direct[i]) + albedo * sum;
    }
    return after;
}

std::vector<glm::dvec3> direct_of(const Linked& linked)
{
    std::vector<glm::dvec3> direct;
    for (std::size_t i = 0; i < linked.faces.size(); ++i) direct.emplace_back(linked.direct[i]);
    return direct;
}

struct BounceScene {
    const char* name;
    bool closed;
    float shine, sky;
};
class BounceSteps : public testing::TestWithParam<BounceScene> {};

TEST_P(BounceSteps, AreThoseOfDoublePrecision)
{
    const auto& [name, closed, shine, sky] = GetParam();
    SceneBuilder b = closed ? lit_room(shine) : SceneBuilder();
    if (!closed) {
        b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert({0.8f, 0.5f, 0.3f})));
        b.box({-0.4f, 0.2f, -0.3f}, {0.2f, 0.8f, 0.5f}, b.material(lambert(0.6f)));
        b.point_light({0.7f, 0.9f, 0.1f}, glm::vec3(2.0f));
    }
    ConeParams cones;
    cones.sky = sky;
    BounceParams params;
    params.bounces = 2;
    Linked linked(b.build(), 32, params, cones);
    std::vector<glm::dvec3> expected = direct_of(linked);
    double albedo_error = 0.0, lit = 0.0;
    for (std::size_t i = 0; i < linked.faces.size(); ++i)
        for (int c = 0; c < 3; ++c)
            albedo_error = std::max(albedo_error, std::abs(double(linked.albedo[i] >> (10 * c) & 1023u) / 1023.0 -
                                                           double(linked.faces[i].albedo_area[c])));
    EXPECT_LT(albedo_error, 0.5 / 1023.0 + 1e-6);
    int steps = 0;
    for (const int bounces : {2, 3, 5, 12}) {
        for (; steps < bounces - 1; ++steps) expected = bounced(linked, expected, double(sky));
        params.bounces = bounces;
        const std::vector<glm::vec4> found = linked.run(params);
        EXPECT_EQ(linked.count(), bounces - 1);
        // Between bounces the light is kept to 2^-16 of the largest channel of the face that sends it. At the face that it
        // comes to, whose colour differs, that is less than 2^-12 of the largest.
        double worst = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double largest = std::max({expected[i].x, expected[i].y, expected[i].z});
                const double allowed = steps * std::ldexp(largest, -12) + 1e-9;
                worst = std::max(worst, std::abs(double(found[i][c]) - expected[i][c]) / allowed);
                lit = std::max(lit, expected[i][c] - double(linked.direct[i][c]));
            }
        std::printf("%s, %d bounces: %.3f of what is allowed\n", name, bounces, worst);
        EXPECT_LT(worst, 1.0) << bounces;
    }
    EXPECT_GT(lit, 0.05);  // or nothing was tested

    // To convergence: what is left to come is less than the last change over 1 - rho.
    params.bounces = -1;
    params.tolerance = 1e-3f;
    const std::vector<glm::vec4> settled = linked.run(params);
    for (; steps < 400; ++steps) expected = bounced(linked, expected, double(sky));
    double largest = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            largest = std::max(largest, expected[i][c]);
            worst = std::max(worst, std::abs(double(settled[i][c]) - expected[i][c]));
        }
    EXPECT_LT(worst, (1e-3 + std::ldexp(1.0, -10)) * largest / (1.0 - 0.8));
    EXPECT_LT(linked.count(), 64);
}
INSTANTIATE_TEST_SUITE_P(Scenes, BounceSteps,
                         testing::Values(BounceScene{"room", true, 0.0f, 0.0f}, BounceScene{"lamp", true, 5.0f, 0.0f},
                                         BounceScene{"sky", false, 0.0f, 0.5f}),
                         [](const auto& info) { return std::string(info.param.name); });

// L(n) = 1 - 2^-(n + 1): 0.2 % are two units of the half floats that the pyramid is in, at 0.5 to 1.
class FurnaceSeries : public testing::TestWithParam<int> {};

TEST_P(FurnaceSeries, IsThatOfTheClosedFormAtAnyResolutionOfTheGathering)
{
    const int bounces = GetParam();
    const double expected = bounces < 0 ? 1.0 : 1.0 - std::pow(0.5, bounces + 1);
    for (const int scale : {1, 2, 4}) {
        const TemporaryFolder folder;
        const std::string file = (folder / "furnace.exr").string();
        const ProgramRun run = run_program(
            "12_second_bounce", "--headless --size 48x48 --scene '" + asset("white_furnace").string() + "' --output '" +
                                    file + "' --set voxels=32 bounces=" + std::to_string(bounces) +
                                    " gather_scale=" + std::to_string(scale));
        ASSERT_EQ(run.code, 0) << run.output;
        double mean = 0.0;
        const ImageF image = read_exr(file);
        for (const glm::vec4& pixel : image.pixels) mean += double(pixel.g) / double(image.pixels.size());
        std::printf("bounces %d, scale %d: %.5f of %.5f\n", bounces, scale, mean, expected);
        EXPECT_NEAR(mean, expected, 0.002 * expected) << bounces << ", scale " << scale;
    }
}
INSTANTIATE_TEST_SUITE_P(Bounces, FurnaceSeries, testing::Values(1, 2, 3, 4, -1), [](const auto& info) {
    return info.param < 0 ? std::string("Converged") : "After" + std::to_string(info.param);
});

}  // namespace
}  // namespace conebook
