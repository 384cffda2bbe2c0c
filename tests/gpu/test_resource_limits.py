"""No program needs more resources than any driver of OpenGL 4.3 has, in each of its stages."""

from __future__ import annotations

from collections import Counter

import pytest

from elemental.gpu import gl as c
from elemental.gpu.device import Device
from elemental.gpu.info import OUTPUT_RESOURCES, check_limits
from elemental.gpu.program import IMAGE, SAMPLER, STORAGE_BLOCK, UNIFORM_BLOCK, resources
from elemental.gpu.shaders import Raster, declared_resources, flatten
from lint_shaders import described_programs

MAT4 = 0x8B5C
"""GL's name of an attribute's type."""
LEAST = {
    "vertex": {STORAGE_BLOCK: 0, SAMPLER: 16, IMAGE: 0, UNIFORM_BLOCK: 12},
    "geometry": {STORAGE_BLOCK: 0, SAMPLER: 16, IMAGE: 0, UNIFORM_BLOCK: 12},
    "fragment": {STORAGE_BLOCK: 8, SAMPLER: 16, IMAGE: 8, UNIFORM_BLOCK: 12},
    "compute": {STORAGE_BLOCK: 8, SAMPLER: 16, IMAGE: 8, UNIFORM_BLOCK: 12},
}
"""Of each stage [GL 4.3, tables 23.52 to 23.65]. All stages together may have as many textures and
uniform blocks as these add up to, and 8 storage blocks, which only a program's last stage has."""


def test_no_stage_exceeds_what_every_driver_has(device: Device) -> None:
    programs = described_programs()
    assert len(programs) > 100
    over, most = [], Counter[tuple[str, str]]()
    for shader in programs:
        slots = device.program(shader).slots
        for stage, path in shader.stages:
            used = Counter[str]()
            for name in declared_resources(flatten(path, shader.defines, device.shader_root).text):
                used[slots[name].kind] += slots[name].count if slots[name].active else 0
            over += [
                f"{shader!r}: {used[kind]} {kind}s in the {stage} shader"
                for kind, limit in LEAST[stage].items()
                if used[kind] > limit
            ]
            most |= Counter({(stage, kind): count for kind, count in used.items()})
    assert not over
    counted = [("vertex", SAMPLER), ("fragment", STORAGE_BLOCK), ("compute", IMAGE)]
    assert all(most[place] > 0 for place in counted), most


def test_no_program_writes_to_more_than_is_asked_of_a_driver(device: Device) -> None:
    most = 0
    for shader in described_programs():
        program = device.program(shader)
        written = [s for s in program.slots.values() if s.kind in (STORAGE_BLOCK, IMAGE)]
        targets = len(resources(device, program.mgl.glo, c.PROGRAM_OUTPUT, (c.PROP_TYPE,)))
        targets *= isinstance(shader, Raster)
        most = max(most, sum(slot.count for slot in written if slot.active) + targets)
    assert most == OUTPUT_RESOURCES


def test_a_driver_that_has_less_is_told_so_at_once(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device.gl, "integer", lambda _: 8)
    with pytest.raises(RuntimeError, match=r"8 storage blocks and images together .*; 10 are"):
        check_limits(device.gl)


def test_uniform_blocks_and_vertices_keep_to_what_every_driver_has(device: Device) -> None:
    """16 KiB a block, 16 attributes of four numbers [GL 4.3, tables 23.53 and 23.60]."""
    for shader in described_programs():
        program = device.program(shader)
        blocks = [slot.size for slot in program.slots.values() if slot.kind == UNIFORM_BLOCK]
        assert max(blocks, default=0) <= 16384
        if isinstance(shader, Raster):
            wanted = (c.PROP_TYPE, c.PROP_LOCATION)
            found = resources(device, program.mgl.glo, c.PROGRAM_INPUT, wanted)
            columns = [4 if kind == MAT4 else 1 for _, (kind, place) in found if place >= 0]
            assert sum(columns) <= 16, shader


def test_textures_are_made_on_a_unit_that_no_stage_reaches(device: Device) -> None:
    slots = [s for shader in described_programs() for s in device.program(shader).slots.values()]
    ends = [s.unit + s.count for s in slots if s.kind == SAMPLER and s.active]
    assert 0 < max(ends) <= device.scratch_unit
