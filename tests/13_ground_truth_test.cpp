// The path tracer beside the frame: its passes against one run and against a closed form, the thread that refines, the
// two ways to compare, the program against `reference`, and the ladder's sums.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "13_ground_truth/background_tracer.hpp"
#include "13_ground_truth/side_by_side.hpp"
#include "image/image.hpp"
#include "program.hpp"
#include "reference_helpers.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

// A room with a lamp: light of many bounces, noise in every pixel.
Scene room()
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(lambert(0.7f)), true);
    b.disc({0, 0.9f, 0}, {0, -1, 0}, 0.4f, b.material(emitter(5.0f)));
    return b.build();
}

TraceJob job_in_room(int size = 24)
{
    TraceJob job;
    job.camera = look_at({0, -0.5f, 0.9f}, {0, -0.5f, -1}, 1.0f);
    job.size = glm::ivec2(size);
    job.bounces = 3;
    return job;
}

PathTraceOptions options_of(const TraceJob& job, int spp)
{
    PathTraceOptions o = options(job.bounces, spp, job.size.x);
    o.parts = {job.part};
    return o;
}

std::shared_ptr<const Refinement> traced(const Scene& scene, const TraceJob& job, int samples, int threads = 0)
{
    BackgroundTracer tracer(scene, threads);
    tracer.follow(job, samples);
    tracer.wait();
    return tracer.newest();
}

TEST(PathTracerInPasses, IsOneRunBitForBit)
{
    const Scene scene = room();
    const TraceJob job = job_in_room();
    PathTracer tracer(scene, 3);
    tracer.start(job.camera, options_of(job, 1));
    for (int pass : {1, 1, 3, 16, 4}) ASSERT_TRUE(tracer.add_samples(pass));
    const PathTraceResult in_passes = tracer.result();
    const PathTraceResult at_once = path_trace(scene, job.camera, options_of(job, 25));
    EXPECT_EQ(in_passes.spp, 25);
    EXPECT_EQ(in_passes.pictures[0].pixels, at_once.pictures[0].pixels);
    EXPECT_EQ(in_passes.errors[0].pixels, at_once.errors[0].pixels);
}

// With the same numbers in every pass the mean would not move and the standard error would promise too much.
TEST(PathTracerInPasses, EveryPassHasOtherRandomNumbers)
{
    const Scene scene = room();
    const TraceJob job = job_in_room();
    PathTracer tracer(scene);
    tracer.start(job.camera, options_of(job, 1));
    std::vector<ImageF> singles;
    ImageF before;
    for (int i = 0; i < 3; ++i) {
        tracer.add_samples(1);
        const ImageF mean = tracer.result().pictures[0];
        ImageF sample = mean;  // (i + 1) mean_(i + 1) - i mean_i
        for (std::size_t k = 0; i > 0 && k < mean.pixels.size(); ++k)
            sample.pixels[k] = float(i + 1) * mean.pixels[k] - float(i) * before.pixels[k];
        singles.push_back(sample);
        before = mean;
    }
    for (int i = 1; i < 3; ++i) {
        std::size_t moved = 0;
        for (std::size_t k = 0; k < before.pixels.size(); ++k)
            moved += std::abs(singles[std::size_t(i)].pixels[k].x - singles[std::size_t(i - 1)].pixels[k].x) > 1e-4f;
        EXPECT_GT(moved, before.pixels.size() * 9 / 10) << "pass " << i;
    }
}

TEST(BackgroundTracer, SolvesTheWhiteFurnace)
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(emitter(0.5f, 0.5f)), true);
    const Scene scene = b.build();
    for (int bounces : {0, 1, 2, 5}) {
        TraceJob job = job_in_room(32);
        job.bounces = bounces;
        const auto r = traced(scene, job, 64);
        // L = Le (1 + rho + ... + rho^n), rho = Le = 1/2
        expect_radiance({r->mean.mean.x, r->mean.standard_error.x}, 1.0 - std::pow(2.0, -(bounces + 1)));
        EXPECT_EQ(r->samples, 64);
        EXPECT_EQ(r->pixel_error > 0.0, bounces > 0);
    }
}

