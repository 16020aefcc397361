// Where the faces of a voxel are in the list of faces: first << 6 | mask.
uint face_mask(uint entry) { return entry & 63u; }
uint face_place(uint entry, int face)
{
    return (entry >> 6) + uint(bitCount(entry & ((1u << face) - 1u)));
}
