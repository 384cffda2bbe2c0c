"""Decals on the fragment queue of the voxelization, so that bounced light knows of them.

[Mittring12 "Voxel Lighting Pipeline": shader evaluates artist defined material, output: fragment
queue]; the talk's decals stop at the G-buffer.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import AnyBuffer
from elemental.gpu.resources import Buffer
from elemental.passes.decal_pack import Array, DecalRun, decal_boxes, draw_order, runs_of
from elemental.passes.material_table import material_compute
from elemental.passes.scene_gpu import GpuScene
from elemental.passes.voxel.build import state_offset
from elemental.passes.voxel.octree import Survey
from elemental.scene.model import AlphaMode, Material, Scene

SHADER = "decal/paint.comp.glsl"
SIDE = int(layouts().constant("DECAL_CELLS_A_SIDE"))
ALPHA_MODES: tuple[AlphaMode, ...] = ("opaque", "mask", "blend")
VOXEL_CHANNELS = frozenset({"color", "emission"})
"""Of a decal's CHANNELS: voxels hold colour and emission alone."""


class DecalVoxels:
    """What `paint` needs of a scene's decals; ``rows`` are those of `Decals`.

    Decals stand where they are: the cells are filled once for each width of voxels.
    """

    def __init__(self, device: Device, scene: Scene, meshes: GpuScene, rows: Buffer) -> None:
        self._device, self._scene, self._meshes, self._rows = device, scene, meshes, rows
        self._order = [n for n in draw_order(scene) if VOXEL_CHANNELS & {*scene.decals[n].channels}]
        self._used = sorted({scene.decals[number].material for number in self._order})
        self._worn: list[Material] = []
        self._runs: list[DecalRun] = []
        self._voxel_m = 0.0
        self._words: Buffer | None = None
        self._blocks: list[Block] = []

    def changed(self) -> bool:
        """Whether materials are others than those of the last `paint`."""
        return bool(self._worn) and list(map(id, self._materials())) != list(map(id, self._worn))

    def _materials(self) -> list[Material]:
        return [self._scene.materials[number] for number in self._used]

    def paint(self, g: Graph, octree: Survey, fragments: AnyBuffer, *, moving: bool) -> None:
        """Colour the queue's fragments, the lowest order first; `moving`: those of what can move.

        Behind the pass that counts them.
        """
        meshes = self._meshes
        if moving:
            batches = meshes.batches(ALPHA_MODES, dynamic=True)
            if not any(batch.receives_decals for batch in batches):
                return
        if not self._worn or self.changed():
            self._worn = self._materials()
            self._runs = runs_of(self._scene, self._order)
            meshes.hold_textures([run.batch for run in self._runs])
        if octree.grid.voxel_m != self._voxel_m:
            self._fill_cells(octree.grid.voxel_m)
        assert self._words is not None
        args = "moving_fragments" if moving else "fragments"
        for run, block in zip(self._runs, self._blocks, strict=True):
            batch = run.batch
            g.compute(
                material_compute(SHADER, batch, {"MOVING": int(moving)}),
                f"decal.paint.{batch.definition.name}",
                reads={
                    "State": octree.state,
                    "Decals": self._rows,
                    "DecalCells": self._words,
                    **meshes.materials.reads(),
                    **meshes.texture_reads(batch),
                },
                writes={"Fragments": fragments, **meshes.materials.writes([batch])},
                params={**octree.params, **meshes.params(), "DecalPaint": block},
                indirect=(octree.state, state_offset(args)),
            )

    def _fill_cells(self, voxel_m: float) -> None:
        """Sort the decals of each run into the cells that they colour voxels of this width in."""
        self.release()
        self._voxel_m = voxel_m
        low, high = decal_boxes(self._scene)
        low, high = low - voxel_m, high + voxel_m
        origin = low[self._order].min(axis=0)
        cells_a_metre = SIDE / (high[self._order].max(axis=0) - origin)
        first = np.floor((low - origin) * cells_a_metre).astype(int).clip(0, SIDE - 1)
        last = np.floor((high - origin) * cells_a_metre).astype(int).clip(0, SIDE - 1)
        words: list[Array] = []
        self._blocks.clear()
        for run in self._runs:
            numbers = self._order[run.first : run.first + run.count]
            first_word = sum(map(len, words))
            words.append(cell_lists(numbers, first, last, first_word))
            block = pack(
                layouts().block("DecalPaint"),
                low_ws=origin,
                cells_a_metre=cells_a_metre,
                first_word=first_word,
            )
            self._blocks.append(block)
        self._words = self._device.buffer("decals.cells", np.concatenate(words), category="meshes")

    def release(self) -> None:
        """Free the cells."""
        if self._words is not None:
            self._words.release()
            self._words = None


def cell_lists(numbers: Sequence[int], first: Array, last: Array, first_word: int) -> Array:
    """DecalCells of one run, whose words begin at `first_word`: where each cell's list begins, x
    fastest, the end of all, then the lists, decals in their order. first, last (decals, 3) int."""
    cells, entries = [np.zeros(0, int)], [np.zeros(0, int)]
    for number in numbers:
        x, y, z = (np.arange(a, b + 1) for a, b in zip(first[number], last[number], strict=True))
        covered = ((z[:, None, None] * SIDE + y[:, None]) * SIDE + x).ravel()
        cells.append(covered)
        entries.append(np.full(len(covered), number))
    flat = np.concatenate(cells)
    counts = np.bincount(flat, minlength=SIDE**3)
    starts = first_word + SIDE**3 + 1 + np.cumsum([0, *counts])
    lists = np.concatenate(entries)[np.argsort(flat, kind="stable")]
    return np.concatenate([starts, lists]).astype("<u4")
