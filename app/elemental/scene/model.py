"""The scene as plain arrays: what the importers make and the renderer reads.

World space is right-handed, y up, in metres. Colours are linear with Rec. 709 primaries.
Photometric and radiometric units are not told apart: lux stands for W/m^2, candela for W/sr and
nit for W/(m^2 sr), as in glTF files without a luminous efficacy. The parts live by topic in
`arrays`, `materials`, `lights` and `cameras`; other packages import them all from here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import numpy as np

from elemental.core import transforms
from elemental.scene.arrays import ByteArray, FloatArray, IndexArray
from elemental.scene.cameras import Camera, CameraPath, framing_camera
from elemental.scene.decals import Decal
from elemental.scene.lights import Environment, Light, LightKind
from elemental.scene.materials import AlphaMode, Material, Texture, TextureSlot, Wrap
from elemental.scene.motion import Influences, Morphs, Motion
from elemental.scene.volumes import Volume

__all__ = [
    "AlphaMode",
    "ByteArray",
    "Camera",
    "CameraPath",
    "Decal",
    "Environment",
    "FloatArray",
    "IndexArray",
    "Instance",
    "Light",
    "LightKind",
    "Material",
    "Mesh",
    "Region",
    "Scene",
    "SettingValue",
    "Texture",
    "TextureSlot",
    "Wrap",
    "framing_camera",
    "unique_name",
]

SettingValue: TypeAlias = bool | int | float | str | list[float]


@dataclass
class Mesh:
    """One glTF primitive as an indexed triangle list; every array is present.

    positions (N, 3) float32; normals (N, 3) float32 unit; tangents (N, 4) float32, xyz unit,
    w = ±1 with bitangent = w · cross(normal, tangent); uv0, uv1 (N, 2) float32; colors (N, 4)
    uint8 linear; indices (3T,) uint32; `material` indexes `Scene.materials`. Front faces wind
    counter-clockwise. `influences` and `morphs` are those of meshes that bend as they move.
    """

    name: str
    positions: FloatArray
    normals: FloatArray
    tangents: FloatArray
    uv0: FloatArray
    uv1: FloatArray
    colors: ByteArray
    indices: IndexArray
    material: int
    influences: Influences | None = None
    morphs: Morphs | None = None

    @property
    def triangle_count(self) -> int:
        return len(self.indices) // 3


@dataclass
class Instance:
    """`Scene.meshes[mesh]` placed in the world by an invertible (4, 4) float32 matrix.

    The loaders give a mirroring instance (negative determinant) a mesh of its own with reversed
    winding and tangent w, so that front faces are counter-clockwise after the transform, always.

    `dynamic`: a pose may place, bend or hide it; `node` of `Scene.motion`'s rig places it (-1:
    nothing does). With a `skin` of the motion its joints place its vertices in the world by
    themselves. `weights` (T,) float32 are its morph targets' at rest. Decals leave alone what does
    not `receives_decals`.
    """

    name: str
    mesh: int
    world_from_local: FloatArray
    dynamic: bool = False
    node: int = -1
    skin: int = -1
    weights: FloatArray | None = None
    receives_decals: bool = True


@dataclass
class Region:
    """A world-space box whose voxel leaves are `level_offset` levels finer (+) or coarser (-)."""

    minimum: FloatArray
    maximum: FloatArray
    level_offset: int


@dataclass
class Scene:
    """Everything that a frame needs to know of a file.

    What moves stands as at time 0; `extent` (min, max) is the box that holds it at all times, None
    where nothing moves. `animations` are the names of those that the files hold, `movers`
    tells of each motion of a scene file what it moves and how. `hidden` counts the instances that
    are left out, since a scale of 0 or a key hides them all the time.
    """

    name: str
    path: Path
    meshes: list[Mesh] = field(default_factory=list)
    instances: list[Instance] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    textures: list[Texture] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)
    environment: Environment | None = None
    exposure_ev: float | None = None
    settings: dict[str, SettingValue] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    camera_path: CameraPath | None = None
    regions: list[Region] = field(default_factory=list)
    volumes: list[Volume] = field(default_factory=list)
    decals: list[Decal] = field(default_factory=list)
    motion: Motion | None = None
    extent: tuple[FloatArray, FloatArray] | None = None
    animations: list[str] = field(default_factory=list)
    movers: list[str] = field(default_factory=list)
    hidden: int = 0
    folder: Path = field(init=False)
    """What file names in the settings and in volumes count from, wherever the scene is saved."""

    def __post_init__(self) -> None:
        self.folder = self.path.parent

    @property
    def triangle_count(self) -> int:
        """Triangles drawn: each instance counts its mesh's."""
        return sum(self.meshes[i.mesh].triangle_count for i in self.instances)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """World-space (min, max), each (3,) float32, over every instance's triangles.

        What moves counts with its whole way. Raises ValueError if the scene has no instance; the
        loaders never return such a scene.
        """
        if self.extent is not None:
            return self.extent
        corners = [self.instance_bounds(instance) for instance in self.instances]
        if not corners:
            raise ValueError("a scene without instances has no bounds")
        lows, highs = zip(*corners, strict=True)
        return np.min(lows, axis=0), np.max(highs, axis=0)

    def default_camera(self, aspect: float) -> Camera:
        """The file's first camera, else one that frames the scene at width/height `aspect`."""
        return self.cameras[0] if self.cameras else framing_camera(*self.bounds(), aspect)

    def instance_bounds(self, instance: Instance) -> tuple[FloatArray, FloatArray]:
        """World-space (min, max) of a rigid instance where it stands."""
        mesh = self.meshes[instance.mesh]
        points = transforms.transform_points(instance.world_from_local, mesh.positions)
        return points.min(axis=0), points.max(axis=0)


def unique_name(name: str, taken: set[str]) -> str:
    """`name`, with a number behind it if another has it already."""
    if name not in taken:
        return name
    return next(f"{name}.{k}" for k in range(2, len(taken) + 3) if f"{name}.{k}" not in taken)
