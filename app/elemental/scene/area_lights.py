"""Emissive parallelograms and balls, whose light is known in closed form.

Other emitters shine as voxels.

[Mittring12 "Voxel Lighting": shadowed area lights from emissive materials]
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from elemental.scene.evaluate import Pose
from elemental.scene.model import FloatArray, Mesh, Scene

FACES_A_MESH_MAX = 9
FACES_MAX = 16
"""AREA_LIGHTS_MAX of glsl/shared/area_light.glsl."""
LEAST_SHARE = 0.01
"""Of the scene's flux: what makes less is left to the voxels, where it costs nothing more."""
LEAST_SHARE_MOVING = 0.001
"""Of what can move: as voxels its light would go in steps of the lattice."""
ROUNDNESS = 0.02
"""How far vertices of a ball may be off their mean distance, of it; its scales, off each other."""
LEAST_BALL = 0.85
"""Of a ball's volume, that a mesh with its vertices fills at least: one of 80 faces does."""
DOME = 0.25
"""Radius by the scene's diagonal from which on a ball that shines inwards too is taken for a dome
[inferred: one around the scene has 0.29 at least, and is a part of it]."""
FLATNESS = 1e-3
"""How far a corner may be off the parallelogram's, by the length of its diagonal."""


@dataclass(frozen=True)
class AreaLight:
    """A face, or a ball, that emits the same radiance everywhere and in all directions before it.

    corner, edge_u, edge_v (3,) float32 m, world space: points are corner + s edge_u + t edge_v with
    s, t in 0..1, and cross(edge_u, edge_v) points to its front; of a ball the corner is the centre,
    edge_u a radius, and edge_v that of a ball around all of its vertices. radiance (3,) float32
    nit; `instance` is the index of what it belongs to in Scene.instances; `face` (3, 3) float64 are
    corner and edges in that instance's own space.
    """

    instance: int
    corner: FloatArray
    edge_u: FloatArray
    edge_v: FloatArray
    radiance: FloatArray
    both_sides: bool
    is_ball: bool = False
    face: npt.NDArray[np.float64] = field(default_factory=lambda: np.eye(3), repr=False)

    @property
    def ball_radius(self) -> float:
        """m; 0 where it is a parallelogram."""
        return float(np.linalg.norm(self.edge_u)) if self.is_ball else 0.0

    @property
    def outer_radius(self) -> float:
        """m: how far from its centre a ball's vertices reach; 0 where it is a parallelogram."""
        return float(np.linalg.norm(self.edge_v)) if self.is_ball else 0.0

    @property
    def flux(self) -> float:
        """Emitted by the front, summed over the three channels, W."""
        if self.is_ball:
            return float(4.0 * math.pi**2 * self.ball_radius**2 * self.radiance.sum())
        area = np.linalg.norm(np.cross(self.edge_u.astype(float), self.edge_v.astype(float)))
        return float(math.pi * area * self.radiance.sum())


def area_lights(scene: Scene) -> list[AreaLight]:
    """The faces of all instances that emit evenly and are balls or made of few parallelograms.

    Of an instance all faces or none; the strongest first, at most FACES_MAX.
    """
    faces_of = {
        number: found
        for number, mesh in enumerate(scene.meshes)
        if _emits_evenly(scene, mesh) and (found := _shape(mesh)) is not None
    }
    outside = _flux_from_outside(scene)
    lamps = []
    for number, instance in enumerate(scene.instances):
        if instance.mesh not in faces_of or instance.skin >= 0 or instance.weights is not None:
            continue
        faces, is_ball = faces_of[instance.mesh]
        lamp = [_placed(scene, number, face, is_ball, instance.world_from_local) for face in faces]
        if is_ball and not (
            _keeps_round(instance.world_from_local) and _seen_from_outside(lamp[0], scene)
        ):
            continue
        flux = sum(face.flux for face in lamp)
        least = LEAST_SHARE_MOVING if instance.dynamic else LEAST_SHARE
        if flux > least * outside:
            lamps.append((flux, lamp))
    lamps.sort(key=lambda entry: -entry[0])
    chosen: list[AreaLight] = []
    for _, lamp in lamps:
        if len(chosen) + len(lamp) <= FACES_MAX:
            chosen += lamp
    return chosen


def followed(scene: Scene, lights: list[AreaLight], pose: Pose) -> list[AreaLight]:
    """`area_lights` where a pose has their instances; those of hidden ones are dark."""
    row = {int(number): k for k, number in enumerate(pose.instances)}
    moved = []
    for light in lights:
        k = row.get(light.instance)
        if k is None:
            moved.append(light)
        elif pose.visible[k]:
            world = pose.world_from_local[k]
            moved.append(_placed(scene, light.instance, light.face, light.is_ball, world))
        else:
            moved.append(replace(light, radiance=np.zeros(3, np.float32)))
    return moved


