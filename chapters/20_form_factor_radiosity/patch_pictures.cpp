#include "20_form_factor_radiosity/patch_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "gl/pixel_pass.hpp"
#include "reference/random.hpp"

namespace conebook {
namespace {

struct ValueVertex {
    glm::vec3 position, value;
};

glm::vec3 patch_color(std::uint32_t patch)
{
    const std::uint64_t bits = mix_bits(patch + 1u);
    const auto channel = [&](int shift) { return 0.15f + 0.8f * float(bits >> shift & 0xff) / 255.0f; };
    return {channel(0), channel(8), channel(16)};
}

ImageF black_picture(glm::ivec2 size)
{
    return {size.x, size.y, std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y), glm::vec4(0.0f))};
}

}  // namespace

PatchValuePass::PatchValuePass(gl::Shaders& shaders)
    : program_(
          shaders.load({"20_form_factor_radiosity/patch_values.vert", "20_form_factor_radiosity/patch_values.frag"}))
{
}

const gl::Texture& PatchValuePass::run(const GBuffer& g_buffer, const Patches& patches, const CornerValues& values,
                                       float scale, const std::pair<const void*, Revision>& values_of)
{
    if (vertices_from_.differs(values_of.first, values_of.second)) {
        std::vector<ValueVertex> vertices;
        vertices.reserve(3 * patches.size());
        for (std::size_t i = 0; i < patches.size(); ++i)
            for (const std::size_t k : patches[i].back ? std::array{0, 2, 1} : std::array{0, 1, 2}) {
                const PatchNode& node = patches.mesh().nodes()[patches[i].node];
                vertices.push_back({patches.mesh().points()[node.corners[k]], values[i][k]});
            }
        vertices_ = gl::Buffer("values of patches", vertices);
        const GLuint vao = vertex_array_.id();
        glVertexArrayVertexBuffer(vao, 0, vertices_.id(), 0, sizeof(ValueVertex));
        for (GLuint i = 0; i < 2; ++i) {
            glEnableVertexArrayAttrib(vao, i);
            glVertexArrayAttribFormat(vao, i, 3, GL_FLOAT, GL_FALSE, i * GLuint(sizeof(glm::vec3)));
            glVertexArrayAttribBinding(vao, i, 0);
        }
    }
    gl::fit_to_pixels(values_, framebuffer_, "values of patches", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    framebuffer_.bind(g_buffer.size());
    constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, kNothing);
    program_.set("scale", scale);
    program_.use();
    glBindVertexArray(vertex_array_.id());
    glCullFace(GL_BACK);
    glEnable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, GLsizei(3 * patches.size()));
    glDisable(GL_CULL_FACE);
    return values_;
}

void add_parameters(ParameterTable& table, PixelParams& params)
{
    table.add("pixel_samples", params.pixel_samples, 1, 4, "samples",
              "along each side of a pixel, in pictures of light");
    table.add("lobe_rays", params.lobe_rays, 1, 64, "rays", "of a sample into lobes that are too rough for a mirror");
}

BoxFilterPass::BoxFilterPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "20_form_factor_radiosity/box_filter.frag"}))
{
}

const gl::Texture& BoxFilterPass::run(const gl::Texture& samples, int side)
{
    if (side == 1) return samples;
    gl::fit_to_pixels(color_, framebuffer_, "picture", GL_RGBA32F, samples.size_2d() / side);
    samples.bind(16);
    program_.set("side", side);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, color_.size_2d());
    return color_;
}

namespace {

// Radiance along a ray that a surface sends out, over mirrors, each of which has light of its own too.
glm::vec3 radiance_along(const Radiosity& radiosity, const RadiosityParams& params, const std::vector<Light>& lights,
                         Reflection ray)
{
    const Patches& patches = radiosity.patches();
    const int bounces = params.solver.bounces;
    glm::vec3 sum(0.0f);
    // snippet: radiance_along
    for (int bounce = 1; bounces < 0 || bounce <= bounces; ++bounce) {
        const auto hit = patches.tracer().intersect({ray.origin, ray.direction});
        const std::uint32_t patch = hit ? patches.at(*hit) : kNoPatch;
        if (patch == kNoPatch) break;
        glm::vec3 rho = hit->brdf.rho;
        if (!patches.is_mirror(hit->brdf)) rho += mean_reflectance(hit->brdf.f0, hit->brdf.f90);
        glm::vec3 radiosity_here = directly_lit(patches.tracer(), lights, *hit, rho);
        if (const CornerValues* const before = radiosity.corners_before(bounce - 1)) {
            const glm::vec3 w = patches.place(*hit).weights;
            const auto& h = (*before)[patch];
            radiosity_here += rho * (w.x * h[0] + w.y * h[1] + w.z * h[2]);
        }
        sum += ray.weight * (hit->emission + radiosity_here / kPi);
        const Reflection next = patches.reflect(*hit, ray.direction);
        ray = {next.origin, next.direction, ray.weight * next.weight};
        if (ray.weight == glm::vec3(0.0f) || bounce > params.form_factors.reflections) break;
    }
    // end snippet
    return sum;
}

}  // namespace

