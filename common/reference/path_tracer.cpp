#include "reference/path_tracer.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "reference/emitters.hpp"
#include "reference/random.hpp"

namespace conebook {
namespace {

constexpr int kPartCount = 5;
constexpr int kRouletteStart = 4;  // bounces before Russian roulette may end a path
constexpr int kTile = 16;          // pixels
constexpr int kPassSpp = 16;       // samples per pixel between two looks at the clock

bool any(const glm::vec3& v) { return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f; }
float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Power heuristic with exponent 2 (Veach 1997, section 9.2.4).
float power_heuristic(float a, float b)
{
    const float a2 = a * a, b2 = b * b;
    return a2 + b2 > 0.0f ? a2 / (a2 + b2) : 0.0f;
}

// A surface with its shading frame and the clamped local view direction.
struct Vertex3 {
    const SurfaceHit* hit;
    Frame frame;
    glm::vec3 wo;     // local, clamped
    glm::vec3 leave;  // start of rays
    Vertex3(const SceneTracer& tracer, const SurfaceHit& h, const glm::vec3& view)
        : hit(&h), frame(h.shading_normal), wo(clamp_view(frame.to_local(view))), leave(tracer.leave(h))
    {
    }

    // f cos for light from `wi` (scene space, unit), zero below the geometric surface.
    BrdfValue reflect(const glm::vec3& wi) const
    {
        if (glm::dot(wi, hit->geometric_normal) <= 0.0f) return {};
        const glm::vec3 local = frame.to_local(wi);
        if (local.z <= 0.0f) return {};
        BrdfValue f = evaluate_brdf(hit->brdf, wo, local);
        f.diffuse *= local.z;
        f.specular *= local.z;
        return f;
    }
};

struct Sample {
    glm::vec3 direct{0.0f}, indirect_diffuse{0.0f}, indirect_specular{0.0f}, emission{0.0f};
    bool covered = false;
};

class Integrator {
public:
    Integrator(const Scene& scene, int threads)
        : tracer_(scene, threads), emitters_(scene), diameter_(glm::length(scene.bounds.extent()))
    {
    }

    const Scene& scene() const { return tracer_.scene(); }

