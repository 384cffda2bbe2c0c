"""Pictures made in numpy, developed by the post-processing graph or by one of its passes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.core.layout import Block, layouts
from elemental.gpu.device import Device
from elemental.gpu.formats import D24S8, RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyTexture, TextureHandle
from elemental.passes.camera_view import pack_view
from elemental.passes.gbuffer import GBuffer
from elemental.passes.post.develop import develop
from elemental.passes.post.history import PostHistory
from elemental.scene.model import Camera
from elemental.settings import Settings
from gpu.rig import read

Array = npt.NDArray[Any]

PLAIN: Mapping[str, Any] = {
    "eye_adaptation.min_brightness": 1.0,
    "eye_adaptation.max_brightness": 1.0,
    "vignette.intensity": 0.0,
    "bloom.intensity": 0.0,
    "lens_flare.intensity": 0.0,
    "fxaa.enabled": False,
}
"""Settings that leave exposure and film alone."""


def hdr(height: int, width: int, seed: int = 0) -> Array:
    """(H, W, 4) float16 radiance over many stops, alpha 1."""
    rng = np.random.default_rng(seed)
    pixels = np.ones((height, width, 4))
    pixels[..., :3] = np.exp2(rng.uniform(-10, 6, (height, width, 1)))
    pixels[..., :3] *= rng.uniform(0.5, 1.0, (height, width, 3))
    return pixels.astype(np.float16)


def flat(height: int, width: int, radiance: float) -> Array:
    """(H, W, 4) float16 of one grey."""
    pixels = np.ones((height, width, 4), np.float16)
    pixels[..., :3] = radiance
    return pixels


def luminance(pixels: Array) -> Array:
    """(H, W) float64 of (H, W, 3 or 4)."""
    return pixels[..., :3].astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722])


class Darkroom:
    """A device with the effects' history; images have row 0 on top."""

    def __init__(self, device: Device, **settings: Any) -> None:
        given = {key.replace("__", "."): value for key, value in settings.items()}
        self.device = device
        self.settings = Settings({**PLAIN, **given})
        self.history = PostHistory(device, self.settings)
        self.camera = camera()
        self.frame = 0

    def set(self, **settings: Any) -> None:
        """Change settings; `bloom__size1` is bloom.size1."""
        given = {key.replace("__", "."): value for key, value in settings.items()}
        self.settings = self.settings.replace(given)

    def view(self, size: tuple[int, ...], time_s: float = 0.0) -> Block:
        bounds = (np.full(3, -9, np.float32), np.full(3, 9, np.float32))
        view = pack_view(self.camera, (size[0], size[1]), bounds, time_s=time_s, frame=self.frame)
        self.frame += 1
        return view

    def develop(self, pixels: Array, time_s: float = 0.0, depth: Array | None = None) -> Array:
        """(H, W, 4) uint8 of radiance (H, W, 4); `depth`: (H, W) of the depth buffer, 0..1."""

        def passes(g: Graph, source: AnyTexture, behind: AnyTexture) -> TextureHandle:
            gb: Any = _Depth(behind)
            view = self.view(source.size, time_s)
            return develop(g, view, source, gb, self.settings, self.history)  # type: ignore[arg-type]

        return self.run(passes, pixels, depth)

    def run(
        self,
        passes: Callable[[Graph, AnyTexture, AnyTexture], TextureHandle],
        pixels: Array,
        depth: Array | None = None,
    ) -> Array:
        """What ``passes(graph, picture, depth)`` make of a picture (H, W, 4)."""
        height, width = pixels.shape[:2]
        depths = np.full((height, width), 0.5) if depth is None else depth
        codes = np.round(np.flipud(depths) * (2.0**24 - 1)).astype(np.uint32) << 8
        upright = np.ascontiguousarray(np.flipud(pixels.astype(np.float16)))
        source = self.device.texture("source", (width, height), RGBA16F, data=upright)
        behind = self.device.texture("depth", (width, height), D24S8, data=codes)
        g = self.device.begin_frame()
        result = read(g, passes(g, source, behind)).copy()
        self.device.finish()
        source.release()
        behind.release()
        return result

    def passes(self) -> list[str]:
        """Names of the passes that the last frame ran."""
        return [timing.name for timing in self.device.timings]

    def eye(self) -> Any:
        """The record Eye of glsl/shared/exposure.glsl."""
        return self.history.eye.state.read(layouts().struct("Eye"), 1)[0]


class _Depth(GBuffer):
    """A G-buffer of which the effects may look at the depth alone."""

    def __init__(self, depth: AnyTexture) -> None:
        object.__setattr__(self, "depth", depth)


def camera(near: float = 0.1, far: float = 100.0) -> Camera:
    """At the origin, looking along -z."""
    matrix = transforms.inverse(transforms.look_at((0, 0, 0), (0, 0, -1)))
    return Camera("test", matrix, 0.8, near, far)