ImageF specular_picture(const Radiosity& radiosity, const RadiosityParams& params, int lobe_rays,
                        const std::vector<Light>& lights, const Camera& camera, glm::ivec2 size)
{
    const Patches& patches = radiosity.patches();
    const SceneTracer& tracer = patches.tracer();
    const DepthRange depths = visible_depths(camera, tracer.scene().bounds);
    ImageF picture = black_picture(size);
    for_all(picture.pixels.size(), [&](std::size_t i) {
        const int x = int(i) % size.x, y = int(i) / size.x;
        const Ray ray = camera_ray(camera, depths, float(x) + 0.5f, float(y) + 0.5f, size.x, size.y);
        const auto hit = tracer.intersect_camera(ray);
        if (!hit || !hit->brdf.has_specular()) return;
        const glm::vec3 direction = glm::normalize(ray.direction);
        if (patches.is_mirror(hit->brdf)) {
            const glm::vec3 sum = radiance_along(radiosity, params, lights, patches.reflect(*hit, direction));
            picture.pixels[i] = glm::vec4(sum, 1.0f);
            return;
        }
        // The lobe alone, sampled by its visible normals.
        Brdf lobe = hit->brdf;
        lobe.rho = glm::vec3(0.0f);
        const Frame frame(hit->shading_normal);
        const glm::vec3 wo = clamp_view(frame.to_local(-direction));
        glm::vec3 sum(0.0f);
        const std::uint64_t bits = mix_bits(i + 1);
        for (int r = 0; r < lobe_rays; ++r) {
            const glm::vec2 u = sequence_02(std::uint32_t(r), std::uint32_t(bits), std::uint32_t(bits >> 32));
            const glm::vec3 wi = sample_brdf(lobe, wo, u, 0.0f);
            const float pdf = pdf_brdf(lobe, wo, wi);
            const glm::vec3 towards = frame.to_scene(wi);
            if (!(pdf > 0.0f) || wi.z <= 0.0f || glm::dot(towards, hit->geometric_normal) <= 0.0f) continue;
            const glm::vec3 weight = evaluate_brdf(lobe, wo, wi).specular * (wi.z / pdf / float(lobe_rays));
            sum += radiance_along(radiosity, params, lights, {tracer.leave(*hit), towards, weight});
        }
        picture.pixels[i] = glm::vec4(sum, 1.0f);
    });
    return picture;
}

const gl::Texture& UploadedPicture::set(const ImageF& picture)
{
    const glm::ivec2 size(picture.width, picture.height);
    if (!texture_ || texture_.size_2d() != size) texture_ = gl::texture_2d("picture of the CPU", GL_RGBA32F, size);
    // Pictures have the top row first, textures the bottom row.
    for (int y = 0; y < size.y; ++y)
        glTextureSubImage2D(texture_.id(), 0, 0, size.y - 1 - y, size.x, 1, GL_RGBA, GL_FLOAT, &picture.at(0, y));
    return texture_;
}

void add_parameters(ParameterTable& table, PatchPickParams& params)
{
    table.add("pick_x", params.pick_x, 0.0, 1.0, "", "whose form factors and hemicube are shown: place from the left");
    table.add("pick_y", params.pick_y, 0.0, 1.0, "", "and from the top");
}

