"""Shadow maps of every light, drawn anew only where a view or what it sees changed.

A directional light has one map of the whole scene, which lights voxels whatever the camera does,
and cascades for what the camera sees; a spot light has one map, a point light six, and an area
light five or six from each of nine points.

Where parts of the scene can move, what stands has maps of its own: a map that only moving things
changed begins with a copy of these.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Sequence
from functools import partial

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import D32F
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Layer, Ref, Sampled
from elemental.gpu.resources import Buffer, Texture
from elemental.gpu.shaders import Raster
from elemental.gpu.state import RasterState
from elemental.passes.culling import views_with_any
from elemental.passes.light_shapes import LightShapes
from elemental.passes.material_pack import BASE_COLOR_SLOT
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import MASKED, Array, Batch
from elemental.passes.shadow_plan import ShadowPlan, ShadowPlanner, ShadowSettings
from elemental.passes.shadow_tiles import Tile
from elemental.scene.area_lights import AreaLight
from elemental.scene.model import Camera, Light

VERT, FRAG = "shadow/depth.vert.glsl", "shadow/depth.frag.glsl"
DEPTH = {cut: Raster(VERT, FRAG, defines={"CUT": int(cut)}) for cut in (False, True)}
"""By whether what is behind an area light is left out."""
STATE = RasterState(depth_test="lequal", polygon_offset=(0.0, 4.0))
"""Both faces cast: a single-sided wall shades too. The offset covers rounding; slopes are handled
by the receiver's shift along its normal (glsl/lib/shadow.glsl)."""