TEST(BackgroundTracer, IsThePathTracerWithAnyNumberOfThreads)
{
    const Scene scene = room();
    const TraceJob job = job_in_room(40);
    const auto expected = path_trace(scene, job.camera, options_of(job, 21)).pictures[0].pixels;
    for (int threads : {0, 1, 3}) EXPECT_EQ(traced(scene, job, 21, threads)->picture.pixels, expected) << threads;
}

TEST(BackgroundTracer, GoesOnWhereItWas)
{
    const Scene scene = room();
    const TraceJob job = job_in_room();
    BackgroundTracer tracer(scene);
    for (int frame = 1; frame <= 3; ++frame) {
        tracer.follow(job, 5 * frame);
        tracer.wait();
        EXPECT_EQ(tracer.newest()->samples, 5 * frame);
    }
    EXPECT_EQ(tracer.newest()->picture.pixels, traced(scene, job, 15)->picture.pixels);
}

TEST(BackgroundTracer, ForgetsTheSamplesOfAnotherCameraPartOrSize)
{
    const Scene scene = room();
    const TraceJob first = job_in_room();
    TraceJob camera = first, part = first, size = first, bounces = first, sky = first;
    camera.camera.world_from_camera[3].x += 0.1f;
    part.part = Part::indirect_diffuse;
    size.size = {16, 20};
    bounces.bounces = 1;
    sky.sky = 1.0f;
    for (const TraceJob& job : {camera, part, size, bounces, sky}) {
        BackgroundTracer tracer(scene);
        tracer.follow(first, 8);
        tracer.wait();
        tracer.follow(job, 6);
        EXPECT_TRUE(tracer.newest() == nullptr || tracer.newest()->samples <= 6);
        tracer.wait();
        EXPECT_EQ(tracer.newest()->samples, 6);
        EXPECT_EQ(tracer.newest()->picture.pixels, traced(scene, job, 6)->picture.pixels);
    }
}

// A pass of long paths in a white room is under way when the next job comes, and when the tracer goes.
TEST(BackgroundTracer, NeverMakesAnyoneWait)
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(lambert(0.99f)), true);
    b.point_light({0.1f, 0.2f, 0.3f}, {1, 1, 1});
    const Scene scene = b.build();
    TraceJob large = job_in_room(2048);
    large.bounces = -1;
    const TraceJob small = job_in_room();
    const auto expected = traced(scene, small, 4)->picture.pixels;
    const auto under_way = std::chrono::milliseconds(200);
    const auto start = std::chrono::steady_clock::now();
    {
        BackgroundTracer tracer(scene);
        tracer.follow(large, 64);
        std::this_thread::sleep_for(under_way);
        EXPECT_EQ(tracer.newest(), nullptr);
        tracer.follow(small, 4);
        EXPECT_TRUE(tracer.newest() == nullptr || tracer.newest()->samples <= 4);
        tracer.wait();
        EXPECT_EQ(tracer.newest()->picture.pixels, expected);
        tracer.follow(large, 64);
        std::this_thread::sleep_for(under_way);
    }
    // One such pass takes 10 s on two cores that have nothing else to do.
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 3.0);
}

gl::Texture texture_of(const std::vector<glm::vec4>& pixels, glm::ivec2 size)
{
    gl::Texture texture = gl::texture_2d("test", GL_RGBA32F, size);
    glTextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, pixels.data());
    return texture;
}

