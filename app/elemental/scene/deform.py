"""Morphing and skinning on the CPU: for what never moves, for still pictures and as a model."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.evaluate import evaluate
from elemental.scene.mesh_attributes import mirrored
from elemental.scene.model import Instance, Mesh, Scene
from elemental.scene.motion import F32, F64, Influences
from elemental.scene.placement import mirrors


def deformed(mesh: Mesh, joints: npt.NDArray[Any] | None, weights: F32 | None) -> Mesh:
    """The mesh morphed by (T,) weights, then skinned by (J, 4, 4) joint matrices; None: not so.

    Skinned, its positions are in the world. Normals follow the inverse transpose. It keeps neither
    influences nor morphs. [glTF 2.0, 3.7.2.2 and 3.7.3]
    """
    positions, normals, tangents = (
        a.astype(np.float64) for a in (mesh.positions, mesh.normals, mesh.tangents[:, :3])
    )
    if mesh.morphs is not None and weights is not None:
        w, morphs = weights.astype(np.float64), mesh.morphs
        positions = positions + np.tensordot(w, morphs.positions, 1)
        normals = normals + np.tensordot(w, morphs.normals, 1)
        tangents = tangents + np.tensordot(w, morphs.tangents, 1)
    if mesh.influences is not None and joints is not None:
        blend = blended(mesh.influences, joints)
        linear = blend[:, :3, :3]
        positions = np.einsum("nij,nj->ni", linear, positions) + blend[:, :3, 3]
        normals = np.einsum("nij,nj->ni", _cofactors(linear), normals)
        tangents = np.einsum("nij,nj->ni", linear, tangents)
    return replace(
        mesh,
        positions=positions.astype(np.float32),
        normals=_unit(normals).astype(np.float32),
        tangents=np.concatenate([_unit(tangents), mesh.tangents[:, 3:]], 1).astype(np.float32),
        influences=None,
        morphs=None,
    )


def blended(influences: Influences, joints: npt.NDArray[Any]) -> F64:
    """(N, 4, 4) float64: each vertex's mean of its joints' matrices."""
    matrices = joints.astype(np.float64)[influences.joints]
    mean: F64 = np.einsum("nk,nkij->nij", influences.weights.astype(np.float64), matrices)
    return mean


def posed(scene: Scene, time_s: float) -> Scene:
    """The scene as it is at a time, as one in which nothing moves. It keeps its extent."""
    pose = evaluate(scene, time_s)
    still = replace(
        scene,
        meshes=list(scene.meshes),
        instances=[],
        lights=[replace(light, node=-1) for light in pose.lights],
        cameras=[replace(camera, node=-1) for camera in pose.cameras],
        motion=None,
        extent=scene.bounds(),
    )
    moved = {int(n): k for k, n in enumerate(pose.instances)}
    for number, instance in enumerate(scene.instances):
        k = moved.get(number)
        if k is None:
            still.instances.append(instance)
        elif pose.visible[k]:
            world = pose.world_from_local[k]
            joints, weights = pose.joints.get(number), pose.weights.get(number)
            still.instances.append(bake(still, instance, world, joints, weights))
    return still


def bake(
    scene: Scene,
    instance: Instance,
    world_from_local: F32,
    joints: npt.NDArray[Any] | None,
    weights: F32 | None,
) -> Instance:
    """The instance placed for good, with a mesh of its own in the scene where it bends."""
    index = instance.mesh
    if joints is not None or weights is not None:
        scene.meshes.append(deformed(scene.meshes[index], joints, weights))
        index = len(scene.meshes) - 1
    return Instance(instance.name, index, world_from_local)


def use_mirrored(scene: Scene, instance: Instance) -> None:
    """Give the instance its mesh's mirrored version, one for all that share the mesh."""
    plain = scene.meshes[instance.mesh]
    name = mirrored(plain).name
    found = next((n for n, m in enumerate(scene.meshes)
                  if m.name == name and m.positions is plain.positions), None)  # fmt: skip
    if found is None:
        scene.meshes.append(mirrored(plain))
        found = len(scene.meshes) - 1
    instance.mesh = found


def turns_over(joints: npt.NDArray[Any]) -> bool:
    """Whether joint matrices (J, 4, 4) mirror the mesh that they hold, by the most of them."""
    return bool(np.mean(mirrors(joints)) > 0.5)


def _cofactors(m: F64) -> F64:
    """(N, 3, 3) inverse transposes of (N, 3, 3), but for a positive factor, singular or not."""
    x, y, z = m[:, 0], m[:, 1], m[:, 2]
    rows = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=1)
    sign = np.where(np.einsum("ni,ni->n", x, rows[:, 0]) < 0.0, -1.0, 1.0)
    cofactors: F64 = rows * sign[:, None, None]
    return cofactors


def _unit(vectors: F64) -> F64:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: F64 = vectors / np.where(length > 0.0, length, 1.0)
    return unit