    // Along one ray of the camera, with `bounces` and `sky` as in PathTraceOptions.
    Sample sample(const Ray& camera, int bounces, const glm::vec3& sky, Pcg32& rng) const
    {
        Sample s;
        auto hit = tracer_.intersect_camera(camera);
        if (!hit) {
            s.emission = sky;
            return s;
        }
        s.covered = true;
        glm::vec3 view = -glm::normalize(camera.direction);
        s.emission = hit->emission;
        s.direct = direct_light(Vertex3(tracer_, *hit, view)).sum();

        // One path serves both lobes of the visible surface: it carries a throughput for each.
        glm::vec3 beta_diffuse(1.0f), beta_specular(1.0f);
        for (int bounce = 1; bounces < 0 || bounce <= bounces; ++bounce) {
            if (!hit->brdf.has_diffuse() && !hit->brdf.has_specular()) break;
            const Vertex3 x(tracer_, *hit, view);
            const bool first = bounce == 1;
            const auto through = [&](const BrdfValue& f) {
                return first ? std::pair(f.diffuse, f.specular)
                             : std::pair(beta_diffuse * f.sum(), beta_specular * f.sum());
            };

            // snippet: next_event
            if (!emitters_.empty()) {
                float weight = 0.0f;
                glm::vec3 wi, radiance;
                if (sample_emitter(x, rng, wi, radiance, weight)) {
                    const auto [diffuse, specular] = through(x.reflect(wi));
                    s.indirect_diffuse += diffuse * radiance * weight;
                    s.indirect_specular += specular * radiance * weight;
                }
            }
            // end snippet

            const glm::vec2 u = rng.next_2d();
            const glm::vec3 wi_local = sample_brdf(hit->brdf, x.wo, u, rng.next());
            const float pdf = pdf_brdf(hit->brdf, x.wo, wi_local);
            if (!(pdf > 0.0f)) break;
            const glm::vec3 wi = x.frame.to_scene(wi_local);
            std::tie(beta_diffuse, beta_specular) = through(x.reflect(wi));
            beta_diffuse /= pdf;
            beta_specular /= pdf;
            if (!any(beta_diffuse) && !any(beta_specular)) break;
            // snippet: roulette
            if (bounce >= kRouletteStart) {
                // Kept below 1 so that a path ends even where nothing absorbs.
                const float survive = std::min(0.95f, largest(beta_diffuse + beta_specular));
                if (rng.next() >= survive) break;
                beta_diffuse /= survive;
                beta_specular /= survive;
            }
            // end snippet

            const auto next = tracer_.intersect({x.leave, wi});
            if (!next) {
                s.indirect_diffuse += beta_diffuse * sky;
                s.indirect_specular += beta_specular * sky;
                break;
            }
            if (next->dark) break;
            // snippet: emitter_hit
            glm::vec3 gathered(0.0f);
            if (any(next->emission)) {
                const float cosine = -glm::dot(wi, next->geometric_normal);
                const glm::vec3 way = next->position - hit->position;
                const float pdf_emitter = emitters_.pdf_area(*next) * glm::dot(way, way) / std::max(cosine, 1e-7f);
                gathered += next->emission * power_heuristic(pdf, pdf_emitter);
            }
            view = -wi;
            gathered += direct_light(Vertex3(tracer_, *next, view)).sum();
            // end snippet
            s.indirect_diffuse += beta_diffuse * gathered;
            s.indirect_specular += beta_specular * gathered;
            hit = next;
        }
        return s;
    }

private:
    // Radiance that punctual lights send to the eye by way of x, per lobe.
    BrdfValue direct_light(const Vertex3& x) const
    {
        BrdfValue sum;
        if (!x.hit->brdf.has_diffuse() && !x.hit->brdf.has_specular()) return sum;
        for (const Light& light : tracer_.scene().lights) {
            glm::vec3 target;
            const glm::vec3 irradiance = unshadowed_irradiance(light, x.hit->position, diameter_, &target);
            if (!any(irradiance)) continue;
            const glm::vec3 way = target - x.hit->position;
            const float distance = glm::length(way);
            if (!(distance > 0.0f)) continue;
            const BrdfValue f = x.reflect(way / distance);
            if (!any(f.sum())) continue;
            if (tracer_.occluded(x.leave, target)) continue;
            sum.diffuse += f.diffuse * irradiance;
            sum.specular += f.specular * irradiance;
        }
        return sum;
    }

    // A point on an emitter: direction, radiance, and MIS weight / density per solid angle. False when it is not seen.
    bool sample_emitter(const Vertex3& x, Pcg32& rng, glm::vec3& wi, glm::vec3& radiance, float& weight) const
    {
        const float choice = rng.next();
        const auto e = emitters_.sample(x.hit->position, choice, rng.next_2d());
        if (!e) return false;
        const glm::vec3 way = e->position - x.hit->position;
        const float distance2 = glm::dot(way, way);
        if (!(distance2 > 0.0f)) return false;
        wi = way / std::sqrt(distance2);
        if (glm::dot(wi, x.hit->geometric_normal) <= 0.0f) return false;
        const float cosine = std::max(-glm::dot(wi, e->normal), 1e-7f);
        const float pdf = e->pdf_area * distance2 / cosine;
        const float pdf_other = pdf_brdf(x.hit->brdf, x.wo, x.frame.to_local(wi));
        if (pdf_other <= 0.0f) return false;
        if (tracer_.occluded(x.leave, e->position + tracer_.surface_offset() * e->normal)) return false;
        radiance = e->radiance;
        weight = power_heuristic(pdf, pdf_other) / pdf;
        return true;
    }