TEST(SideBySide, TheDifferenceOfAPictureToItselfIsNeutral)
{
    SideBySide side_by_side(test_gl().shaders);
    const gl::Texture picture =
        texture_of({{0.1f, 2, 30, 1}, {0, 0, 0, 1}, {1e-4f, 0, 1, 1}, {5, 5, 5, 1}}, {2, 2});
    const auto r = side_by_side.run(Show::difference, &picture, &picture, Encoding::radiance, 0.5f);
    for (const glm::vec4& p : read_picture(*r.linear).pixels) EXPECT_EQ(p, glm::vec4(0, 0, 0, 1));
    for (const glm::vec4& p : read_picture(*r.shown).pixels) EXPECT_EQ(p, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(r.encoding, Encoding::data);
}

TEST(SideBySide, TheDifferenceHasSignAndSizeOfItsFormula)
{
    SideBySide side_by_side(test_gl().shaders);
    const std::vector<glm::vec4> i{{3, 3, 3, 1}, {1, 1, 1, 1}, {0, 1, 2, 1}, {7, 7, 7, 1}, {1.02f, 1.02f, 1.02f, 1}};
    const std::vector<glm::vec4> r{{1, 1, 1, 1}, {3, 3, 3, 1}, {2, 1, 0, 1}, {7, 7, 7, 0}, {1, 1, 1, 1}};
    const gl::Texture picture = texture_of(i, {5, 1}), reference = texture_of(r, {5, 1});
    const auto result = side_by_side.run(Show::difference, &picture, &reference, Encoding::radiance, 0.5f);
    const ImageF linear = read_picture(*result.linear), colors = read_picture(*result.shown);
    for (int x : {0, 1, 2, 4})
        for (int c = 0; c < 3; ++c) {
            const double a = i[std::size_t(x)][c], b = r[std::size_t(x)][c];
            EXPECT_NEAR(linear.at(x, 0)[c], (a - b) / (a + b), 1e-6) << x;
        }
    // A factor of three is the full colour: red above, blue below.
    EXPECT_NEAR(colors.at(0, 0).x, 1.0, 1e-6);
    EXPECT_NEAR(colors.at(0, 0).z, 0.0, 1e-6);
    EXPECT_NEAR(colors.at(1, 0).x, 0.0, 1e-6);
    EXPECT_NEAR(colors.at(1, 0).z, 1.0, 1e-6);
    // Channels that differ and have the same sum: the colours are of the sum.
    EXPECT_EQ(glm::vec3(colors.at(2, 0)), glm::vec3(0.0f));
    // No geometry in the reference: grey, and 0.
    EXPECT_EQ(linear.at(3, 0), glm::vec4(0.0f));
    EXPECT_NEAR(colors.at(3, 0).x, 96.0 / 255.0, 1e-6);
    EXPECT_EQ(colors.at(3, 0).x, colors.at(3, 0).z);
    // A little is dark, and the hue tells which.
    EXPECT_NEAR(colors.at(4, 0).x, 0.02 / 2.02 / 0.5, 1e-5);
    EXPECT_GT(colors.at(4, 0).x, 10.0f * colors.at(4, 0).y);
    EXPECT_EQ(colors.at(4, 0).z, 0.0f);
}

TEST(SideBySide, ShowsNoReferenceOfAnotherSize)
{
    SideBySide side_by_side(test_gl().shaders);
    auto newest = std::make_shared<Refinement>();
    newest->picture = {2, 2, {{1, 2, 3, 1}, {4, 5, 6, 1}, {7, 8, 9, 1}, {1, 0, 1, 1}}};
    EXPECT_EQ(read_picture(side_by_side.upload(newest, {2, 2})).pixels, newest->picture.pixels);
    for (const glm::vec4& p : read_picture(side_by_side.upload(newest, {1, 4})).pixels) EXPECT_EQ(p, glm::vec4(0.0f));
    for (const glm::vec4& p : read_picture(side_by_side.upload(nullptr, {2, 2})).pixels) EXPECT_EQ(p, glm::vec4(0.0f));
}

ImageF render(const std::string& program, const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string file = (folder / "picture.exr").string();
    const ProgramRun run = run_program(program, arguments + " --output '" + file + "'");
    EXPECT_EQ(run.code, 0) << run.output;
    return run.code == 0 ? read_exr(file) : ImageF{1, 1, {glm::vec4(-1.0f)}};
}

ImageF frame(const std::string& view, const std::string& set, const std::string& more = "")
{
    return render("13_ground_truth", "--headless --size 41x32 --view " + view + " " + more + " --set voxels=16 " + set);
}

TEST(GroundTruth, TheReferenceViewIsTheReferenceProgram)
{
    const ImageF expected = render("reference", "--size 41x32 --spp 6 --bounces 2 --sky 0.25 --scene '" +
                                                    asset("cornell_box").string() + "'");
    EXPECT_GT(expected.at(20, 16).x, 0.01f);
    EXPECT_EQ(frame("reference", "spp=6 bounces=2 sky=0.25").pixels, expected.pixels);
    EXPECT_EQ(frame("final", "spp=6 bounces=2 sky=0.25 show=reference").pixels, expected.pixels);
    EXPECT_EQ(frame("reference", "spp=2 bounces=2 sky=0.25", "--frames 3").pixels, expected.pixels);
    EXPECT_NE(frame("reference", "spp=6 bounces=1 sky=0.25").pixels, expected.pixels);
}

TEST(GroundTruth, TheSplitPictureIsHalfOfEach)
{
    const ImageF split = frame("indirect_diffuse", "spp=2 show=split");
    const ImageF picture = frame("indirect_diffuse", "spp=2"),
                 reference = frame("indirect_diffuse", "spp=2 show=reference");
    const std::string chapter_12 = "--headless --size 41x32 --view indirect_diffuse --set voxels=16";
    EXPECT_EQ(picture.pixels, render("12_second_bounce", chapter_12).pixels);
    std::size_t different = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 41; ++x) {
            ASSERT_EQ(split.at(x, y), (x < 20 ? picture : reference).at(x, y)) << x << " " << y;
            different += picture.at(x, y) != reference.at(x, y);
        }
    EXPECT_GT(different, 1000u);
    const ImageF difference = frame("indirect_diffuse", "spp=2 show=difference");
    for (std::size_t k = 0; k < difference.pixels.size(); ++k) {
        const float i = picture.pixels[k].x, r = reference.pixels[k].x;
        const bool compared = reference.pixels[k].w > 0.0f && i + r > 0.0f;
        ASSERT_NEAR(difference.pixels[k].x, compared ? (i - r) / (i + r) : 0.0f, 1e-5f);
    }
}

