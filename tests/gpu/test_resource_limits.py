"""No program needs more resources than any driver of OpenGL 4.3 has."""

from __future__ import annotations

from collections import Counter

from elemental.gpu.device import Device
from elemental.gpu.program import IMAGE, SAMPLER, STORAGE_BLOCK, UNIFORM_BLOCK
from lint_shaders import described_programs

LIMITS = {STORAGE_BLOCK: 8, SAMPLER: 16, IMAGE: 8, UNIFORM_BLOCK: 12}
"""Least MAX_COMBINED_SHADER_STORAGE_BLOCKS, and least of the others in a fragment or compute
shader [GL 4.3, tables 23.57 to 23.65]; looked at for all stages of a program together."""


def test_no_program_exceeds_what_every_driver_has(device: Device) -> None:
    programs = described_programs()
    assert len(programs) > 100
    over, most = [], Counter[str]()
    for shader in programs:
        used = Counter[str]()
        for slot in device.program(shader).slots.values():
            used[slot.kind] += slot.count if slot.active else 0
        over += [f"{shader!r}: {used[k]} {k}s" for k, limit in LIMITS.items() if used[k] > limit]
        most |= used
    assert not over
    assert all(most[kind] > 0 for kind in LIMITS), "nothing was counted"
