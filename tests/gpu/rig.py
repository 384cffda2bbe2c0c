"""Scenes of a few meshes built in code, and the passes of a frame run on them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import TextureHandle
from elemental.passes.camera_view import pack_view
from elemental.passes.forward import draw_translucent
from elemental.passes.gbuffer import GBuffer, draw_gbuffer
from elemental.passes.light_cells import cull_to_view
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.shade import shade
from elemental.passes.shadow import ShadowMaps, update_shadows
from elemental.passes.shadow_plan import ShadowSettings
from elemental.passes.sky import Sky
from elemental.passes.views import light_view
from elemental.scene.definitions import builtin
from elemental.scene.model import Camera, Instance, Light, Material, Mesh, Scene
from shapes import Shape

Array = npt.NDArray[Any]
IDENTITY = np.eye(4, dtype=np.float32)
UNLIT = builtin("unlit")


def vector(*values: float) -> Array:
    return np.array(values, np.float32)


def material(**fields: Any) -> Material:
    """A rough white dielectric, but for the given fields."""
    given = {"base_color": vector(1, 1, 1, 1), "metallic": 0.0, "roughness": 1.0, **fields}
    return Material("test", **given)


def mesh(shape: Shape, material: int = 0, smooth: bool = False, uv: Array | None = None) -> Mesh:
    """A mesh with flat normals, or with those of a body around the origin."""
    positions, indices = shape
    if smooth:
        normals = positions.copy()
    else:
        positions = positions[indices]
        faces = positions.reshape(-1, 3, 3)
        normals = np.repeat(
            np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), 3, axis=0
        )
        indices = np.arange(len(positions), dtype=np.uint32)
    count = len(positions)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    up = np.where(np.abs(normals[:, 1:2]) < 0.9, vector(0, 1, 0), vector(1, 0, 0))
    tangents = np.ones((count, 4), np.float32)
    tangents[:, :3] = np.cross(up, normals)
    tangents[:, :3] /= np.linalg.norm(tangents[:, :3], axis=1, keepdims=True)
    uv0 = positions[:, [0, 2]].astype(np.float32) if uv is None else uv
    return Mesh(
        name="test",
        positions=positions.astype(np.float32),
        normals=normals.astype(np.float32),
        tangents=tangents,
        uv0=uv0,
        uv1=uv0,
        colors=np.full((count, 4), 255, np.uint8),
        indices=indices,
        material=material,
    )


def scene(
    *parts: tuple[Mesh, Array],
    materials: Sequence[Material] = (),
    lights: Sequence[Light] = (),
    **fields: Any,
) -> Scene:
    """A scene of (mesh, world_from_local) pairs; a white dielectric where no material is given."""
    return Scene(
        name="test",
        path=Path("test"),
        meshes=[part for part, _ in parts],
        instances=[Instance(str(n), n, matrix) for n, (_, matrix) in enumerate(parts)],
        materials=list(materials) or [material()],
        lights=list(lights),
        **fields,
    )


def at(x: float, y: float, z: float) -> Array:
    """world_from_local that moves to a point."""
    moved = IDENTITY.copy()
    moved[:3, 3] = x, y, z
    return moved


def sun(direction: Array, lux: float = np.pi, **fields: Any) -> Light:
    """A white directional light; lux = pi lights a facing white surface to radiance 1."""
    unit = direction / np.linalg.norm(direction)
    return Light("sun", "directional", vector(1, 1, 1), lux, vector(0, 0, 0), unit, **fields)


def camera(eye: Array, target: Array, fov_y: float = 0.8, far: float = 100.0) -> Camera:
    matrix = transforms.inverse(transforms.look_at(eye, target))
    return Camera("test", matrix, fov_y, 0.1, far)


@dataclass
class Rig:
    """The passes of a frame over one scene. Images come back with row 0 on top."""

    device: Device
    scene: Scene
    camera: Camera
    size: tuple[int, int] = (96, 64)
    shadow_settings: ShadowSettings = field(default_factory=lambda: ShadowSettings(512))

    def __post_init__(self) -> None:
        self.gpu = GpuScene(self.device, self.scene)
        self.shadows = ShadowMaps(self.device, self.shadow_settings)
        self.sky = Sky(self.device)

    def begin(self) -> tuple[Graph, Array, GBuffer]:
        """(graph, the block View, G-buffer) of a new frame; shadows and sky are up to date."""
        g = self.device.begin_frame()
        view = pack_view(self.camera, self.size, self.gpu.bounds)
        self.sky.update(g, self.scene.environment)
        lights = self.scene.lights
        update_shadows(g, self.shadows, self.gpu, lights, camera=self.camera, size=self.size)
        return g, view, draw_gbuffer(g, view, self.gpu, self.size)

    def scene_color(self) -> Array:
        """(H, W, 4) float32 radiance; alpha 1 where a surface is."""
        g, view, gb = self.begin()
        cells = cull_to_view(g, view, self.shadows, self.camera, self.size)
        shade(g, view, gb, self.shadows, cells=cells, sky=self.sky)
        lit = draw_translucent(g, view, gb, self.gpu, self.shadows, sky=self.sky, cells=cells)
        return read(g, lit).astype(np.float32)

    def visibility(self) -> Array:
        """(H, W) share of the lights' irradiance that arrives."""
        g, view, gb = self.begin()
        return read(g, light_view(g, view, gb, self.shadows, "shadow"))[..., 0].astype(np.float32)

    def positions(self) -> Array:
        """(H, W, 3) world points of the pixels, NaN where nothing is."""
        g, view, gb = self.begin()
        depth = (read(g, gb.depth) >> 8) / (2.0**24 - 1.0)
        height, width = depth.shape
        x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
        clip = np.stack([2 * x - 1, 1 - 2 * y, 2 * depth - 1, np.ones_like(x)], axis=-1)
        world = clip @ np.linalg.inv(np.asarray(view["clip_from_world"], np.float64))
        return np.where(depth[..., None] < 1.0, world[..., :3] / world[..., 3:], np.nan)

    def release(self) -> None:
        self.gpu.release()
        self.shadows.release()
        self.sky.release()


MakeRig = Callable[..., Rig]
"""Rig without its device; the fixture `rig`."""


def read(g: Graph, target: TextureHandle) -> Array:
    """Run the frame and read one target, row 0 on top."""
    g.keep(target)
    g.execute()
    assert target.physical is not None
    return target.physical.read()[::-1]
