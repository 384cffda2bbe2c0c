"""The 3x3 pattern: pixel p takes sample p mod 3 of nine, kept in sub-images. [Segovia06]"""

from __future__ import annotations

from elemental.passes.gbuffer import GBuffer

SUB_IMAGES = 9
"""CONE_COUNT of glsl/lib/cone_directions.glsl."""
GROUP = 8
"""Threads a side of a work group."""


def _sub_image_size(gb: GBuffer) -> tuple[int, int]:
    width, height = gb.depth.size[:2]
    return -(-width // 3), -(-height // 3)


def sub_images_size(gb: GBuffer) -> tuple[int, int]:
    """(width, height) of the texture that holds all nine beside each other."""
    width, height = _sub_image_size(gb)
    return 3 * width, 3 * height


def sub_image_groups(gb: GBuffer) -> tuple[int, int, int]:
    """Work groups over (x, y) of a sub-image, one layer for each of the nine."""
    width, height = _sub_image_size(gb)
    return -(-width // GROUP), -(-height // GROUP), SUB_IMAGES


def part_groups(gb: GBuffer) -> tuple[int, int, int]:
    """The same over a quarter of a sub-image, a layer for each of the nine and its four parts."""
    width, height = _sub_image_size(gb)
    return -(-width // (2 * GROUP)), -(-height // (2 * GROUP)), 4 * SUB_IMAGES
