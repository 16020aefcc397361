// Six directional pyramids of the light in the voxels, filtered from the finest level up.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "06_voxel_shading/voxel_shading.hpp"

namespace conebook {

// per_face: six directions from the finest level on. For comparison, anisotropic: the six of the finest level hold
// the same, so that a wall covers along itself too (Crassin 2011); isotropic: those of all levels do, each the mean of
// eight.
enum class Directions : int { per_face = 0, anisotropic = 1, isotropic = 2 };

// rgba16f: 8 bytes a texel; radiance beyond half floats is kept in units of a power of two. rgba8: 4, radiance as a share
// of the largest that any face sends, so that nothing is cut off and what is darker than 1/510 of it is lost.
// r11g11b10f: 5, 6 or 5 bits of precision for radiance, 8 for coverage.
enum class LightFormat : int { rgba16f = 0, rgba8 = 1, r11g11b10f = 2 };

// dense: a texel for every voxel; bricks: for the voxels that hold something (chapter 16).
enum class VoxelStorage : int { dense = 0, bricks = 1 };

// What of the light that leaves the faces a pyramid holds; their coverage it always does.
enum class LightPart { all, reflected, emitted, none };

struct PyramidParams {
    Directions directions = Directions::per_face;
    LightFormat format = LightFormat::rgba16f;
    VoxelStorage storage = VoxelStorage::dense;
    bool operator==(const PyramidParams&) const = default;
};
void add_parameters(ParameterTable& table, PyramidParams& params);

// The voxels of each level that hold something, so that time follows them and not the number of all voxels.
class OccupiedLevels {
public:
    explicit OccupiedLevels(gl::Shaders& shaders);
    void run(const VoxelGrid& grid, const VoxelFaces& faces);
    // For shaders that include occupied_levels.glsl: storage 12 and 13, uniforms level and begin; then one work item for
    // each voxel of the level >= 1.
    void dispatch(const gl::Program& program, int level) const { dispatch(program, level, level); }
    const gl::Buffer& lists() const { return lists_; }

private:
    // Uniforms of `level`, one work item for each occupied voxel of `items_of`.
    void dispatch(const gl::Program& program, int level, int items_of) const;
    gl::Program parents_;
    gl::Buffer lists_, levels_;
    std::vector<GLuint> begin_;  // of each level's part of the lists
};

// Where a pyramid's texels lie.
struct LightTexels {
    gl::Texture light, coverage;  // coverage: of format r11g11b10f alone, r8
    gl::Defines defines;          // LIGHT_STORAGE: the file by which shaders find them, instead of light_atlas.glsl
    std::vector<std::pair<GLuint, const gl::Texture*>> index;  // what else it reads, by texture unit; not owned
};

// Makes room for all texels of the occupied voxels, empty, in what `texels` has already where that fits.
using LightStorage = std::function<void(LightTexels& texels, const VoxelGrid& grid, const VoxelFaces& faces,
                                        const OccupiedLevels& occupied, const PyramidParams& params)>;

// An atlas: six times the grid's width (face * size.x + x), all levels of the grid, occupied or not.
void fit_light_atlas(LightTexels& texels, const VoxelGrid& grid, LightFormat format);
// What a texture of that format is made with.
GLenum texel_format(LightFormat format);

class LightPyramid {
public:
    // `storage`: for params.storage > 0.
    explicit LightPyramid(gl::Shaders& shaders, LightStorage storage = {});

    // All levels from what the faces reflect (vec4 a face: rgb in W/(sr m^2), of that revision) and emit, `part` of it; if
    // any of that has changed. Says whether it has.
    bool run(const VoxelGrid& grid, const VoxelFaces& faces, const gl::Buffer& reflected, Revision revision,
             const PyramidParams& params, LightPart part = LightPart::all);
    Revision revision() const { return revision_; }

    // kLightAtlasUnit, kCoverageAtlasUnit and uniform block 4, for shaders that include 07_anisotropic_mips/pyramid.glsl.
    void bind() const;
    // kEmissionAtlasUnit and uniform block 5, beside another one that is bound as above; format rgba16f.
    void bind_as_emission() const;
    LightFormat format() const { return format_; }  // of the last run
    // For programs that include 07_anisotropic_mips/pyramid.glsl.
    gl::Defines defines() const;
    const gl::Texture& light() const { return texels_.light; }
    const gl::Texture& coverage() const { return texels_.coverage; }
    std::vector<gl::Resource> resources() const
    {
        return {texels_.light.resource(), texels_.coverage.resource(), occupied_.lists().resource()};
    }

private:
    // When other voxels become occupied, or texels are to be others: empties all levels and lists what they will hold.
    void prepare(const VoxelGrid& grid, const VoxelFaces& faces, const PyramidParams& params);
    void bind_level(int level) const;
    LightStorage storage_;
    MadeFrom<Revision, PyramidParams> prepared_for_;  // faces
    // Faces, what they reflect: which buffer, for each counts its own revisions.
    MadeFrom<Revision, GLuint, Revision, LightPart, PyramidParams> made_from_;
    Revision revision_ = 0;
    LightFormat format_ = LightFormat::rgba16f;
    gl::ProgramVariants unit_, base_, next_level_;
    OccupiedLevels occupied_;
    LightTexels texels_;
    gl::Buffer scale_;
};

// Whose light a view shows: what left towards one side, or towards the camera.
enum class PyramidSide : int { minus_x, plus_x, minus_y, plus_y, minus_z, plus_z, seen };

struct PyramidViewParams {
    PyramidSide direction = PyramidSide::seen;
};
void add_parameters(ParameterTable& table, PyramidViewParams& params);

class PyramidViewPass {
public:
    explicit PyramidViewPass(gl::Shaders& shaders);
    // RGBA32F, alpha 0 where no voxel is met. `show_coverage`: A as grey instead of radiance. `emission` is added.
    const gl::Texture& run(const VoxelGrid& grid, const gl::Texture& occupancy, const LightPyramid& pyramid, int level,
                           const PyramidViewParams& params, bool show_coverage, const gl::Buffer& camera,
                           glm::ivec2 size, const LightPyramid* emission = nullptr);

private:
    gl::ProgramVariants program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
