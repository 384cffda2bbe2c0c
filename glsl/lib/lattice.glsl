// Coordinates on the octree's lattices, packed. No bindings.

#include "shared/octree.glsl"

uint pack_position(uvec3 p) { return p.x | (p.y << 10) | (p.z << 20); }
uvec3 unpack_position(uint code) { return uvec3(code, code >> 10, code >> 20) & 0x3ffu; }

// A fragment's position holds, above its coordinates, the share of a decal that its surface takes,
// in thirds.
const uint DECAL_MASK_SHIFT = 30u;
uint decal_mask_bits(float mask) {
    return uint(clamp(mask, 0.0, 1.0) * 3.0 + 0.5) << DECAL_MASK_SHIFT;
}
float decal_mask_of_position(uint code) { return float(code >> DECAL_MASK_SHIFT) / 3.0; }

uint pack_cell(uvec3 cell, int level, bool leaf) {
    return cell.x | (cell.y << 9) | (cell.z << 18) | (uint(level) << 27) | (leaf ? BRICK_LEAF : 0u);
}
uvec3 unpack_cell(uint code) { return uvec3(code, code >> 9, code >> 18) & 0x1ffu; }
int unpack_cell_level(uint code) { return int((code >> 27) & 15u); }
