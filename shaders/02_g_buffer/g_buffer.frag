#version 450 core
// What the light needs to know of the surface under each pixel, written once. No light is computed here.
#include "common/surface.glsl"
#include "common/octahedral.glsl"

// snippet: attachments
layout(location = 0) out vec2 out_normal;               // RG16_SNORM, octahedral
layout(location = 1) out vec2 out_geometric_normal;     // RG16_SNORM, octahedral
layout(location = 2) out vec4 out_base_color_metallic;  // RGBA16, linear
layout(location = 3) out vec4 out_f0_f90;               // RGBA16
layout(location = 4) out vec4 out_emission_roughness;   // RGBA32F

void main()
{
    Surface s = read_surface();
    out_normal = octahedral_encode(s.normal);
    out_geometric_normal = octahedral_encode(s.geometric_normal);
    out_base_color_metallic = vec4(s.material.base_color, s.material.metallic);
    out_f0_f90 = vec4(s.material.f0, s.material.f90);
    out_emission_roughness = vec4(s.material.emission, s.material.roughness);
}
// end snippet