class ShadowMaps:
    """The maps on the device, with the buffers Lights and ShadowViews that go with them.

    `light_key` differs when anything differs that the light on a voxel depends on: a light or the
    geometry, not the camera. `lamp_key` differs when a light does. `culled`: whether there are so
    many lights that passes/light_cells.py sorts them, in `light_words` words of 32; `soft`: whether
    any of them casts penumbras.
    """

    def __init__(self, device: Device, settings: ShadowSettings) -> None:
        self._device = device
        self.planner = ShadowPlanner(settings)
        self._shapes = LightShapes(device)
        self.light_key: Hashable = None
        self.lamp_key: Hashable = None
        self.counts: dict[str, int] = {}
        self.culled = self.soft = False
        self.light_words = 1
        self._maps: Texture | None = None
        self._buffers: dict[str, Buffer] = {}
        self._uploaded: dict[str, bytes] = {}
        self._shown: list[bytes] = []
        self._drawn: dict[Tile, bytes] = {}
        self._still: Texture | None = None
        self._still_drawn: dict[Tile, bytes] = {}
        self._dynamic = b""
        self._drawn_version = 0

    def reads(self) -> dict[str, Ref]:
        """What a shader that includes lib/shadow.glsl reads; valid after `update_shadows`."""
        assert self._maps is not None, "update_shadows comes first"
        buffers = {name: self._buffers[name] for name in ("Lights", "ShadowViews")}
        return {**buffers, "u_shadow_maps": Sampled(self._maps, compare=True)}

    def light_reads(self) -> dict[str, Ref]:
        """What a shader reads that includes lib/lights.glsl, too."""
        return {**self.reads(), **self._shapes.reads()}

    def depth_reads(self, contact: bool = False) -> dict[str, Ref]:
        """What a shader reads that asks lib/shadow.glsl of what the camera sees.

        Its SOFT_SHADOWS as `soft` is; ``contact``: its CONTACT_SHADOWS.
        """
        assert self._maps is not None, "update_shadows comes first"
        depths = {"u_shadow_depths": Sampled(self._maps)} if self.soft or contact else {}
        return {**self.reads(), **depths}

    def view_reads(self, contact: bool = False) -> dict[str, Ref]:
        """What a shader reads, too, that shades it by lib/lights.glsl."""
        return {**self.depth_reads(contact), **self._shapes.reads()}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of lib/shadow.glsl: none."""
        return {}

    @property
    def light_bounds(self) -> Buffer:
        """The storage block LightBounds of passes/light_cells.py."""
        return self._buffers["LightBounds"]

    def release(self) -> None:
        """Free the maps and the buffers."""
        for maps in (self._maps, self._still):
            if maps is not None:
                maps.release()
        self._maps = self._still = None
        self._shapes.release()
        for buffer in self._buffers.values():
            buffer.release()
        for held in (self._buffers, self._uploaded, self._drawn, self._still_drawn):
            held.clear()

    def place(self, plan: ShadowPlan, scene: GpuScene) -> list[int]:
        """Upload a plan. Returns the numbers of the views whose map has to be drawn anew."""
        self._shapes.update(plan.shapes)
        self._allocate(plan.layers, bool(scene.dynamic.any() and not scene.dynamic.all()))
        self._upload("Lights", plan.lights)
        self._upload("LightBounds", plan.bounds)
        self._upload("ShadowViews", plan.views.structs)
        same_views = self._shown == plan.views.shown
        self._shown = plan.views.shown
        self.soft = bool((plan.lights["penumbra_radius"] > 0.0).any() and len(plan.views.names))
        self.culled, self.light_words = plan.culled, -(-len(plan.lights) // 32)
        self.counts = {
            "shadow_maps": len(plan.views.names),
            "lights_without_shadow": plan.unshadowed,
        }
        self.lamp_key = (plan.key, self._shapes.revision)
        self.light_key = (scene.version, self.lamp_key)
        self._forget_changed(plan, scene)
        for drawn in (self._drawn, self._still_drawn):
            if not same_views:
                for tile in drawn.keys() - set(plan.views.tiles):
                    del drawn[tile]
        if same_views and len(self._drawn) == len(plan.views.tiles):
            return []
        stale = []
        for number, (tile, shown) in enumerate(zip(plan.views.tiles, self._shown, strict=True)):
            if self._drawn.get(tile) != shown:
                self._drawn[tile] = shown
                stale.append(number)
        return stale

    def _forget_changed(self, plan: ShadowPlan, scene: GpuScene) -> None:
        """Forget the maps that show what changed since they were drawn."""
        if self._dynamic != scene.dynamic.tobytes():
            self._dynamic = scene.dynamic.tobytes()
            self._still_drawn.clear()
        drawn, self._drawn_version = self._drawn_version, scene.version
        if scene.version == drawn:
            return
        if scene.version != drawn + 1:
            self._drawn.clear()
            self._still_drawn.clear()
            return
        casters = [change for change in scene.changes if change.casts]
        if not all(scene.dynamic[change.instance] for change in casters):
            self._still_drawn.clear()
        boxes = [box for change in casters for box in (change.before, change.after) if box]
        if not boxes:
            return
        low, high = (np.array(corners) for corners in zip(*boxes, strict=True))
        sees = views_with_any(plan.views.structs["clip_from_world"].swapaxes(1, 2), low, high)
        for number in np.flatnonzero(sees):
            self._drawn.pop(plan.views.tiles[number], None)

    def target(self, plan: ShadowPlan, number: int) -> Layer:
        """The depth layer that holds the tile of one view."""
        assert self._maps is not None
        return Layer(self._maps, plan.views.tiles[number].layer)

    def still_target(self, plan: ShadowPlan, number: int) -> tuple[Layer, bool] | None:
        """The layer of what stands as one view sees it, and whether it has to be drawn anew; None
        where maps are drawn whole."""
        if self._still is None:
            return None
        tile, shown = plan.views.tiles[number], plan.views.shown[number]
        stale = self._still_drawn.get(tile) != shown
        self._still_drawn[tile] = shown
        return Layer(self._still, tile.layer), stale

    def copy_still(self, g: Graph, tile: Tile) -> None:
        """Begin a view's map with what stands."""
        assert self._still is not None
        assert self._maps is not None
        g.copy_texture(self._still, self._maps, layer=tile.layer, tile=_rectangle(tile))

    def _allocate(self, layers: int, moves: bool) -> None:
        """So many layers; a single texel where no light may look."""
        texels = self.planner.settings.resolution if layers else 1
        if self._maps is not None:
            if (max(layers, 1), texels) == (self._maps.layers or 1, self._maps.width):
                return
            self._maps.release()
            if self._still is not None:
                self._still.release()
                self._still = None
        self._drawn.clear()
        self._still_drawn.clear()

        def maps(name: str) -> Texture:
            return self._device.texture(
                name, (texels, texels), D32F, layers=max(layers, 1), category="targets"
            )

        self._maps = maps("shadow.maps")
        if moves and layers:
            self._still = maps("shadow.still_maps")

    def _upload(self, name: str, values: Array) -> bool:
        """Whether it differs from what was uploaded last."""
        content = values.tobytes()
        if self._uploaded.get(name) == content:
            return False
        buffer = self._buffers.get(name)
        if buffer is not None and self._uploaded.get(name) and buffer.nbytes == len(content):
            buffer.write(content)
        else:
            if buffer is not None:
                buffer.release()
            self._buffers[name] = self._device.buffer(name, content, dynamic=True)
        self._uploaded[name] = content
        return True


