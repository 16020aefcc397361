// Included after 11_emissives/emitters.glsl.

// Whether an emitter lies right above a face, within its blur: what the emitter sends there is not seen from anywhere
// else, and the voxels cannot tell the two apart.
bool hidden_by_emitter(vec3 position, vec3 normal)
{
    const float kLeast = 0.02;  // voxels: the emitter's own face
    bool hidden = false;
#if TRIANGLES
    for (int i = 0; i < emitter_triangle_count; ++i) {
        // Moller & Trumbore 1997, along the normal.
        EmitterTriangle t = emitter_triangles[i];
        vec3 ab = t.b.xyz - t.a.xyz, ac = t.c.xyz - t.a.xyz, p = cross(normal, ac), to_face = position - t.a.xyz;
        float determinant = dot(ab, p), inverse = 1.0 / (abs(determinant) > 1e-9 ? determinant : 1e-9);
        vec3 q = cross(to_face, ab);
        float u = dot(to_face, p) * inverse, v = dot(normal, q) * inverse, height = dot(ac, q) * inverse;
        hidden = hidden || u >= 0.0 && v >= 0.0 && u + v <= 1.0 && height > kLeast && height < kEmitterBlur;
    }
#else
    for (int i = aimed_part_count; i < emitter_part_count; ++i) {
        EmitterPart part = emitter_parts[i];
        vec3 to_part = part.position.xyz - position;
        float height = dot(to_part, normal);
        vec3 beside = to_part - height * normal;
        hidden = hidden || height > kLeast && height < kEmitterBlur && dot(beside, beside) < part.position.w;
    }
#endif
    return hidden;
}
