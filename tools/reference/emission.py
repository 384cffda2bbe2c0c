"""Area lights for mitsuba, which samples a textured one by uv: by the texture's own unit square.

What lies at uv beyond it, or a tiled texture, is then hardly ever found, and its light is lost. So
an even emission is a plain colour, and a mesh that tiles its emission is cut into groups of
triangles of similar radiance, each as bright as their mean: all of the light, without the pattern.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from elemental.scene.model import FloatArray, Scene, TextureSlot
from reference.bsdf import Entry, bitmap
from reference.ply import WorldMesh

GROUPS = 16
SAMPLES_A_SIDE = 8
"""Samples along a triangle's edge that its mean radiance is taken from."""


def emitting_parts(
    scene: Scene, mesh: WorldMesh, glow: FloatArray, slot: TextureSlot | None
) -> list[tuple[WorldMesh, Entry]]:
    """The mesh in parts, each with its radiance; `glow` (H, W, 3) nit, read through `slot`."""
    if glow.shape[:2] == (1, 1) or slot is None:
        return [(mesh, {"type": "rgb", "value": glow[0, 0].tolist()})]
    uv = mesh.uv @ slot.uv_from_uv[:, :2].T + slot.uv_from_uv[:, 2]
    if uv.min() >= 0.0 and uv.max() <= 1.0:
        return [(mesh, bitmap(glow, slot, scene))]
    mean = _mean_over_triangles(uv[mesh.triangles], glow)
    edges = mesh.positions[mesh.triangles[:, 1:]] - mesh.positions[mesh.triangles[:, :1]]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    parts = []
    for group in np.array_split(np.argsort(mean.sum(axis=1), kind="stable"), GROUPS):
        if area[group].sum() > 0.0:
            radiance = np.average(mean[group], axis=0, weights=area[group])
            part = replace(mesh, triangles=mesh.triangles[group])
            parts.append((part, {"type": "rgb", "value": radiance.tolist()}))
    return parts


def _mean_over_triangles(uv: FloatArray, glow: FloatArray) -> FloatArray:
    """(T, 3) mean of a repeating picture over triangles of corners uv (T, 3, 2)."""
    steps = (np.arange(SAMPLES_A_SIDE) + 1.0 / 3.0) / SAMPLES_A_SIDE
    b, c = (grid.ravel() for grid in np.meshgrid(steps, steps))
    inside = b + c < 1.0
    weights = np.stack([1.0 - b - c, b, c], axis=1)[inside]
    points = np.einsum("sk,tkc->tsc", weights, uv)
    height, width = glow.shape[:2]
    texel = np.floor(points * [width, height]).astype(np.int64) % [width, height]
    return np.asarray(glow[texel[..., 1], texel[..., 0]].mean(axis=1))