TEST(GroundTruth, AViewThatIsNoLightHasNoReference)
{
    const TemporaryFolder folder;
    const std::string output = " --output '" + (folder / "x.png").string() + "'";
    const ProgramRun run =
        run_program("13_ground_truth", "--headless --size 32x32 --view depth --set show=split voxels=16" + output);
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.output.find("--view depth"), std::string::npos) << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Frames go on while the reference refines: the left half is the cones' picture, the right half has light.
TEST(GroundTruth, AWindowShowsFramesWhileTheReferenceRefines)
{
    if (std::system("command -v xvfb-run > /dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed (package xvfb)";
    const TemporaryFolder folder;
    const std::string arguments = "--size 320x180 --set voxels=16 bounces=1 show=split spp=1 accumulate=off --output '";
    const std::string window = (folder / "window.png").string(), headless = (folder / "headless.png").string();
    const std::string stats = (folder / "stats.json").string();
    const std::string command = "xvfb-run -a -s '-screen 0 1280x1024x24' '" + program_folder() +
                                "/13_ground_truth' --frames 8 --stats '" + stats + "' " + arguments + window + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const ProgramRun run = run_program("13_ground_truth", "--headless " + arguments + headless + "'");
    ASSERT_EQ(run.code, 0) << run.output;
    const Image8 a = read_png(window), b = read_png(headless);
    ASSERT_EQ(a.rgba.size(), b.rgba.size());
    int largest = 0, right = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const std::size_t k = (std::size_t(y) * std::size_t(a.width) + std::size_t(x)) * 4 + std::size_t(c);
                if (x < a.width / 2) largest = std::max(largest, std::abs(int(a.rgba[k]) - int(b.rgba[k])));
                else right = std::max(right, int(a.rgba[k]));
            }
    EXPECT_LE(largest, 1);
    EXPECT_GT(right, 100);
    EXPECT_GT(count_of(read_statistics(stats), "samples per pixel"), 1.0);
}

struct LadderRun {
    int code = -1;
    std::string output;
    nlohmann::json json;
};

LadderRun ladder(const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string file = (folder / "ladder.json").string();
    const std::string command = "python3 '" + (repository_folder() / "tools" / "ladder.py").string() + "' --bin '" +
                                program_folder() + "' --size 32x32 --voxels 16 --spp 32 --json '" + file + "' " +
                                arguments + " 2>&1";
    LadderRun run;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return run;
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) run.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    if (std::ifstream in(file); in) run.json = nlohmann::json::parse(in);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), run.code == 0 ? 1 : 0);
    return run;
}

