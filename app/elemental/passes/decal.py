"""Decals: materials projected onto the depth buffer and blended into the G-buffer before light.

[Mittring12 "GBuffer": stencil masking, decal mask]
"""

from __future__ import annotations

from itertools import groupby

import numpy as np

from elemental.core.layout import Block
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import RG32UI
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref
from elemental.gpu.resources import Buffer
from elemental.gpu.shaders import Compute, Raster
from elemental.gpu.state import RasterState, Stencil
from elemental.passes.culling import in_frustum
from elemental.passes.decal_pack import (
    Array,
    DecalRun,
    decal_boxes,
    draw_order,
    pack_decals,
    runs_of,
)
from elemental.passes.decal_voxels import VOXEL_CHANNELS, DecalVoxels
from elemental.passes.gbuffer import REFUSES_DECALS, GBuffer
from elemental.passes.material_table import material_shader
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.scene_pack import DRAW_COMMAND
from elemental.scene.model import Material, Scene

VERT, FRAG = "decal/decal.vert.glsl", "decal/decal.frag.glsl"
RECEIVERS = Compute("decal/receivers.comp.glsl")

RGB = (True, True, True, False)
"""Alphas hold what no decal changes: lighting model, ambient occlusion, decal mask."""
STATE = RasterState(
    cull="front",
    depth_test="gequal",
    depth_write=False,
    depth_clamp=True,
    blend="alpha",
    stencil=Stencil(test="notequal", reference=REFUSES_DECALS, read_mask=REFUSES_DECALS),
    color_mask=(RGB, RGB, RGB, RGB, (True, False, False, False)),  # D: the specular power alone
)
CUBE = np.array(
    [
        0, 2, 3, 0, 3, 1,  # z = 0
        4, 5, 7, 4, 7, 6,
        0, 1, 5, 0, 5, 4,  # y = 0
        2, 6, 7, 2, 7, 3,
        0, 4, 6, 0, 6, 2,  # x = 0
        1, 3, 7, 1, 7, 5,
    ],
    "<u4",
)  # fmt: skip
"""Corners x + 2 y + 4 z, counter-clockwise from outside."""


class Decals:
    """A scene's decals on the device. ``voxels``: what colours voxels; None without decals."""

    def __init__(self, device: Device, scene: Scene, meshes: GpuScene) -> None:
        self._scene, self._meshes = scene, meshes
        self.voxels: DecalVoxels | None = None
        self._buffers: list[Buffer] = []
        self._seen: bytes | None = None
        if not scene.decals:
            return
        self._order = np.array(draw_order(scene), "<u4")
        self._low, self._high = decal_boxes(scene)
        self._used = sorted({decal.material for decal in scene.decals})
        self._worn: list[Material] = []
        self._shown: list[int] = []
        self._runs: list[DecalRun] = []

        def upload(name: str, values: Array, dynamic: bool = False) -> Buffer:
            made = device.buffer(f"decals.{name}", values, category="meshes", dynamic=dynamic)
            self._buffers.append(made)
            return made

        self._rows = upload("rows", pack_decals(scene))
        self._visible = upload("visible", self._order, dynamic=True)
        commands = np.zeros(len(self._order), DRAW_COMMAND)
        self._commands = upload("draws", commands, dynamic=True)
        layout = [(self._visible, "1u/i", ("a_decal",))]
        self._vertices = device.vertex_input(layout, upload("indices", CUBE))
        if any(VOXEL_CHANNELS & {*decal.channels} for decal in scene.decals):
            self.voxels = DecalVoxels(device, scene, meshes, self._rows)

    def draw(self, g: Graph, view: Block, gb: GBuffer) -> None:
        """Blend what the camera sees of the decals into the G-buffer, the lowest order first."""
        if not self._scene.decals:
            return
        shown = self._look(np.asarray(view["clip_from_world"]).T)
        if not shown:
            return
        meshes = self._meshes
        receivers = g.texture("decal.receivers", size=gb.depth.size, format=RG32UI)
        surface: dict[str, Ref] = {
            "u_depth": gb.depth, "u_gbuffer_a": gb.a, "u_gbuffer_c": gb.c,
        }  # fmt: skip
        g.compute(
            RECEIVERS,
            reads=surface,
            writes={"o_receivers": receivers},
            params={"View": view},
            threads=gb.depth.size,
        )
        for shader, same in groupby(shown, lambda shown: _program(self._runs[shown])):
            numbers = list(same)
            batches = [self._runs[number].batch for number in numbers]

            def encode(enc: Encoder, numbers: list[int] = numbers) -> None:
                runs = [self._runs[number].batch for number in numbers]
                for number, _ in zip(numbers, meshes.textured(enc, runs), strict=True):
                    enc.draw_indirect(self._vertices, self._commands, 1, number)

            g.raster(
                shader,
                color=[gb.scene_color, gb.a, gb.b, gb.c, gb.d],
                depth=gb.depth,
                reads={
                    "u_receivers": receivers,
                    "Decals": self._rows,
                    "u_decals": self._rows,
                    **meshes.materials.reads(),
                },
                writes=meshes.materials.writes(batches),
                params={"View": view, **meshes.params()},
                state=STATE,
                draw=encode,
            )

    def _look(self, clip_from_world: Array) -> list[int]:
        """Runs of which the camera sees anything; their draws are up to date."""
        worn = [self._scene.materials[number] for number in self._used]
        if list(map(id, worn)) != list(map(id, self._worn)):  # replaced, not changed
            self._worn, self._seen = worn, None
            self._runs = runs_of(self._scene, self._order.tolist())
            self._meshes.hold_textures([run.batch for run in self._runs])
        key = clip_from_world.tobytes()
        if key != self._seen:
            self._seen = key
            seen = in_frustum(clip_from_world, self._low, self._high)[self._order]
            counts = [int(seen[r.first : r.first + r.count].sum()) for r in self._runs]
            commands = np.zeros(len(self._runs), DRAW_COMMAND)
            commands["count"], commands["instance_count"] = len(CUBE), counts
            commands["base_instance"] = np.cumsum([0, *counts])[:-1]
            self._visible.write(np.concatenate([self._order[seen], self._order[~seen]]))
            self._commands.write(commands)
            self._shown = [number for number, count in enumerate(counts) if count]
        return self._shown

    def release(self) -> None:
        """Free everything."""
        if self.voxels is not None:
            self.voxels.release()
        if self._buffers:
            self._vertices.release()
        for buffer in self._buffers:
            buffer.release()


def _program(run: DecalRun) -> Raster:
    return material_shader(VERT, FRAG, run.batch)
