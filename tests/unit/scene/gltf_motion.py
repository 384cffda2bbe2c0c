"""Small glTF files that move, and where their parts are at a time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from elemental.core import transforms
from elemental.scene.deform import posed
from elemental.scene.evaluate import evaluate
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
UP = np.tile(np.array([0, 0, 1], np.float32), (3, 1))
HALF = math.sqrt(0.5)
QUARTER_Z = [0.0, 0.0, HALF, HALF]
TWO = [0.0, 2.0]
ALONG_X = [[0, 0, 0], [4, 0, 0]]
BENT = [[0, 0, 0], [1, 0, 0], [-1, 1, 0], [-1, 2, 0]]


def places(scene: Scene, time_s: float) -> list[list[float]]:
    """Where the dynamic instances are, rounded."""
    pose = evaluate(scene, time_s)
    return np.round(pose.world_from_local[:, :3, 3].astype(float), 5).tolist()


def corners(scene: Scene, time_s: float, instance: int = 0) -> np.ndarray[Any, Any]:
    """World positions of a mesh's corners at a time."""
    still = posed(scene, time_s)
    placed = still.instances[instance]
    shape = still.meshes[placed.mesh]
    return transforms.transform_points(placed.world_from_local, shape.positions[shape.indices])


def moved_triangle() -> GltfBuilder:
    builder = GltfBuilder()
    builder.add(TRIANGLE, name="still")
    node = builder.add(TRIANGLE, name="mover", translation=[0, 7, 0])
    builder.animation((node, "translation", TWO, ALONG_X), name="slide")
    return builder


def bent_strip(animated: bool = True) -> GltfBuilder:
    """A strip along y of which the upper end hangs on a joint at y = 1 that turns to -x."""
    builder = GltfBuilder()
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 0]], np.float32)
    indices = np.array([0, 1, 2, 2, 1, 3], np.uint16)
    primitive = builder.primitive(positions, indices, normals=np.tile(UP[:1], (4, 1)))
    joints = np.zeros((4, 4), np.uint8)
    joints[2:, 0] = 1
    builder.skinned(primitive, joints, np.tile([2.0, 0, 0, 0], (4, 1)))
    upper = builder.node(root=False, translation=[0, 1, 0])
    lower = builder.node(children=[upper])
    down = np.eye(4)
    down[1, 3] = -1
    skin = builder.skin([lower, upper], np.array([np.eye(4), down]))
    builder.node(mesh=builder.mesh(primitive), skin=skin, name="strip", translation=[50, 0, 0])
    if animated:
        builder.animation((upper, "rotation", TWO, [[0, 0, 0, 1], QUARTER_Z]))
    else:
        builder.root["nodes"][upper]["rotation"] = QUARTER_Z
    return builder


def morphing(animated: bool = True) -> GltfBuilder:
    builder = GltfBuilder()
    primitive = builder.primitive(TRIANGLE, normals=UP)
    lift, stretch = np.zeros((2, 3, 3))
    lift[:, 2] = 1
    stretch[1, 0] = 2
    builder.morphed(primitive, {"positions": lift}, {"positions": stretch})
    mesh = builder.mesh(primitive, weights=[0.5, 0.0])
    node = builder.node(mesh=mesh, translation=[0, 10, 0])
    if animated:
        builder.animation((node, "weights", TWO, [0.0, 0.0, 1.0, 3.0]))
    return builder