double step(const LadderRun& run, int rung) { return run.json.at("rungs").at(std::size_t(rung)).at("step_percent"); }

TEST(Ladder, StepsAddUpAndABrokenRungShows)
{
    const LadderRun whole = ladder("");
    ASSERT_EQ(whole.code, 0) << whole.output;
    double sum = 0.0;
    for (int rung = 1; rung <= 5; ++rung) sum += step(whole, rung);
    // Each picture is rounded to float, 6e-8, and the means are of thousands of them.
    EXPECT_NEAR(sum, whole.json.at("total_percent").get<double>(), 1e-3);
    EXPECT_LT(step(whole, 1), -20.0) << "one bounce is far from all of them in this box";

    // R1, measured once more: its mean is the reference's of one bounce.
    const ImageF r1 = render("reference", "--size 32x32 --spp 32 --bounces 1 --part indirect_diffuse --scene '" +
                                              asset("cornell_box").string() + "'");
    double mean = 0.0;
    for (const glm::vec4& p : r1.pixels) mean += (double(p.x) + p.y + p.z) / (3.0 * double(r1.pixels.size()));
    EXPECT_NEAR(whole.json.at("rungs").at(1).at("mean").get<double>(), mean, 1e-6 * mean);

    // The cones go one bounce further than the path tracer: R2 stands off by what R1 lacks, and the others stay.
    const LadderRun broken = ladder("--set bounces=2 cones=6");
    ASSERT_EQ(broken.code, 0) << broken.output;
    EXPECT_GT(step(broken, 2), step(whole, 2) + 20.0);
    // Half of the light is lost between R1 and R2.
    const LadderRun dimmed = ladder("--set bounce_strength=0.5");
    ASSERT_EQ(dimmed.code, 0) << dimmed.output;
    EXPECT_NEAR(step(dimmed, 2), 0.5 * (100.0 + step(whole, 2)) - 100.0, 0.01);
    EXPECT_NEAR(step(dimmed, 1), step(whole, 1), 1e-9);
}

TEST(Ladder, SaysInOneLineWhatIsWrong)
{
    const std::pair<const char*, const char*> faults[] = {{"--scene no_such.glb", "no_such.glb"},
                                                          {"--size 32", "--size 32"},
                                                          {"--view depth", "depth"},
                                                          {"--set no_such=1", "no_such"},
                                                          {"--view indirect_specular", "black"},
                                                          {"--bin /nowhere", "/nowhere"}};
    for (const auto& [arguments, named] : faults) {
        const LadderRun run = ladder(arguments);
        EXPECT_EQ(run.code, 1) << arguments;
        const std::size_t end = run.output.rfind("ladder: ");
        ASSERT_NE(end, std::string::npos) << run.output;
        const std::string last = run.output.substr(end);
        EXPECT_NE(last.find(named), std::string::npos) << last;
        EXPECT_EQ(std::count(last.begin(), last.end(), '\n'), 1) << last;
        EXPECT_EQ(run.output.find("Traceback"), std::string::npos) << run.output;
    }
}

}  // namespace
}  // namespace conebook
