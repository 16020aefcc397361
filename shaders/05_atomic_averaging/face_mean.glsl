// A face's sums to means. Included after common/voxel_grid.glsl.
layout(std430, binding = kSumBinding) readonly buffer SumBuffer { uint sums[]; };

float sum_of(uint place, int sum)
{
    uint word = place * uint(2 * kSumCount) + uint(sum);
    return (float(sums[word + uint(kSumCount)]) * 4294967296.0 + float(sums[word])) / kFixedPointOne;
}

vec3 mean_of(uint place, int sum, float area)
{
    return vec3(sum_of(place, sum), sum_of(place, sum + 1), sum_of(place, sum + 2)) / area;
}

// `entry`: packed voxel | face << 27.
VoxelFace face_mean(uint place, uint entry)
{
    vec3 corner = vec3(unpack_voxel(entry));
    float area = sum_of(place, kSumArea);
    VoxelFace face = VoxelFace(vec4(0.0), vec4(face_normal(int(entry >> 27)), 0.0), vec4(0.0), vec4(corner + 0.5, 0.0));
    if (area > 0.0) {
        vec3 normal = mean_of(place, kSumNormal, area) - 1.0;
        face.albedo_area = vec4(clamp(mean_of(place, kSumAlbedo, area), 0.0, 1.0), area);
        // Opposite normals may cancel: then the face's own direction stands for them.
        if (dot(normal, normal) > 1e-6) face.normal.xyz = normalize(normal);
        face.emission.rgb = mean_of(place, kSumEmission, area);
        face.position.xyz = corner + clamp(mean_of(place, kSumPosition, area), 0.0, 1.0);
    }
    return face;
}
