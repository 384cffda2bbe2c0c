"""Every struct and block of glsl/shared: our offsets against the driver's own."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.core.layout import Layouts, layouts, pack
from elemental.gpu.device import Device
from elemental.gpu.program import buffer_variables
from elemental.gpu.shaders import flatten
from gpu.sources import Sources

AWKWARD = """
struct Inner { vec3 axis; float tail; mat2 turn; };
struct Awkward {
    float head;
    vec3 p[2];
    mat3 basis;
    Inner inner[3];
    uvec2 pair;
    bool flag;
    mat4x3 pose;
    float weights[5];
    vec2 q[3];
    Inner last;
};
layout(std140) uniform Uneasy {
    float head;
    vec3 p[2];
    mat3 basis;
    Inner inner[3];
    ivec2 pair;
    mat2 turns;
    float weights[5];
    vec2 q[3];
    Inner last;
    bool flag;
} u_uneasy;
"""


def _leaves(dtype: np.dtype[Any], prefix: str, base: int) -> dict[str, tuple[int, int]]:
    """GLSL name -> (offset, array stride or 0) of every member that the driver reports."""
    found: dict[str, tuple[int, int]] = {}
    for name in dtype.names or ():
        kind, offset = dtype.fields[name][:2]  # type: ignore[index]
        laid = dtype.metadata["members"][name]  # type: ignore[index]
        element = kind.subdtype[0] if kind.subdtype else kind
        if element.names:
            for index in range(laid.shape[0] if laid.array else 1):
                place = f"{prefix}{name}[{index}]." if laid.array else f"{prefix}{name}."
                found |= _leaves(element, place, base + offset + index * element.itemsize)
        elif laid.array:
            found[f"{prefix}{name}[0]"] = (base + offset, kind.itemsize // laid.shape[0])
        else:
            found[f"{prefix}{name}"] = (base + offset, 0)
    return found


def _compare(found: dict[str, dict[str, int]], wanted: dict[str, tuple[int, int]]) -> None:
    assert found.keys() == wanted.keys()
    for name, (offset, stride) in wanted.items():
        assert found[name]["offset"] == offset, name
        assert not stride or found[name]["array_stride"] == stride, name


def _check_struct(device: Device, sources: Sources, known: Layouts, name: str) -> None:
    dtype = known.struct(name)
    shader = sources.compute(
        f"{name} one = probe[0]; probe[1] = one;",
        f'#include "{known.files[name]}"\nlayout(std430) buffer Probe {{ {name} probe[]; }};',
    )
    reported = buffer_variables(device, device.program(shader), uniform=False)
    found = {key: value for key, value in reported.items() if key.startswith("probe[")}
    assert {value["top_level_array_stride"] for value in found.values()} == {dtype.itemsize}
    _compare(found, _leaves(dtype, "probe[0].", 0))


def _check_block(device: Device, sources: Sources, known: Layouts, name: str) -> None:
    dtype = known.block(name)
    assert dtype.names
    text = flatten(str(known.files[name])).text
    instance = re.search(rf"uniform\s+{name}\s*\{{[^}}]*\}}\s*(\w*)", text)
    assert instance
    first = f"{instance[1]}.{dtype.names[0]}" if instance[1] else dtype.names[0]
    depth = len(dtype.metadata["members"][dtype.names[0]].shape)  # type: ignore[index]
    shader = sources.compute(
        f"result = float({first}{'[0]' * depth});",
        f'#include "{known.files[name]}"\nlayout(std430) buffer Result {{ float result; }};',
    )
    program = device.program(shader)
    assert -(-program.slots[name].size // 16) * 16 == dtype.itemsize
    prefix = f"{name}." if instance[1] else ""
    reported = buffer_variables(device, program, uniform=True)
    _compare(
        {key: value for key, value in reported.items() if value["offset"] >= 0},
        _leaves(dtype, prefix, 0),
    )


@pytest.mark.parametrize("name", layouts().structs)
def test_struct_in_a_buffer(device: Device, sources: Sources, name: str) -> None:
    _check_struct(device, sources, layouts(), name)


@pytest.mark.parametrize("name", [n for n, kind in layouts().blocks.items() if kind == "uniform"])
def test_uniform_block(device: Device, sources: Sources, name: str) -> None:
    _check_block(device, sources, layouts(), name)


def test_awkward_types(device: Device, sources: Sources, tmp_path: Path) -> None:
    folder = tmp_path / "awkward"
    folder.mkdir()
    (folder / "awkward.glsl").write_text(AWKWARD)
    known = Layouts(folder)
    for name in known.structs:
        _check_struct(device, sources, known, name)
    _check_block(device, sources, known, "Uneasy")


def test_packed_values_arrive(device: Device, sources: Sources, tmp_path: Path) -> None:
    folder = tmp_path / "awkward"
    folder.mkdir()
    (folder / "awkward.glsl").write_text(AWKWARD)
    known = Layouts(folder)
    inner = pack(known.struct("Inner", "std140"), axis=[1, 2, 3], tail=4, turn=[[5, 6], [7, 8]])
    block = pack(
        known.block("Uneasy"), head=9, p=[[1, 2, 3], [4, 5, 6]], basis=np.arange(9).reshape(3, 3),
        inner=np.stack([inner] * 3), pair=[-1, -2], turns=[[1, 2], [3, 4]], weights=range(5),
        q=[[0, 1], [2, 3], [4, 5]], last=inner, flag=True,
    )  # fmt: skip
    shader = sources.compute(
        """
        vec3 turned = u_uneasy.basis * u_uneasy.p[1];
        vec2 spun = u_uneasy.inner[2].turn * u_uneasy.q[2];
        float[] all = float[](turned.x, turned.y, turned.z, spun.x, spun.y, u_uneasy.weights[4],
            float(u_uneasy.pair.y), u_uneasy.last.tail, u_uneasy.flag ? 1.0 : 0.0, u_uneasy.head);
        for (int i = 0; i < 10; ++i) result[i] = all[i];
        """,
        f'#include "{known.files["Uneasy"]}"\n'
        "layout(std430) buffer Result { float result[10]; };",
        local=(1, 1, 1),
    )
    result = device.buffer("result", 40)
    graph = device.begin_frame()
    graph.compute(shader, writes={"Result": result}, params={"Uneasy": block}, groups=1)
    graph.execute()
    turned = np.arange(9).reshape(3, 3) @ [4, 5, 6]
    spun = np.array([[5, 6], [7, 8]]) @ [4, 5]
    np.testing.assert_array_equal(result.read(np.float32), [*turned, *spun, 4, -2, 4, 1, 9])
    result.release()