std::uint32_t picked_patch(const Patches& patches, const PatchPickParams& params, const Camera& camera, glm::ivec2 size)
{
    const SceneTracer& tracer = patches.tracer();
    const Ray ray = camera_ray(camera, visible_depths(camera, tracer.scene().bounds), params.pick_x * float(size.x),
                               params.pick_y * float(size.y), size.x, size.y);
    const auto hit = tracer.intersect_camera(ray);
    return hit ? patches.at(*hit) : kNoPatch;
}

std::vector<View> patch_views()
{
    return {
        {"patches", Encoding::color, "the patches, each in a colour of its own"},
        {"radiosity", Encoding::radiance, "radiosity / pi, one value a patch, W/(sr m^2)"},
        {"form_factors", Encoding::color, "F_ij / A_j of the picked patch i, over the largest; the patch itself blue"},
        {"hemicube", Encoding::color, "item buffer of the picked patch, the sides folded down round the top"}};
}

std::optional<CornerValues> patch_view_values(const std::string& view, const Radiosity& radiosity, std::uint32_t picked)
{
    const Patches& patches = radiosity.patches();
    Irradiance values(patches.size(), glm::vec3(0.0f));
    if (view == "patches") {
        for (std::uint32_t i = 0; i < patches.size(); ++i) values[i] = patch_color(i);
    } else if (view == "radiosity") {
        values = radiosity_of(patches, radiosity.solution().irradiance());
        for (glm::vec3& v : values) v /= kPi;
    } else if (view == "form_factors") {
        if (picked != kNoPatch) {
            const FormFactorRow& row = radiosity.form_factors().rows[picked];
            for (const FormFactorEntry& f : row.direct) values[f.patch] += glm::vec3(f.share);
            for (const MirroredFormFactor& f : row.mirrored) values[f.patch] += f.share;
            float most = 0.0f;
            for (std::size_t i = 0; i < patches.size(); ++i) {
                if (patches[i].area > 0.0f) values[i] /= patches[i].area;
                most = std::max({most, values[i].x, values[i].y, values[i].z});
            }
            for (glm::vec3& v : values) v /= std::max(most, 1e-30f);
            values[picked] = {0.1f, 0.3f, 1.0f};
        }
    } else {
        return std::nullopt;
    }
    CornerValues corners(patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) corners[i].fill(values[i]);
    return corners;
}

ImageF hemicube_picture(Radiosity& radiosity, const RadiosityParams& params, std::uint32_t patch, glm::ivec2 size)
{
    ImageF picture = black_picture(size);
    const Patches& patches = radiosity.patches();
    if (patch == kNoPatch || patches[patch].exposed == 0) return picture;
    const int r = params.form_factors.resolution / 2 * 2, half = r / 2;
    const SurfaceHit middle = patches.point(patches[patch], glm::vec3(1.0f / 3.0f));
    const std::vector<Item> items = radiosity.hemicubes().render({hemicube_view(patches, patch, middle)}, r);
    const HemicubeLayout layout{r};
    // Texel of a place in the unfolded cube, 2 r x 2 r; the corners are nothing.
    const auto texel_at = [&](int x, int y) -> std::optional<glm::ivec2> {
        const bool in_x = x >= half && x < half + r, in_y = y >= half && y < half + r;
        if (in_x && in_y) return layout.corner(0) + glm::ivec2(x - half, y - half);
        if (in_y && x >= half + r) return layout.corner(1) + glm::ivec2(y - half, 2 * r - 1 - x);
        if (in_x && y >= half + r) return layout.corner(2) + glm::ivec2(half + r - 1 - x, 2 * r - 1 - y);
        if (in_y && x < half) return layout.corner(3) + glm::ivec2(half + r - 1 - y, x);
        if (in_x && y < half) return layout.corner(4) + glm::ivec2(x - half, y);
        return std::nullopt;
    };
    const int side = std::min(size.x, size.y), left = (size.x - side) / 2, top = (size.y - side) / 2;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto texel = texel_at(x * 2 * r / side, (side - 1 - y) * 2 * r / side);
            if (!texel) continue;
            const Item& item = items[std::size_t(texel->y * layout.size().x + texel->x)];
            const std::uint32_t seen =
                item.seen() ? patches.on(patches.mesh().find(item.triangle(), item.uv()).node, item.front()) : kNoPatch;
            picture.at(left + x, top + y) = glm::vec4(seen == kNoPatch ? glm::vec3(0.02f) : patch_color(seen), 1.0f);
        }
    return picture;
}

}  // namespace conebook
