// A cone through the octree: it descends to the nodes whose samples are as far apart as it is wide, samples their
// bricks step by step, and passes what the tree does not have in one step.
#define OWN_TRACE_CONE
#include "17_sparse_voxel_octree/tree_light.glsl"
#include "08_diffuse_cones/walk.glsl"

uniform float step_factor;  // step over the spacing of the samples

// What chapter 08 asks of the voxel in which a cone starts: how much of a sheet it holds, that is, of a surface that
// looks the other way. Blurred, a sheet in this voxel has 1/2 in its middle, one in the next voxel behind has 1/4
// there.
float coverage_at(int face, vec3 voxel_middle, int level)
{
    TreeCell cell = descend(voxel_middle, tree_depth - 1);
    return cell.node == kNoNode ? 0.0 : min(2.0 * sample_brick(cell, face, voxel_middle).a, 1.0);
}
#include "08_diffuse_cones/cone_common.glsl"

// The levels for a cone `width` voxels wide: the deepest one whose samples are at least as far apart, and the next
// deeper one, of which `finer` is blended in.
struct ConeLevels {
    int coarse;
    float finer;
};
ConeLevels levels_of(float width)
{
    float lod = min(log2(max(width, 1.0)), float(tree_depth - 1));
    float spacing = ceil(lod);
    return ConeLevels(tree_depth - 1 - int(spacing), spacing - lod);
}

// One step: what it meets, and how far it goes. The light is premultiplied; rgb in units of light_scale.
struct ConeStep {
    vec4 met;
    float middle, end;
};

ConeStep cone_step(TreeRay ray, RayStart start, float own_end, float tan_half, float t, float limit)
{
    float width = 2.0 * t * tan_half;
    bool in_own_blur = t < own_end;
    ConeLevels levels = levels_of(in_own_blur ? 1.0 : width);
    TreeCell cell = descend(ray.nudge + ray.direction * t, levels.coarse);
    ConeStep s;
    s.met = vec4(0.0);
    s.end = max(leaves_cell(ray, cell), t + 1e-3);
    s.middle = t;
    if (cell.node == kNoNode) return s;  // exactly empty
    float stride = step_factor * max(width, 1.0);
    s.end = min(min(s.end, t + stride), max(limit, t + 1e-3));
    s.middle = 0.5 * (t + s.end);
    vec3 position = ray.origin + ray.direction * s.middle;
    AgainstRay light = light_against(cell, position, ray.faces);
    float spacing = 0.5 * cell.side;
    if (in_own_blur) {
        // The surface that the cone leaves shows it nothing: chapter 08.
        vec3 met = vec3(light.x.a, light.y.a, light.z.a);
        ivec3 behind = ray.faces ^ 1;
        vec3 leaving = vec3(sample_brick(cell, behind.x, position).a, sample_brick(cell, behind.y, position).a,
                            sample_brick(cell, behind.z, position).a);
        vec3 kept = coverage_above(ray.direction, met, leaving, 1.0 / 2048.0, start, s.middle) / max(met, vec3(1e-6));
        light.x *= kept.x;
        light.y *= kept.y;
        light.z *= kept.z;
    }
    s.met = met_by_ray(light, ray.direction, spacing) * (1.0 - levels.finer);
    if (levels.finer > 0.0) {
        TreeCell child = child_cell(cell, position);
        if (child.node != kNoNode)
            s.met += met_by_ray(light_against(child, position, ray.faces), ray.direction, 0.5 * spacing) * levels.finer;
    }
    s.met *= s.end - t;
    return s;
}

// What of a surface at the root's side lies beyond it: half of the outermost sample.
vec4 beyond_root(TreeRay ray, float tan_half)
{
    ConeLevels levels = levels_of(2.0 * ray.exit * tan_half);
    vec3 position = ray.origin + ray.direction * ray.exit;
    TreeCell cell = descend(position - 1e-3 * sign(ray.direction), levels.coarse);
    if (cell.node == kNoNode) return vec4(0.0);
    vec3 side = abs(position - step(0.0, ray.direction) * float(1 << tree_depth));
    int axis = side.x <= side.y && side.x <= side.z ? 0 : side.y <= side.z ? 1 : 2;
    return 0.5 * sample_brick(cell, ray.faces[axis], position);
}

// Coverages add up until nothing is left open: what the filter has blurred over several samples is one surface
// (Vicini et al. 2021, section 4). `threshold` is chapter 08's, of which this cone has no use: it ends in parts.
// snippet: trace_cone
ConeLight trace_cone(RayStart start, vec3 direction, float tan_half, float threshold)
{
    TreeRay ray = tree_ray(start.position, direction);
    float own_end = own_blur_end(start, direction), t = 0.0, open = 1.0, occlusion = 0.0;
    vec3 radiance = vec3(0.0);
    while (t < ray.exit && open > 0.0) {
        ConeStep s = cone_step(ray, start, own_end, tan_half, t, ray.exit);
        float stopped = min(s.met.a, open);
        if (open - stopped < 1.0 - kStopped) stopped = open;  // an error of the steps, no gap
        radiance += s.met.rgb * (stopped / max(s.met.a, 1e-6));
        occlusion += stopped * occlusion_at(s.middle);
        open -= stopped;
        t = s.end;
    }
    // end snippet
    if (open > 0.0) {
        vec4 met = beyond_root(ray, tan_half);
        float stopped = min(met.a, open);
        if (open - stopped < 1.0 - kStopped) stopped = open;
        radiance += met.rgb * (stopped / max(met.a, 1e-6));
        occlusion += stopped * occlusion_at(ray.exit);
        open -= stopped;
    }
    return ConeLight(light_scale * radiance + open * sky_radiance, occlusion);
}
