"""Skinned and morphed meshes on the device against numpy and against still ones. GI-06"""

from __future__ import annotations

from typing import Any

import numpy as np

from elemental.gpu.device import Device
from elemental.passes.scene_pack import SURFACE_VERTEX
from elemental.scene.deform import deformed, posed
from elemental.scene.evaluate import evaluate
from gpu.moving import (
    bending_stage,
    picture,
)
from gpu.rig import sun, vector


def test_bent_meshes_are_numpy_s_to_rounding(device: Device, on_device: Any) -> None:
    world = bending_stage()
    gpu = on_device(world)
    for t in (0.3, 1.6):
        pose = evaluate(world, t)
        gpu.update(pose)
        g = device.begin_frame()
        gpu.deform(g)
        g.execute()
        positions = gpu.geometry.positions.read(np.float32).reshape(-1, 3)
        surface = gpu.geometry.surface.read(SURFACE_VERTEX)
        for number in (1, 2, 3, 4):
            shape = world.meshes[world.instances[number].mesh]
            want = deformed(shape, pose.joints.get(number), pose.weights.get(number))
            first = int(gpu.geometry.packed.placed_vertex[number])
            rows = slice(first, first + len(shape.positions))
            np.testing.assert_allclose(positions[rows], want.positions, atol=2e-6)
            np.testing.assert_allclose(surface["a_normal"][rows], want.normals, atol=5e-6)
            np.testing.assert_allclose(surface["a_tangent"][rows], want.tangents, atol=5e-6)
            np.testing.assert_array_equal(surface["a_uv0"][rows], shape.uv0)
            np.testing.assert_array_equal(surface["a_color"][rows], shape.colors)
        at_rest = gpu.geometry.packed.first_vertex[world.instances[1].mesh]
        shape = world.meshes[world.instances[1].mesh]
        np.testing.assert_array_equal(
            positions[at_rest : at_rest + len(shape.positions)], shape.positions
        )


def test_bent_meshes_look_like_still_ones(renderers: Any) -> None:
    world = bending_stage()
    world.lights = [sun(vector(0.3, -1, -0.4), 3.0)]
    moving = renderers(world)
    picture(moving, 0.0)
    shown = picture(moving, 1.3)
    fresh = picture(renderers(world), 1.3)  # with no past: its bricks stand elsewhere
    np.testing.assert_allclose(shown, fresh, rtol=2.0**-9, atol=1e-4)
    assert (shown != fresh).mean() < 0.01
    still = picture(renderers(posed(world, 1.3)), 0.0)
    differ = np.abs(shown - still)[..., :3].max(axis=2) > 0.02
    assert differ.mean() < 0.01  # rounding moves edges and voxels
    assert np.abs(picture(moving, 0.0) - shown).max() > 0.2
