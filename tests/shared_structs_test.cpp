// Structs that C++ and GLSL share: the offsets that the driver gives them against those of the C++ compiler.
#include <cstddef>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/scene_structs.glsl"
#include "common/shadow_structs.glsl"
#include "common/voxel_structs.glsl"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

// A shader that declares every struct in the kind of block in which the book uses it. Each block is read, or the
// compiler would leave it out.
constexpr const char* kProbe = R"(#version 450 core
#include "common/scene_structs.glsl"
#include "common/shadow_structs.glsl"
#include "common/voxel_structs.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 1) readonly buffer Lights { LightData lights[]; };
layout(std430, binding = 2) readonly buffer ShadowLayers { ShadowLayer shadow_layers[]; };
layout(std430, binding = 3) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
layout(std430, binding = 4) readonly buffer Faces { VoxelFace faces[]; };
layout(std430, binding = 5) buffer Counters { VoxelStatistics counters[]; };
layout(std430, binding = 6) readonly buffer Ranges { FragmentRange ranges[]; };
layout(std140, binding = 0) uniform Camera { CameraData camera; };
layout(std140, binding = 1) uniform Grid { GridData grid; };
layout(std140, binding = 3) uniform Material { MaterialData material; };
void main()
{
    counters[0].degenerate = uint(material.flags) + uint(lights[1].spot.x) + ranges[1].count +
                             uint(shadow_layers[1].clip_from_scene[0].x) + uint(shadow_lights[1].layers.x) +
                             uint(faces[1].normal.x) + uint(camera.size.x) + uint(grid.size.x);
}
)";

class SharedStructs : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        test_gl();
        folder_ = new TemporaryFolder;
        std::filesystem::create_directory_symlink(TestGl::root() + "/shaders/common", *folder_ / "common");
        std::ofstream(*folder_ / "probe.comp") << kProbe;
        shaders_ = new gl::Shaders(folder_->path());
        program_ = new gl::Program(shaders_->load({"probe.comp"}));
    }
    static void TearDownTestSuite()
    {
        delete program_;
        delete shaders_;
        delete folder_;
    }

    static GLint property(GLenum interface, const std::string& name, GLenum what)
    {
        const GLuint index = glGetProgramResourceIndex(program_->id(), interface, name.c_str());
        EXPECT_NE(index, GL_INVALID_INDEX) << name;
        GLint value = -1;
        if (index != GL_INVALID_INDEX)
            glGetProgramResourceiv(program_->id(), interface, index, 1, &what, 1, nullptr, &value);
        return value;
    }
    static void expect_member(const std::string& name, std::size_t offset)
    {
        EXPECT_EQ(property(GL_BUFFER_VARIABLE, name, GL_OFFSET), GLint(offset)) << name;
    }
    // The distance between two elements of an array of the struct.
    static void expect_stride(const std::string& member, std::size_t size)
    {
        EXPECT_EQ(property(GL_BUFFER_VARIABLE, member, GL_TOP_LEVEL_ARRAY_STRIDE), GLint(size)) << member;
    }
    static void expect_uniform(const std::string& name, std::size_t offset)
    {
        EXPECT_EQ(property(GL_UNIFORM, name, GL_OFFSET), GLint(offset)) << name;
    }
    static void expect_block(const std::string& name, std::size_t size)
    {
        EXPECT_EQ(property(GL_UNIFORM_BLOCK, name, GL_BUFFER_DATA_SIZE), GLint(size)) << name;
    }

private:
    inline static TemporaryFolder* folder_ = nullptr;
    inline static gl::Shaders* shaders_ = nullptr;
    inline static gl::Program* program_ = nullptr;
};

TEST_F(SharedStructs, MaterialData)
{
    using T = shared::MaterialData;
    expect_uniform("material.base_color", offsetof(T, base_color));
    expect_uniform("material.emission", offsetof(T, emission));
    expect_uniform("material.specular", offsetof(T, specular));
    expect_uniform("material.metallic", offsetof(T, metallic));
    expect_uniform("material.roughness", offsetof(T, roughness));
    expect_uniform("material.normal_scale", offsetof(T, normal_scale));
    expect_uniform("material.flags", offsetof(T, flags));
    expect_uniform("material.uv_row[0]", offsetof(T, uv_row));
    expect_block("Material", sizeof(T));
    EXPECT_EQ(property(GL_UNIFORM, "material.uv_row[0]", GL_ARRAY_STRIDE), GLint(sizeof(glm::vec4)));
    EXPECT_EQ(property(GL_UNIFORM, "material.uv_row[0]", GL_ARRAY_SIZE), GLint(sizeof(T::uv_row) / sizeof(glm::vec4)));
}

