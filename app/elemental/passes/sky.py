"""The environment: an octahedral map whose levels hold radiance averaged over ever wider cones."""

from __future__ import annotations

import copy
import math
from collections.abc import Hashable

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Mip, Ref, Sampled
from elemental.gpu.resources import Texture
from elemental.gpu.shaders import Compute
from elemental.scene.model import Environment, FloatArray

PROJECT = Compute("sky/project.comp.glsl")
PREFILTER = Compute("sky/prefilter.comp.glsl")
NORMALIZE = Compute("sky/normalize.comp.glsl")

SMALLEST, LARGEST = 64, 1024
"""Texels a side of level 0. Half the image's width keeps its angular resolution: the equator runs
over 2 sqrt(2) sides of the octahedral square."""
COARSEST = 8
"""Texels a side of the last level, its border included."""
WIDEST = math.pi / 2
"""Cone half angle of the last level: a hemisphere."""
PROJECT_SAMPLES = 4
"""Samples a side of a texel of level 0; with the bilinear source they overlap at every latitude."""


class Sky:
    """The environment's map on the device and its constants. `key` differs when its light does."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._built: tuple[FloatArray | None, FloatArray | None] = (None, None)
        self._images: list[Texture] = []
        self._map = _constant_map(device)
        self._whole: Texture | None = None
        self._params = _params(self._map, np.zeros(3, np.float32))
        self.key: Hashable = None
        self._builds = 0

    def reads(self) -> dict[str, Ref]:
        """What a shader that includes lib/sky.glsl reads."""
        return {"u_sky": Sampled(self._map, filter="trilinear")}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of lib/sky.glsl."""
        return {"Sky": self._params}

    def update(
        self,
        g: Graph,
        environment: Environment | None,
        intensity: float = 1.0,
        *,
        without_sun: bool = False,
    ) -> Sky:
        """Follow the environment (None: black) times `intensity`; the map is built only for a new
        image, and without the sun that was found there if that is a light by itself. Returns the
        sky, ready to be read."""
        for image in self._images:
            image.release()
        self._images.clear()
        radiance = whole = None if environment is None else environment.radiance
        if without_sun and environment is not None and environment.sun is not None:
            radiance = environment.sun.without
        if radiance is not self._built[0] or whole is not self._built[1]:
            self._build(g, radiance, whole)
        tint = np.zeros(3, np.float32)
        if environment is not None:
            tint = np.asarray(environment.tint * environment.intensity * intensity, np.float32)
        self._params = _params(self._map, tint)
        self.key = (self._builds, tint.tobytes())
        return self

    def tinted(self, factor: tuple[float, float, float]) -> Sky:
        """This sky as surfaces in view gather it: its radiance times ``factor``.

        It is this frame's, and shares the map; what the voxels gather stays as it is.
        """
        if factor == (1.0, 1.0, 1.0):
            return self
        other = copy.copy(self)
        other._params = self._params.copy()
        other._params["tint"] *= factor
        return other

    def drawn(self) -> Sky:
        """This sky as the eye sees it behind the scene: its sun is there, even where it is a light.

        It is this frame's, and its map has one level, for directions without a width.
        """
        if self._whole is None:
            return self
        other = copy.copy(self)
        other._map = self._whole
        other._params = _params(self._whole, self._params["tint"])
        return other

    def release(self) -> None:
        """Free the maps."""
        for texture in (self._map, self._whole, *self._images):
            if texture is not None:
                texture.release()

    def _build(self, g: Graph, radiance: FloatArray | None, whole: FloatArray | None) -> None:
        self._built = (radiance, whole)
        self._builds += 1
        self._map.release()
        if self._whole is not None:
            self._whole.release()
            self._whole = None
        if radiance is None or whole is None:
            self._map = _constant_map(self._device)
            return
        size = min(max(1 << (radiance.shape[1] // 2 - 1).bit_length(), SMALLEST), LARGEST)
        self._map = self._mapped(g, "sky.map", radiance, size, (size // COARSEST).bit_length())
        if whole is not radiance:
            self._whole = self._mapped(g, "sky.whole", whole, size, 1)

    def _mapped(self, g: Graph, name: str, radiance: FloatArray, size: int, levels: int) -> Texture:
        """The map of an image, of ``size`` texels a side."""
        height, width = radiance.shape[:2]
        texels = np.ones((height, width, 4), np.float32)
        texels[..., :3] = radiance
        image = self._device.texture("sky.image", (width, height), RGBA32F, data=texels)
        self._images.append(image)
        sky = self._device.texture(name, (size, size), RGBA32F, mips=levels)
        _fill_levels(g, image, sky, mean_radiance(radiance))
        return sky


def mean_radiance(radiance: FloatArray) -> FloatArray:
    """(3,) mean over the sphere of an equirectangular image (H, W, 3)."""
    height = len(radiance)
    weights = np.sin((np.arange(height) + 0.5) * np.pi / height)
    rows = radiance.mean(axis=1, dtype=np.float64)
    return np.asarray(weights @ rows / weights.sum(), np.float32)


def level_half_angle(level: int, levels: int) -> float:
    """Cone half angle of a level in radians; level 0 is the image itself."""
    return math.ldexp(WIDEST, level - levels + 1) if level else 0.0


def _fill_levels(g: Graph, image: Texture, sky: Texture, mean: FloatArray) -> None:
    block = layouts().block
    g.compute(
        PROJECT,
        reads={"u_equirect": Sampled(image, filter="linear", wrap=("repeat", "clamp"))},
        writes={"o_level": Mip(sky, 0)},
        params={"SkyProject": pack(block("SkyProject"), size=sky.width, samples=PROJECT_SAMPLES)},
        threads=sky.size,
    )
    _normalize(g, sky, 0, mean)
    for level in range(1, sky.mips):
        size = sky.width >> level
        own, finer = (level_half_angle(n, sky.mips) for n in (level, level - 1))
        params = pack(
            block("SkyPrefilter"),
            size=size,
            source_size=2 * size,
            half_angle=math.sqrt(own * own - finer * finer),
        )
        g.compute(
            PREFILTER,
            f"sky.prefilter.{level}",
            reads={"u_source": Sampled(Mip(sky, level - 1), filter="linear")},
            writes={"o_level": Mip(sky, level)},
            params={"SkyPrefilter": params},
            threads=(size, size),
        )
        _normalize(g, sky, level, mean)


def _normalize(g: Graph, sky: Texture, level: int, mean: FloatArray) -> None:
    params = pack(layouts().block("SkyNormalize"), mean=mean, size=sky.width >> level)
    g.compute(
        NORMALIZE,
        f"sky.normalize.{level}",
        writes={"u_level": Mip(sky, level)},
        params={"SkyNormalize": params},
        groups=1,
    )


def _constant_map(device: Device) -> Texture:
    ones = np.ones((COARSEST, COARSEST, 4), np.float32)
    return device.texture("sky.map", (COARSEST, COARSEST), RGBA32F, data=ones)


def _params(sky: Texture, tint: FloatArray) -> Block:
    return pack(
        layouts().block("Sky"), tint=tint, level_count=sky.mips, size=sky.width, widest_angle=WIDEST
    )