def parallelograms(mesh: Mesh) -> npt.NDArray[np.float64] | None:
    """(F, 3, 3) corner, edge_u, edge_v of each of the mesh's faces, in its own space.

    None where the triangles don't pair up into at most FACES_A_MESH_MAX parallelograms.
    """
    triangles = mesh.positions[mesh.indices.reshape(-1, 3)].astype(np.float64)
    if len(triangles) % 2 or not 2 <= len(triangles) <= 2 * FACES_A_MESH_MAX:
        return None
    left = list(triangles)
    faces = []
    while left:
        first = left.pop(0)
        found = next(
            ((k, f) for k, other in enumerate(left) if (f := _join(first, other)) is not None), None
        )
        if found is None:
            return None
        left.pop(found[0])
        faces.append(found[1])
    return np.array(faces)


def ball(mesh: Mesh) -> npt.NDArray[np.float64] | None:
    """(1, 3, 3) centre, radius of a ball of the mesh's area and of one around its vertices, both
    along x, in its own space.

    None where the triangles do not enclose one whose front is outside.
    """
    triangles = mesh.positions[mesh.indices.reshape(-1, 3)].astype(np.float64)
    if len(triangles) < 8:
        return None
    centre = 0.5 * (triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1)))
    a, b, c = np.moveaxis(triangles - centre, 1, 0)
    distances = np.linalg.norm(triangles - centre, axis=2)
    mean = float(distances.mean())
    volume = float((a * np.cross(b, c)).sum()) / 6.0
    if mean <= 0.0 or np.ptp(distances) > ROUNDNESS * mean:
        return None
    if volume < LEAST_BALL * 4.0 / 3.0 * math.pi * mean**3:
        return None
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    radius = math.sqrt(area / (4.0 * math.pi))
    return np.array([[centre, (radius, 0.0, 0.0), (float(distances.max()), 0.0, 0.0)]])


def _shape(mesh: Mesh) -> tuple[npt.NDArray[np.float64], bool] | None:
    """The mesh's parallelograms, or the ball that it is, (F, 3, 3) in its own space, and which."""
    faces = parallelograms(mesh)
    if faces is not None:
        return faces, False
    faces = ball(mesh)
    return None if faces is None else (faces, True)


def _keeps_round(world_from_local: FloatArray) -> bool:
    scales = np.linalg.svd(world_from_local[:3, :3].astype(np.float64), compute_uv=False)
    return bool(scales[0] - scales[2] <= ROUNDNESS * scales[0])


def _seen_from_outside(light: AreaLight, scene: Scene) -> bool:
    """Whether a ball is no dome around the scene, whose inside shines."""
    low, high = scene.bounds()
    return not light.both_sides or light.ball_radius < DOME * float(np.linalg.norm(high - low))


def _join(a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]) -> FloatArray | None:
    """(3, 3) corner and edges where two triangles (3, 3) are the halves of a parallelogram."""
    for turn in range(3):
        apex, second, third = np.roll(a, -turn, axis=0)  # b lies behind the edge second-third
        opposite = second + third - apex
        tolerance = FLATNESS * float(np.linalg.norm(third - second))
        wanted = np.array([opposite, third, second])
        if any(np.abs(np.roll(b, -k, axis=0) - wanted).max() <= tolerance for k in range(3)):
            return np.array([apex, second - apex, third - apex])
    return None


def _emits_evenly(scene: Scene, mesh: Mesh) -> bool:
    material = scene.materials[mesh.material]
    plain = material.emissive_texture is None and material.alpha_mode == "opaque"
    return plain and material.emits and material.is_standard


def _placed(
    scene: Scene,
    number: int,
    face: npt.NDArray[np.float64],
    is_ball: bool,
    world_from_local: FloatArray,
) -> AreaLight:
    material = scene.materials[scene.meshes[scene.instances[number].mesh].material]
    matrix = world_from_local.astype(np.float64)
    linear = matrix[:3, :3]
    corner = linear @ face[0] + matrix[:3, 3]
    edges = face[1:] @ linear.T
    if is_ball:
        edges[1] = face[2] * np.linalg.norm(linear, 2)  # however it is scaled
    return AreaLight(
        instance=number,
        corner=corner.astype(np.float32),
        edge_u=edges[0].astype(np.float32),
        edge_v=edges[1].astype(np.float32),
        radiance=material.emissive.astype(np.float32),
        both_sides=material.double_sided,
        is_ball=is_ball,
        face=face,
    )


def _flux_from_outside(scene: Scene) -> float:
    """What suns, sky and punctual lights send into the scene, W over three channels, roughly."""
    low, high = scene.bounds()
    radius = 0.5 * float(np.linalg.norm(high.astype(np.float64) - low))
    disc = math.pi * radius**2
    total = 0.0
    for light in scene.lights:
        reach = disc if light.kind == "directional" else 4.0 * math.pi
        total += float(light.strength.sum()) * reach
    sky = scene.environment
    if sky is not None:
        mean = np.ones(3) if sky.radiance is None else sky.radiance.mean(axis=(0, 1))
        total += float((mean * sky.tint).sum()) * sky.intensity * math.pi * disc
    return total
