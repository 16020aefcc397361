#include "07_anisotropic_mips/light_pyramid.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, PyramidParams& params)
{
    table.add("directions", params.directions, {"per_face", "anisotropic", "isotropic"},
              "which levels tell the six directions apart: all, all but the finest, none");
    table.add("format", params.format, {"rgba16f", "rgba8", "r11g11b10f"}, "of the pyramids' texels");
}

void add_parameters(ParameterTable& table, PyramidViewParams& params)
{
    table.add("direction", params.direction, {"-x", "+x", "-y", "+y", "-z", "+z", "seen"},
              "direction that pyramid views show");
}

OccupiedLevels::OccupiedLevels(gl::Shaders& shaders)
    : parents_(shaders.load({"07_anisotropic_mips/occupied_parents.comp"}))
{
}

void OccupiedLevels::run(const VoxelGrid& grid, const VoxelFaces& faces)
{
    // No level has more occupied voxels than the one below, or than it has voxels.
    const GLuint voxels = faces.counted().voxels;
    const auto cells = [&](int level) {
        const glm::ivec3 size = grid.size() >> level;
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    };
    std::size_t total = 0;
    begin_.assign(1, 0);
    for (int level = 1; level < grid.levels(); ++level) {
        begin_.push_back(GLuint(total));
        total += std::min<std::size_t>(voxels, cells(level));
    }
    lists_ = gl::Buffer("occupied voxels of all levels", std::max<std::size_t>(total, 1) * sizeof(GLuint));
    std::vector<glm::uvec4> levels(std::size_t(grid.levels()), glm::uvec4(0, 1, 1, 0));
    levels[0] = glm::uvec4(gl::group_counts(voxels, 64), voxels);
    levels_ = gl::Buffer("occupied voxels by level", levels);
    const gl::Buffer claimed("claimed voxels", (cells(1) / 32 + 1) * sizeof(GLuint));

    grid.bind();
    for (int level = 1; level < grid.levels(); ++level) {
        claimed.clear();
        claimed.bind(GL_SHADER_STORAGE_BUFFER, shared::kClaimedBinding);
        (level == 1 ? faces.voxel_list() : lists_).bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelListBinding);
        parents_.set("finer_begin", begin_[std::size_t(level - 1)]);
        dispatch(parents_, level, level - 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    }
}

void OccupiedLevels::dispatch(const gl::Program& program, int level, int items_of) const
{
    lists_.bind(GL_SHADER_STORAGE_BUFFER, shared::kOccupiedBinding);
    levels_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLevelBinding);
    program.set("level", level);
    program.set("begin", begin_[std::size_t(level)]);
    program.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, levels_.id());
    glDispatchComputeIndirect(GLintptr(std::size_t(items_of) * sizeof(glm::uvec4)));
}

GLenum texel_format(LightFormat format)
{
    constexpr GLenum kFormats[] = {GL_RGBA16F, GL_RGBA8, GL_R11F_G11F_B10F};
    return kFormats[int(format)];
}

void fit_light_atlas(LightTexels& texels, const VoxelGrid& grid, LightFormat format)
{
    const glm::ivec3 size = grid.size() * glm::ivec3(shared::kFaceCount, 1, 1);
    const auto fit = [&](gl::Texture& texture, const char* label, GLenum kind) {
        if (texture && texture.size() == size && texture.levels() == grid.levels() && texture.format() == kind) return;
        texture = gl::texture_3d(label, kind, size, grid.levels());
        texture.set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    };
    fit(texels.light, "light pyramid", texel_format(format));
    texels.light.clear();
    if (format == LightFormat::r11g11b10f) {
        fit(texels.coverage, "coverage pyramid", GL_R8);
        texels.coverage.clear();
    } else {
        texels.coverage = {};
    }
    texels.defines.clear();
    texels.index.clear();
}

LightPyramid::LightPyramid(gl::Shaders& shaders, LightStorage storage)
    : storage_(std::move(storage)),
      unit_(shaders, {"07_anisotropic_mips/light_unit.comp"}),
      base_(shaders, {"07_anisotropic_mips/light_base.comp"}),
      next_level_(shaders, {"07_anisotropic_mips/light_level.comp"}),
      occupied_(shaders),
      scale_("light scale", std::vector{glm::vec4(1.0f)})
{
}

