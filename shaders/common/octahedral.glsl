// Unit vectors as two numbers in -1..1: the octahedron |x|+|y|+|z| = 1, folded open (Cigolle et al. 2014, "A Survey
// of Efficient Representations for Independent Unit Vectors", listing 2).

vec2 octahedral_fold(vec2 p)
{
    vec2 sign_not_zero = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return (1.0 - abs(p.yx)) * sign_not_zero;
}

// snippet: octahedral
vec2 octahedral_encode(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z < 0.0 ? octahedral_fold(p) : p;
}

vec3 octahedral_decode(vec2 p)
{
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = octahedral_fold(n.xy);
    return normalize(n);
}
// end snippet