    SceneTracer tracer_;
    EmitterSampler emitters_;
    float diameter_;
};

struct Accumulator {
    glm::dvec3 sum{0.0}, sum_of_squares{0.0};
};

glm::vec3 value_of(const Sample& s, Part part)
{
    switch (part) {
        case Part::direct:
            return s.direct;
        case Part::indirect_diffuse:
            return s.indirect_diffuse;
        case Part::indirect_specular:
            return s.indirect_specular;
        case Part::emission:
            return s.emission;
        case Part::final:
            break;
    }
    return s.direct + s.indirect_diffuse + s.indirect_specular + s.emission;
}

void check(const PathTraceOptions& o)
{
    if (o.width <= 0 || o.height <= 0 || std::int64_t(o.width) * o.height > (std::int64_t(1) << 28))
        throw std::runtime_error("path tracer: impossible size " + std::to_string(o.width) + "x" +
                                 std::to_string(o.height));
    if (o.spp < 1) throw std::runtime_error("path tracer: samples per pixel must be at least 1");
    if (o.parts.empty() || o.parts.size() > kPartCount) throw std::runtime_error("path tracer: 1 to 5 parts, please");
    if (!finite(o.sky) || o.sky.x < 0 || o.sky.y < 0 || o.sky.z < 0)
        throw std::runtime_error("path tracer: the sky's radiance must be finite and not negative");
}

}  // namespace

Part part_from_name(const std::string& name)
{
    constexpr std::array<const char*, kPartCount> names{"final", "direct", "indirect_diffuse", "indirect_specular",
                                                        "emission"};
    for (int i = 0; i < kPartCount; ++i)
        if (name == names[i]) return Part(i);
    throw std::runtime_error("unknown part " + name +
                             " (final, direct, indirect_diffuse, indirect_specular, emission)");
}

glm::vec3 unshadowed_irradiance(const Light& light, const glm::vec3& position, float scene_diameter,
                                glm::vec3* to_light)
{
    if (light.type == LightType::directional) {
        *to_light = position - light.direction * (2.0f * scene_diameter + 1.0f);
        return light.intensity;
    }
    *to_light = light.position;
    const glm::vec3 way = light.position - position;
    const float distance = std::max(glm::length(way), kMinLightDistance);
    float factor = 1.0f / (distance * distance);
    if (light.range > 0.0f) {  // KHR_lights_punctual, "Range Property"
        const float r = distance / light.range;
        factor *= glm::clamp(1.0f - r * r * r * r, 0.0f, 1.0f);
    }
    if (light.type == LightType::spot) {  // KHR_lights_punctual, "Inner and Outer Cone Angles"
        const float outer = std::cos(light.outer_cone_angle);
        const float scale = 1.0f / std::max(kMinSpotCosineSpan, std::cos(light.inner_cone_angle) - outer);
        const float edge = glm::clamp((glm::dot(light.direction, -way / distance) - outer) * scale, 0.0f, 1.0f);
        factor *= edge * edge;
    }
    return light.intensity * factor;
}

struct PathTracer::Work {
    Work(const Scene& scene, int thread_count)
        : integrator(scene, thread_count),
          threads(thread_count > 0 ? thread_count : int(std::max(1u, std::thread::hardware_concurrency())))
    {
    }

    void render_tile(int tile, int first_sample, int last_sample);

    Integrator integrator;
    int threads;
    Camera camera;
    DepthRange depths{};
    PathTraceOptions options;
    std::vector<Accumulator> accumulators;  // a pixel's parts side by side
    std::vector<std::uint32_t> covered;     // samples that met geometry
    std::atomic<std::uint64_t> non_finite{0};
    int done = 0;  // samples of each pixel
    int tiles_x = 0, tiles_y = 0;
};

PathTracer::PathTracer(const Scene& scene, int threads) : work_(std::make_unique<Work>(scene, threads)) {}
PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;

void PathTracer::start(const Camera& camera, const PathTraceOptions& options)
{
    check(options);
    Work& w = *work_;
    const std::size_t pixels = std::size_t(options.width) * std::size_t(options.height);
    w.camera = camera;
    w.depths = visible_depths(camera, w.integrator.scene().bounds);
    w.options = options;
    w.accumulators.assign(pixels * options.parts.size(), {});
    w.covered.assign(pixels, 0);
    w.non_finite = 0;
    w.done = 0;
    w.tiles_x = (options.width + kTile - 1) / kTile;
    w.tiles_y = (options.height + kTile - 1) / kTile;
}

// snippet: sample_numbers
// Each pixel's samples are added by one thread at a time in ascending order: same sums for any number of threads.
void PathTracer::Work::render_tile(int tile, int first_sample, int last_sample)
{
    const int x0 = tile % tiles_x * kTile, y0 = tile / tiles_x * kTile;
    for (int y = y0; y < std::min(y0 + kTile, options.height); ++y)
        for (int x = x0; x < std::min(x0 + kTile, options.width); ++x) {
            const std::size_t pixel = std::size_t(y) * std::size_t(options.width) + std::size_t(x);
            for (int i = first_sample; i < last_sample; ++i) {
                Pcg32 rng(options.seed, pixel, std::uint64_t(i));
                const glm::vec2 jitter = rng.next_2d();
                const Ray ray = camera_ray(camera, depths, float(x) + jitter.x, float(y) + jitter.y, options.width,
                                           options.height);
                const Sample sample = integrator.sample(ray, options.bounces, options.sky, rng);
                // end snippet
                covered[pixel] += sample.covered;
                if (!finite(value_of(sample, Part::final))) {
                    ++non_finite;
                    continue;
                }
                for (std::size_t p = 0; p < options.parts.size(); ++p) {
                    const glm::dvec3 value = value_of(sample, options.parts[p]);
                    Accumulator& a = accumulators[pixel * options.parts.size() + p];
                    a.sum += value;
                    a.sum_of_squares += value * value;
                }
            }
        }
}

bool PathTracer::add_samples(int count, const std::stop_token& stop, const std::function<void(double)>& progress)
{
    Work& w = *work_;
    if (count < 1 || w.accumulators.empty()) throw std::logic_error("path tracer: add_samples without start or samples");
    const int first = w.done, last = w.done + count, tiles = w.tiles_x * w.tiles_y;
    std::atomic<int> next_tile{0}, running{w.threads};
    {
        std::vector<std::jthread> workers;
        for (int t = 0; t < w.threads; ++t)
            workers.emplace_back([&] {
                for (int tile; !stop.stop_requested() && (tile = next_tile++) < tiles;)
                    w.render_tile(tile, first, last);
                --running;
            });
        while (running > 0 && progress) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            progress(std::min(1.0, double(next_tile) / tiles));
        }
    }  // joins
    if (stop.stop_requested()) {
        // Some pixels have more samples than others.
        w.accumulators.clear();
        w.done = 0;
        return false;
    }
    w.done = last;
    return true;
}

