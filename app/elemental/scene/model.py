"""The scene as plain arrays: what the importers make and the renderer reads.

World space is right-handed, y up, in metres. Colours are linear with Rec. 709 primaries.
Photometric and radiometric units are not told apart: lux stands for W/m^2, candela for W/sr and
nit for W/(m^2 sr), as in glTF files without a luminous efficacy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.scene.motion import Influences, Morphs, Motion

FloatArray: TypeAlias = npt.NDArray[np.float32]
ByteArray: TypeAlias = npt.NDArray[np.uint8]
IndexArray: TypeAlias = npt.NDArray[np.uint32]

Wrap: TypeAlias = Literal["repeat", "clamp", "mirror"]
AlphaMode: TypeAlias = Literal["opaque", "mask", "blend"]
LightKind: TypeAlias = Literal["directional", "point", "spot"]
SettingValue: TypeAlias = bool | int | float | str | list[float]


@dataclass
class Texture:
    """An image with its sampler. `pixels` is (H, W, 4) uint8 as stored: row 0 is v = 0."""

    name: str
    pixels: ByteArray
    wrap_u: Wrap = "repeat"
    wrap_v: Wrap = "repeat"
    nearest: bool = False


@dataclass
class TextureSlot:
    """A material's use of `Scene.textures[texture]`.

    `uv_from_uv` is (2, 3) float32: texture coordinate = uv_from_uv @ (u, v, 1).
    """

    texture: int
    uv_set: Literal[0, 1] = 0
    uv_from_uv: FloatArray = field(default_factory=lambda: np.eye(2, 3, dtype=np.float32))


@dataclass
class Material:
    """glTF's metallic-roughness material.

    `base_color` (4,) float32 linear with opacity; `emissive` (3,) float32 linear radiance in nit,
    strength included. Textures multiply their factors: base colour and emissive textures are sRGB
    encoded, the others linear (metallic in B, roughness in G, occlusion in R).
    """

    name: str
    base_color: FloatArray = field(default_factory=lambda: np.ones(4, np.float32))
    metallic: float = 1.0
    roughness: float = 1.0
    emissive: FloatArray = field(default_factory=lambda: np.zeros(3, np.float32))
    normal_scale: float = 1.0
    occlusion_strength: float = 1.0
    base_color_texture: TextureSlot | None = None
    metallic_roughness_texture: TextureSlot | None = None
    normal_texture: TextureSlot | None = None
    occlusion_texture: TextureSlot | None = None
    emissive_texture: TextureSlot | None = None
    alpha_mode: AlphaMode = "opaque"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    unlit: bool = False

    @property
    def emits(self) -> bool:
        """Whether any radiance leaves the surface by itself."""
        return bool(self.emissive.max() > 0.0)


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
    themselves. `weights` (T,) float32 are its morph targets' at rest.
    """

    name: str
    mesh: int
    world_from_local: FloatArray
    dynamic: bool = False
    node: int = -1
    skin: int = -1
    weights: FloatArray | None = None


@dataclass
class Light:
    """A punctual light (KHR_lights_punctual).

    `intensity` is lux for a directional light, candela for the others; `position` and `direction`
    are (3,) float32, the direction a unit vector pointing away from the light; `range` in m; cone
    half angles in radians; `source_radius` in m. A `node` of `Scene.motion`'s rig moves it.
    """

    name: str
    kind: LightKind
    color: FloatArray
    intensity: float
    position: FloatArray
    direction: FloatArray
    range: float = math.inf
    inner_angle: float = 0.0
    outer_angle: float = math.pi / 4
    source_radius: float = 0.0
    casts_shadow: bool = True
    node: int = -1


@dataclass
class Camera:
    """A perspective camera looking down its -z: `fov_y` in radians, `near` and `far` in m.

    `far` None: as far as the scene reaches; `aspect` None: the image's own. A `node` of
    `Scene.motion`'s rig moves it.
    """

    name: str
    world_from_view: FloatArray
    fov_y: float
    near: float
    far: float | None = None
    aspect: float | None = None
    node: int = -1


@dataclass
class CameraPath:
    """A camera's motion: keys at `times` (K,) float64 s, increasing; eyes, targets (K, 3) m."""

    times: npt.NDArray[np.float64]
    eyes: FloatArray
    targets: FloatArray
    fov_y: float
    near: float
    loop: bool = False


@dataclass
class Environment:
    """Light from infinity: `radiance` (H, W, 3) float32 equirectangular times tint and intensity.

    Direction (x, y, z) is at u = 1/2 + atan2(x, -z) / 2π, v = acos(y) / π, v downwards: row 0 is
    +y, the middle column -z. Without an image the radiance is 1 everywhere.
    """

    radiance: FloatArray | None
    tint: FloatArray
    intensity: float


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
    where nothing moves. `animations` are the names of those that the files hold.
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
    motion: Motion | None = None
    extent: tuple[FloatArray, FloatArray] | None = None
    animations: list[str] = field(default_factory=list)

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


FRAMING_FOV_Y = math.radians(39.3)
"""Of the Cornell box's published camera (35 mm film, 25 mm sensor)."""
FRAMING_MARGIN = 1.05
FRAMING_ELEVATION = math.radians(30.0)
"""How far a camera looks down on a flat scene; on one as high as deep it looks level."""
FRAMING_NEAR = 1e-3
"""Near plane of a framing camera as a part of the scene's diagonal."""


def framing_camera(low: FloatArray, high: FloatArray, aspect: float) -> Camera:
    """A camera in front of (+z of) the box low..high that just sees all eight corners.

    glTF assets face +z, so this looks at their front.
    """
    size = np.maximum(high - low, 0.0).astype(np.float64)
    diagonal = float(np.linalg.norm(size)) or 1.0
    flatness = float(np.clip(1.0 - size[1] / max(size[2], 1e-3 * diagonal), 0.0, 1.0))
    elevation = FRAMING_ELEVATION * flatness
    backward = np.array([0.0, math.sin(elevation), math.cos(elevation)])
    up = np.array([0.0, math.cos(elevation), -math.sin(elevation)])
    signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, 8).T
    corners = signs * size * FRAMING_MARGIN
    tan_y = math.tan(FRAMING_FOV_Y / 2)
    reach = np.maximum(np.abs(corners[:, 0]) / (tan_y * aspect), np.abs(corners @ up) / tan_y)
    distance = max(float((corners @ backward + reach).max()), 1e-2 * diagonal)
    center = (low.astype(np.float64) + high) / 2
    view_from_world = transforms.look_at(center + distance * backward, center, up)
    return Camera(
        name="default",
        world_from_view=transforms.inverse(view_from_world),
        fov_y=FRAMING_FOV_Y,
        near=FRAMING_NEAR * diagonal,
    )