TEST_F(SharedStructs, LightData)
{
    using T = shared::LightData;
    expect_member("lights[0].position", offsetof(T, position));
    expect_member("lights[0].direction", offsetof(T, direction));
    expect_member("lights[0].intensity", offsetof(T, intensity));
    expect_member("lights[0].spot", offsetof(T, spot));
    expect_stride("lights[0].spot", sizeof(T));
}

TEST_F(SharedStructs, CameraData)
{
    using T = shared::CameraData;
    expect_uniform("camera.clip_from_scene", offsetof(T, clip_from_scene));
    expect_uniform("camera.scene_from_clip", offsetof(T, scene_from_clip));
    expect_uniform("camera.position", offsetof(T, position));
    expect_uniform("camera.forward", offsetof(T, forward));
    expect_uniform("camera.size", offsetof(T, size));
    expect_block("Camera", sizeof(T));
}

TEST_F(SharedStructs, ShadowLayerAndLight)
{
    expect_member("shadow_layers[0].clip_from_scene", offsetof(shared::ShadowLayer, clip_from_scene));
    expect_member("shadow_layers[0].place", offsetof(shared::ShadowLayer, place));
    expect_stride("shadow_layers[0].clip_from_scene", sizeof(shared::ShadowLayer));
    expect_member("shadow_lights[0].layers", offsetof(shared::ShadowLight, layers));
    expect_stride("shadow_lights[0].layers", sizeof(shared::ShadowLight));
}

TEST_F(SharedStructs, GridData)
{
    using T = shared::GridData;
    expect_uniform("grid.origin", offsetof(T, origin));
    expect_uniform("grid.size", offsetof(T, size));
    expect_uniform("grid.content_min", offsetof(T, content_min));
    expect_uniform("grid.content_max", offsetof(T, content_max));
    expect_block("Grid", sizeof(T));
}

TEST_F(SharedStructs, VoxelFaceAndStatistics)
{
    using T = shared::VoxelFace;
    expect_member("faces[0].albedo_area", offsetof(T, albedo_area));
    expect_member("faces[0].normal", offsetof(T, normal));
    expect_member("faces[0].emission", offsetof(T, emission));
    expect_member("faces[0].position", offsetof(T, position));
    expect_stride("faces[0].position", sizeof(T));
    using S = shared::VoxelStatistics;
    expect_member("counters[0].degenerate", offsetof(S, degenerate));
    expect_member("counters[0].large", offsetof(S, large));
    expect_member("counters[0].voxels", offsetof(S, voxels));
    expect_member("counters[0].faces", offsetof(S, faces));
    expect_stride("counters[0].faces", sizeof(S));
}

TEST_F(SharedStructs, FragmentRange)
{
    using T = shared::FragmentRange;
    expect_member("ranges[0].begin", offsetof(T, begin));
    expect_member("ranges[0].capacity", offsetof(T, capacity));
    expect_member("ranges[0].count", offsetof(T, count));
    expect_stride("ranges[0].count", sizeof(T));
}

// Compute shaders read vertices as 18 floats (shaders/04_conservative_voxelization/scene_triangles.glsl).
TEST_F(SharedStructs, VerticesAreEighteenFloats)
{
    EXPECT_EQ(sizeof(Vertex), 18 * sizeof(float));
    EXPECT_EQ(offsetof(Vertex, normal), 3 * sizeof(float));
    EXPECT_EQ(offsetof(Vertex, tangent), 6 * sizeof(float));
    EXPECT_EQ(offsetof(Vertex, uv0), 10 * sizeof(float));
    EXPECT_EQ(offsetof(Vertex, uv1), 12 * sizeof(float));
    EXPECT_EQ(offsetof(Vertex, color), 14 * sizeof(float));
}

}  // namespace
}  // namespace conebook
