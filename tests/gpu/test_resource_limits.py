"""No program needs more resources than any driver of OpenGL 4.3 has, in each of its stages."""

from __future__ import annotations

from collections import Counter

from elemental.gpu.device import Device
from elemental.gpu.program import IMAGE, SAMPLER, STORAGE_BLOCK, UNIFORM_BLOCK
from elemental.gpu.shaders import declared_resources, flatten
from lint_shaders import described_programs

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


def test_textures_are_made_on_a_unit_that_no_stage_reaches(device: Device) -> None:
    assert device.scratch_unit >= LEAST["vertex"][SAMPLER] + LEAST["fragment"][SAMPLER]
