"""A scene's materials on the device: their rows, and the artist's code behind them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cache

import numpy as np

from elemental.core.layout import Block, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.gpu.refs import Ref, Unordered
from elemental.gpu.shaders import Compute, Define, Raster
from elemental.passes import material_pack, material_snippets
from elemental.passes.material_snippets import MaterialSnippet
from elemental.passes.scene_pack import Batch
from elemental.scene.definitions import MaterialDefinition
from elemental.scene.model import Material, Scene


class MaterialTable:
    """The storage block Materials, and the definitions in use.

    The definitions that the scene's materials name are registered with the shader library, which
    reloads them; `follow` then takes over what became of their parameters.
    """

    def __init__(self, device: Device, scene: Scene) -> None:
        self._device, self._scene = device, scene
        self._revisions: dict[str, int] = {}
        for number, material in enumerate(scene.materials):
            scene.materials[number] = self._adopt(material)
        packed = material_pack.pack_materials(scene.materials)
        self.rows = device.buffer("scene.materials", packed, category="meshes", dynamic=True)
        none = np.zeros(max(len(packed), 1), "<u4")
        self._faults = device.buffer("scene.material_faults", none, "meshes", dynamic=True)
        self._faulty = none
        self._time_s = 0.0
        self.version = 0
        """Differs where any material looks otherwise, set or with time."""
        self._block = self._pack_frame()
        self._sort_out()

    def _sort_out(self) -> None:
        """Find out once what frames ask of all materials."""
        definitions = [material.definition for material in self._scene.materials]
        self._ticking = [n for n, definition in enumerate(definitions) if definition.animated]
        self._may_fail = any(definition.may_fail for definition in definitions)
        asked = (definition.lighting_models for definition in definitions)
        self.lighting_models = frozenset[str]().union(*asked)
        """The lighting models beyond the default one that any of them asks for."""

    def _adopt(self, material: Material) -> Material:
        """The material by the definition that the library has of its file."""
        library, key = self._device.library, material.definition.key
        library.add_snippet(key, MaterialSnippet(material.definition))
        snippet = self._snippet(key)
        self._revisions[key] = snippet.revision
        if snippet.definition == material.definition:
            return material
        return material.with_definition(snippet.definition)

    def _snippet(self, key: str) -> MaterialSnippet:
        snippet = self._device.library.snippet(key)
        assert isinstance(snippet, MaterialSnippet), "keys of definitions are their files"
        return snippet

    def _pack_frame(self) -> Block:
        return pack(layouts().block("MaterialFrame"), time_s=np.float32(self._time_s))

    def set(self, index: int, material: Material) -> None:
        """Replace a material, here and in the scene."""
        self.version += 1
        self._scene.materials[index] = self._adopt(material)
        packed = material_pack.pack_materials(self._scene.materials[index : index + 1])
        self.rows.write(packed.tobytes(), index * packed.nbytes)
        self._sort_out()
        self._faults.write(np.zeros(1, "<u4"), index * 4)
        self._faulty = np.where(np.arange(len(self._faulty)) == index, 0, self._faulty)

    def is_animated(self, index: int) -> bool:
        """Whether a material changes with time."""
        return self._scene.materials[index].definition.animated

    def follow(self, time_s: float) -> tuple[list[int], list[int]]:
        """Take over the time of a frame: materials that (look otherwise at it, were edited)."""
        passing: list[int] = []
        if time_s != self._time_s:
            self._time_s = time_s
            self._block = self._pack_frame()
            passing = list(self._ticking)
            self.version += bool(passing)
        stale = [k for k, seen in self._revisions.items() if self._snippet(k).revision != seen]
        if not stale:
            return passing, []
        edited = [n for n, m in enumerate(self._scene.materials) if m.definition.key in stale]
        for index in edited:
            self.set(index, self._scene.materials[index])
        return passing, edited

    def reads(self) -> dict[str, Ref]:
        """What lib/material.glsl reads, but for textures."""
        return {"Materials": self.rows}

    def writes(self, batches: Sequence[Batch]) -> dict[str, Ref]:
        """What the programs of batches of one definition write beside their targets."""
        fails = bool(batches) and batches[0].definition.may_fail
        return {"MaterialFaults": Unordered(self._faults)} if fails else {}

    def params(self) -> dict[str, Block]:
        """The uniform blocks of lib/material.glsl."""
        return {"MaterialFrame": self._block}

    def watch_faults(self, g: Graph) -> None:
        """Have the frame tell, some frames later, which materials wrote what is no number."""
        if self._may_fail:
            g.read_later(self._faults, self._told)

    def _told(self, raw: bytes) -> None:
        self._faulty = np.frombuffer(raw, "<u4")

    def faults(self) -> list[str]:
        """A line for each material that wrote infinities or what is no number, as far as is known.

        Such pixels show the magenta checker.
        """
        materials = self._scene.materials
        faulty: list[int] = np.flatnonzero(self._faulty[: len(materials)]).tolist()
        return [
            f"{material_snippets.label(materials[n].definition.file)}: material "
            f"{materials[n].name!r}: writes what is no finite number"
            for n in faulty
        ]

    def release(self) -> None:
        """Free the buffers."""
        self.rows.release()
        self._faults.release()


def models_mask(lighting_models: Collection[str]) -> int:
    """LIGHTING_MODELS of a shader that has to know these beside unlit and default."""
    names = ("unlit", "default", *lighting_models)
    return sum(1 << int(layouts().constant(f"LIGHTING_{name.upper()}")) for name in names)


def material_shader(
    vert: str,
    frag: str,
    batch: Batch,
    defines: Mapping[str, int] | None = None,
    *,
    texture_mask: int | None = None,
    uv_transforms: bool | None = None,
) -> Raster:
    """A program whose fragments evaluate a batch's material: frag includes lib/material.glsl.

    Its pass takes `GpuScene.reads()`, `params()` and `materials.writes([batch])`, and draws by
    `GpuScene.draw`. ``defines`` come on top of the material's; ``texture_mask``
    and ``uv_transforms`` replace the batch's own.
    """
    mask = batch.texture_mask if texture_mask is None else texture_mask
    transforms = batch.uv_transforms if uv_transforms is None else uv_transforms
    more = tuple(defines.items()) if defines else ()
    return _shader(vert, frag, batch.definition, mask, transforms, more)


def material_compute(path: str, batch: Batch, defines: Mapping[str, int] | None = None) -> Compute:
    """The same of a compute shader, which takes its textures by `GpuScene.texture_reads`."""
    more = tuple(defines.items()) if defines else ()
    return _compute(path, batch.definition, batch.texture_mask, batch.uv_transforms, more)


@cache
def _shader(
    vert: str,
    frag: str,
    definition: MaterialDefinition,
    texture_mask: int,
    uv_transforms: bool,
    more: tuple[tuple[str, int], ...],
) -> Raster:
    defines = _defines(definition, texture_mask, uv_transforms, more)
    return Raster(vert, frag, defines=defines, snippets={material_snippets.NAME: definition.key})


@cache
def _compute(
    path: str,
    definition: MaterialDefinition,
    texture_mask: int,
    uv_transforms: bool,
    more: tuple[tuple[str, int], ...],
) -> Compute:
    defines = _defines(definition, texture_mask, uv_transforms, more)
    return Compute(path, defines=defines, snippets={material_snippets.NAME: definition.key})


def _defines(
    definition: MaterialDefinition,
    texture_mask: int,
    uv_transforms: bool,
    more: tuple[tuple[str, int], ...],
) -> dict[str, Define]:
    return {
        "MATERIAL_TEXTURES": texture_mask,
        "MATERIAL_UV_TRANSFORMS": int(uv_transforms),
        "MATERIAL_FAULTS": int(definition.may_fail),
        "LIGHTING_MODELS": models_mask(definition.lighting_models),
        **dict(more),
    }
