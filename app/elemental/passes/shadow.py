"""Shadow maps of every light, drawn anew only where a view or the geometry changed.

A directional light has one map of the whole scene, which lights voxels whatever the camera does,
and cascades for what the camera sees; a spot light has one map, a point light six.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import D32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Layer, Ref, Sampled
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import BASE_COLOR_SLOT, MASKED, Array
from elemental.passes.shadow_plan import CASCADE, MAPS, ShadowPlan, ShadowSettings, plan_shadows
from elemental.scene.model import Camera, Light

VERT, FRAG = "shadow/depth.vert.glsl", "shadow/depth.frag.glsl"
DEPTH = Raster(VERT, FRAG)
DEPTH_MASKED = Raster(VERT, FRAG, defines={"ALPHA_MASK": 1, "MATERIAL_TEXTURES": BASE_COLOR_SLOT})
STATE = RasterState(depth_test="lequal", polygon_offset=(0.0, 4.0))
"""Both faces cast: a single-sided wall shades too. The offset covers rounding; slopes are handled
by the receiver's shift along its normal (glsl/lib/shadow.glsl)."""


class ShadowMaps:
    """The maps on the device, with the buffers Lights and ShadowViews that go with them.

    `light_key` differs when anything differs that the light on a voxel depends on: a light or the
    geometry, not the camera.
    """

    def __init__(self, device: Device, settings: ShadowSettings) -> None:
        self._device = device
        self.settings = settings
        self.light_key: Hashable = None
        self._textures: dict[str, Texture] = {}
        self._buffers: dict[str, Buffer] = {}
        self._uploaded: dict[str, bytes] = {}
        self._drawn: dict[tuple[int, int], bytes] = {}

    def reads(self) -> dict[str, Ref]:
        """What a shader that includes lib/shadow.glsl reads; valid after `update_shadows`."""
        maps = {f"u_shadow_{name}": Sampled(self._textures[name], compare=True) for name in MAPS}
        return {**self._buffers, **maps}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of lib/shadow.glsl: none."""
        return {}

    def release(self) -> None:
        """Free the maps and the buffers."""
        for texture in self._textures.values():
            texture.release()
        for buffer in self._buffers.values():
            buffer.release()
        for held in (self._textures, self._buffers, self._uploaded, self._drawn):
            held.clear()

    def place(self, plan: ShadowPlan, version: int) -> list[int]:
        """Upload a plan. Returns the numbers of the views whose map has to be drawn anew."""
        for name in MAPS:
            self._allocate(name, plan.layers(name))
        self._upload("Lights", plan.lights)
        self._upload("ShadowViews", plan.views)
        fixed = plan.views["map"] != MAPS.index(CASCADE)
        self.light_key = (version, plan.lights.tobytes(), plan.views[fixed].tobytes())
        stale = []
        for number, view in enumerate(plan.views):
            place = (int(view["map"]), int(view["layer"]))
            content = view.tobytes() + version.to_bytes(8, "little")
            if self._drawn.get(place) != content:
                self._drawn[place] = content
                stale.append(number)
        return stale

    def target(self, view: Array) -> Layer:
        """The depth layer of one record of ShadowView."""
        return Layer(self._textures[MAPS[int(view["map"])]], int(view["layer"]))

    def _allocate(self, name: str, layers: int) -> None:
        """An array of at least so many layers; a single texel where a light may never look."""
        texels = self.settings.texels(name) if layers else 1
        texture = self._textures.get(name)
        if texture is not None:
            if layers <= (texture.layers or 0) and texels <= texture.width:
                return
            texture.release()
        number = MAPS.index(name)
        self._drawn = {place: c for place, c in self._drawn.items() if place[0] != number}
        self._textures[name] = self._device.texture(
            f"shadow.{name}", (texels, texels), D32F, layers=max(layers, 1), category="targets"
        )

    def _upload(self, name: str, values: Array) -> None:
        content = values.tobytes()
        if self._uploaded.get(name) == content:
            return
        buffer = self._buffers.get(name)
        if buffer is not None and self._uploaded.get(name) and buffer.nbytes == len(content):
            buffer.write(content)
        else:
            if buffer is not None:
                buffer.release()
            self._buffers[name] = self._device.buffer(name, content, dynamic=True)
        self._uploaded[name] = content


def update_shadows(
    g: Graph,
    maps: ShadowMaps,
    scene: GpuScene,
    lights: Sequence[Light],
    *,
    camera: Camera,
    size: tuple[int, int],
) -> ShadowMaps:
    """Bring every map up to date and return `maps`, ready to be read. size: px of the picture."""
    plan = plan_shadows(lights, scene.bounds, camera, size, maps.settings)
    for number in maps.place(plan, scene.version):
        _draw_view(g, maps, scene, plan.views[number], number)
    return maps


def _draw_view(g: Graph, maps: ShadowMaps, scene: GpuScene, view: Array, number: int) -> None:
    shader_inputs = maps.reads()
    params = {"ShadowPass": pack(layouts().block("ShadowPass"), view=np.uint32(number))}
    name = f"shadow.{MAPS[int(view['map'])]}.{int(view['layer'])}"

    def draw_opaque(enc: Encoder) -> None:
        scene.draw_positions(enc)

    def draw_masked(enc: Encoder) -> None:
        scene.draw(enc, scene.batches(MASKED), texture_mask=BASE_COLOR_SLOT, cull=False)

    reads = {"Instances": scene.instances, "ShadowViews": shader_inputs["ShadowViews"]}
    g.raster(
        DEPTH, name, depth=maps.target(view), reads=reads, params=params, state=STATE,
        clear_depth=1.0, draw=draw_opaque,
    )  # fmt: skip
    if scene.batches(MASKED):
        g.raster(
            DEPTH_MASKED, f"{name}.masked", depth=maps.target(view),
            reads={**reads, "Materials": scene.materials}, params=params, state=STATE,
            draw=draw_masked,
        )  # fmt: skip
