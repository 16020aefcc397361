#version 450 core
// Where the light of every face comes from: its rays are walked once, and each keeps the face that it ends on. One
// thread a face. What emitters send to the face does not depend on the light either, so it is gathered here too.
// EMITTERS 0: no surface shines; 1: emission is apart; 2: rays meet it as they meet what is reflected.
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "05_atomic_averaging/face_index.glsl"
#include "12_second_bounce/links.glsl"
#include "08_diffuse_cones/gather.glsl"
#if EMITTERS == 1
#include "11_emissives/emitters.glsl"
#include "12_second_bounce/hidden_by_emitter.glsl"
#endif

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kLinkBinding) buffer LinkBuffer { uint links[]; };
#if EMITTERS
layout(std430, binding = kFromEmittersBinding) writeonly buffer EmittedBuffer { vec4 from_emitters[]; };  // E / pi
#endif
layout(std430, binding = kAlbedoBinding) writeonly buffer AlbedoBuffer { uint albedo[]; };

// A number in 0..1 that looks random (PCG: Jarzynski & Olano 2020).
float hashed(uint seed)
{
    uint state = seed * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float((word >> 22u ^ word) >> 8) / 16777216.0;
}

// One of the faces round `position`, each with a probability in proportion to what it shows to the ray: its area times
// -n.d, by the trilinear weight of its voxel. `u`: uniform in 0..1.
uint face_met(vec3 position, vec3 direction, float u)
{
    vec3 low = floor(grid.content_min.xyz) + 0.5, high = ceil(grid.content_max.xyz) - 0.5;
    vec3 p = clamp(position, low, high) - 0.5, first = floor(p), part = p - first;
    // snippet: face_met
    uint chosen = kNoLink;
    float total = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2), voxel = ivec3(first) + corner;
        vec3 near = mix(1.0 - part, part, vec3(corner));
        uint entry = texelFetch(face_index, min(voxel, grid.size.xyz - 1), 0).r;
        for (uint k = 0u; k < uint(bitCount(face_mask(entry))); ++k) {
            uint place = (entry >> 6) + k;
            float shown = faces[place].albedo_area.a * max(-dot(faces[place].normal.xyz, direction), 0.0);
            float weight = near.x * near.y * near.z * shown;
            // Reservoir of one (Vitter 1985), with one random number for all.
            total += weight;
            float share = total > 0.0 ? weight / total : 0.0;
            bool taken = u < share;
            chosen = taken ? place : chosen;
            u = taken ? u / share : (u - share) / max(1.0 - share, 1e-6);
        }
    }
    // end snippet
    return chosen;
}

#if SOME
uniform uint kept_faces;                    // the places of the faces before it are what they were
uniform vec3 changed_low, changed_high;  // grid space: outside nothing has changed

// What rays see of a voxel is half a voxel around it in the walk volume and another one in what its cells are means
// of; where they end they look at the eight voxels around, and one more for rounding.
const float kReach = 3.0;

// Whether the way from `origin` to distance `length` comes by what has changed.
bool comes_by(vec3 origin, vec3 direction, float length)
{
    vec3 d = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 a = (changed_low - kReach - origin) / d, b = (changed_high + kReach - origin) / d;
    vec3 enter = min(a, b), leave = max(a, b);
    float first = max(max(enter.x, enter.y), max(enter.z, 0.0));
    float last = min(min(leave.x, leave.y), min(leave.z, length));
    return first <= last;
}

// Whether any link of the face may be another one now.
bool is_outdated(uint place, RayStart start, mat3 frame, int set)
{
    // snippet: outdated
    if (place >= kept_faces) return true;
    bool outdated = comes_by(start.position, start.normal, 0.0);
    for (int i = 0; i < cone_count && !outdated; ++i) {
        uint link = links[place * uint(cone_count) + uint(i)];
        vec3 direction = frame * cones[set * cone_count + i].xyz;
        float length = exit_distance(start.position, direction, 1.0);
        if (link < kept_faces) {
            vec3 end = vec3(unpack_voxel(face_list[link])) + 0.5;
            length = min(length, distance(end, start.position) + kReach);
        }
        outdated = link >= kept_faces && link < kSkyLink || comes_by(start.position, direction, length);
    }
    // end snippet
    return outdated;
}
#endif

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    VoxelFace face = faces[place];
    vec3 normal = face.normal.xyz, position = face.position.xyz;
    // In every 8 x 8 voxels of a wall each of the 64 sets of rays comes once.
    ivec3 voxel = unpack_voxel(face_list[place]) & 7;
    int axis = int(face_list[place] >> 27) >> 1, set = voxel[(axis + 1) % 3] + 8 * voxel[(axis + 2) % 3];
    RayStart start = start_above(position, normal, start_offset);
    mat3 frame = frame_around(normal);
#if SOME
    if (!is_outdated(place, start, frame, set)) return;
#endif
    vec3 emitted = vec3(0.0);
    // snippet: links
    for (int i = 0; i < cone_count; ++i) {
        int ray = set * cone_count + i;
        vec3 direction = frame * cones[ray].xyz;
        WalkEnd end = walk(start, direction, threshold_of(ray));
        uint link = kSkyLink;
        float random = hashed(face_list[place] * uint(cone_count) + uint(i));
        if (end.stopped) link = face_met(start.position + direction * end.t, direction, random);
        links[place * uint(cone_count) + uint(i)] = link;
#if EMITTERS == 2
        if (link < kSkyLink) emitted += cones[ray].w * faces[link].emission.rgb;
#endif
    }
    // end snippet
#if EMITTERS == 1
    if (!hidden_by_emitter(position, normal)) {
        EmitterSamples samples = sample_emitters(start, position, normal, normal, set);
        emitted = unshadowed_light(position, normal) * arriving_share(samples.arriving, samples.unshadowed);
    }
#endif
#if EMITTERS
    from_emitters[place] = vec4(emitted, 0.0);
#endif
    albedo[place] = pack_albedo(face.albedo_area.rgb);
}