def update_shadows(
    g: Graph,
    maps: ShadowMaps,
    scene: GpuScene,
    lights: Sequence[Light],
    *,
    camera: Camera,
    size: tuple[int, int],
    emitters: Sequence[AreaLight] = (),
) -> ShadowMaps:
    """Bring every map up to date and return `maps`, ready to be read. size: px of the picture;
    ``emitters``: area lights that get maps."""
    plan = maps.planner.plan(lights, scene.bounds, camera, size, emitters)
    stale = maps.place(plan, scene)
    matrices = plan.views.structs["clip_from_world"][stale].swapaxes(1, 2)
    scene.look([_viewer(number) for number in stale], matrices)
    for number in stale:
        _draw_view(g, maps, scene, plan, number)
    return maps


def _viewer(number: int) -> str:
    """Whom the scene culls for, by the number of a view."""
    return f"shadow.{number}"


def _rectangle(tile: Tile) -> tuple[int, int, int, int]:
    """(x, y, width, height)"""
    return tile.x, tile.y, tile.side, tile.side


def _draw_view(g: Graph, maps: ShadowMaps, scene: GpuScene, plan: ShadowPlan, number: int) -> None:
    tile, name = plan.views.tiles[number], f"shadow.{plan.views.names[number]}"
    still = maps.still_target(plan, number)
    cut = number < plan.from_emitters
    draw = partial(_draw_casters, g, scene, plan.views.blocks[number], _viewer(number), tile, cut)
    if still is None:
        draw(name, maps.target(plan, number), None)
        return
    target, stale = still
    if stale:
        draw(f"{name}.still", target, False)
    maps.copy_still(g, tile)
    draw(name, maps.target(plan, number), True)


def _draw_casters(
    g: Graph,
    scene: GpuScene,
    block: Block,
    viewer: str,
    tile: Tile,
    cut: bool,
    name: str,
    target: Layer,
    dynamic: bool | None,
) -> None:
    """The depth of what can, or can't, move, into an empty map; what can move on top of the rest.

    ``dynamic`` None: of everything. ``block``: ShadowPass, with what is ``cut`` away.
    """

    def draw_opaque(enc: Encoder) -> None:
        scene.draw_positions(enc, seen_by=viewer, dynamic=dynamic)

    reads = {"u_instances": scene.instances}
    params = {"ShadowPass": block}
    place = _rectangle(tile)
    g.raster(
        DEPTH[cut], name, depth=target, reads=reads, params=params, state=STATE,
        clear_depth=None if dynamic else 1.0, tile=place, draw=draw_opaque,
    )  # fmt: skip
    masked: dict[Raster, list[Batch]] = defaultdict(list)
    for batch in scene.batches(MASKED, dynamic):
        mask = _masked_textures(batch)
        defines = {"ALPHA_MASK": 1, "CUT": int(cut)}
        shader = material_shader(VERT, FRAG, batch, defines, texture_mask=mask)
        masked[shader].append(batch)
    for shader, batches in masked.items():

        def draw_masked(enc: Encoder, batches: list[Batch] = batches) -> None:
            mask = _masked_textures(batches[0])
            scene.draw(enc, batches, texture_mask=mask, cull=False, seen_by=viewer)

        g.raster(
            shader, f"{name}.masked", depth=target, reads=scene.reads(),
            writes=scene.materials.writes(batches), params=params | scene.params(), state=STATE,
            tile=place, draw=draw_masked,
        )  # fmt: skip


def _masked_textures(batch: Batch) -> int:
    """MATERIAL_TEXTURES for the alpha test of a batch: the base colour alone in glTF's material."""
    return batch.texture_mask if batch.definition.may_fail else BASE_COLOR_SLOT