void LightPyramid::prepare(const VoxelGrid& grid, const VoxelFaces& faces, const PyramidParams& params)
{
    if (!prepared_for_.differs(faces.revision(), params)) return;
    const LightFormat format = params.format;
    occupied_.run(grid, faces);
    if (params.storage == VoxelStorage::dense)
        fit_light_atlas(texels_, grid, format);
    else
        storage_(texels_, grid, faces, occupied_, params);
    if (format != format_) scale_ = gl::Buffer("light scale", std::vector{glm::vec4(1.0f)});
    format_ = format;
}

void LightPyramid::bind() const
{
    texels_.light.bind(GLuint(shared::kLightAtlasUnit));
    if (texels_.coverage) texels_.coverage.bind(GLuint(shared::kCoverageAtlasUnit));
    for (const auto& [unit, texture] : texels_.index) texture->bind(unit);
    scale_.bind(GL_UNIFORM_BUFFER, shared::kPyramidBlock);
}

void LightPyramid::bind_as_emission() const
{
    texels_.light.bind(GLuint(shared::kEmissionAtlasUnit));
    scale_.bind(GL_UNIFORM_BUFFER, shared::kEmissionPyramidBlock);
}

void LightPyramid::bind_level(int level) const
{
    const auto bind_image = [level](const gl::Texture& texture, GLuint unit) {
        texture.bind_image(unit, std::min(level, texture.levels() - 1), GL_WRITE_ONLY);
    };
    bind_image(texels_.light, 0);
    if (texels_.coverage) bind_image(texels_.coverage, 1);
}

bool LightPyramid::run(const VoxelGrid& grid, const VoxelFaces& faces, const gl::Buffer& reflected, Revision revision,
                       const PyramidParams& params, LightPart part)
{
    if (!made_from_.differs(faces.revision(), reflected.id(), revision, part, params)) return false;
    ++revision_;
    prepare(grid, faces, params);
    gl::Defines storing{{"DIRECTIONS", std::to_string(int(params.directions))},
                         {"FORMAT", std::to_string(int(params.format))}};
    storing.merge(defines());
    constexpr GLbitfield kWrittenImage = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;
    grid.bind();
    faces.bind();
    bind();
    reflected.bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    constexpr glm::vec2 kWeights[] = {{1, 1}, {1, 0}, {0, 1}, {0, 0}};  // of what is reflected, and emitted

    // The unit that radiance is kept in.
    const glm::vec4 least(format_ == LightFormat::rgba8 ? 1e-6f : 1.0f);  // what is black is not divided by 0
    scale_.write(0, sizeof least, &least);
    const gl::Program& unit = unit_.with(storing);
    unit.set("part", kWeights[int(part)]);
    scale_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLightScaleBinding);
    unit.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);

    // Finest level: occupied voxels only, the others stay empty.
    bind_level(0);
    const gl::Program& base = base_.with(storing);
    base.set("part", kWeights[int(part)]);
    base.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.voxel_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(kWrittenImage);

    // Each level from the one below, where there is something.
    for (int level = 1; level < grid.levels(); ++level) {
        bind_level(level);
        occupied_.dispatch(next_level_.with(storing), level);
        glMemoryBarrier(kWrittenImage);
    }
    return true;
}

gl::Defines LightPyramid::defines() const
{
    gl::Defines all = texels_.defines;
    if (format_ == LightFormat::r11g11b10f) all.emplace("SPLIT_COVERAGE", "1");
    return all;
}

PyramidViewPass::PyramidViewPass(gl::Shaders& shaders)
    : program_(shaders, {"common/fullscreen.vert", "07_anisotropic_mips/pyramid_view.frag"})
{
}

const gl::Texture& PyramidViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy,
                                        const LightPyramid& pyramid, int level, const PyramidViewParams& params,
                                        bool show_coverage, const gl::Buffer& camera, glm::ivec2 size,
                                        const LightPyramid* emission)
{
    gl::fit_to_pixels(color_, framebuffer_, "pyramid view", GL_RGBA32F, size);
    grid.bind();
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    occupancy.bind(shared::kOccupancyUnit);
    pyramid.bind();
    const gl::Program& program = program_.with(pyramid.defines());
    program.set("level", std::min(level, grid.levels() - 1));
    program.set("direction", int(params.direction));
    program.set("show_coverage", show_coverage);
    program.set("with_emission", emission != nullptr);
    (emission != nullptr ? emission : &pyramid)->bind_as_emission();
    gl::draw_pixels(program, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