PathTraceResult PathTracer::result() const
{
    const Work& w = *work_;
    if (w.done == 0) throw std::logic_error("path tracer: no samples yet");
    const std::size_t parts = w.options.parts.size(), pixels = w.covered.size();
    const double n = double(w.done);
    PathTraceResult result;
    result.spp = w.done;
    result.non_finite = w.non_finite;
    for (std::size_t p = 0; p < parts; ++p) {
        ImageF picture{w.options.width, w.options.height, std::vector<glm::vec4>(pixels)};
        ImageF error = picture;
        for (std::size_t i = 0; i < pixels; ++i) {
            // snippet: standard_error
            const Accumulator& a = w.accumulators[i * parts + p];
            const glm::dvec3 mean = a.sum / n;
            const glm::dvec3 variance = glm::max(a.sum_of_squares / n - mean * mean, glm::dvec3(0.0));
            picture.pixels[i] = glm::vec4(mean, float(double(w.covered[i]) / n));
            error.pixels[i] = glm::vec4(w.done > 1 ? glm::sqrt(variance / (n - 1.0)) : glm::dvec3(0.0), 1.0f);
            // end snippet
        }
        result.pictures.push_back(std::move(picture));
        result.errors.push_back(std::move(error));
    }
    return result;
}

PathTraceResult path_trace(const Scene& scene, const Camera& camera, const PathTraceOptions& options)
{
    check(options);
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    PathTracer tracer(scene, options.threads);
    tracer.start(camera, options);
    double sample_seconds = -seconds();
    for (int done = 0, pass = 0; done < options.spp; done += pass) {
        pass = std::min(kPassSpp, options.spp - done);
        std::function<void(double)> progress;
        if (options.progress)
            progress = [&](double share) { options.progress((done + share * pass) / options.spp, seconds()); };
        tracer.add_samples(pass, {}, progress);
        if (options.max_seconds > 0.0 && seconds() > options.max_seconds) break;
    }
    sample_seconds += seconds();
    PathTraceResult result = tracer.result();
    result.sample_seconds = sample_seconds;
    result.seconds = seconds();
    return result;
}

MeanWithError mean_radiance(const ImageF& picture, const ImageF& error)
{
    MeanWithError result;
    glm::dvec3 variance(0.0);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        result.mean += glm::dvec3(picture.pixels[i]);
        variance += glm::dvec3(error.pixels[i]) * glm::dvec3(error.pixels[i]);
    }
    const double n = double(picture.pixels.size());
    result.mean /= n;
    result.standard_error = glm::sqrt(variance) / n;
    return result;
}

}  // namespace conebook
