"""Runs a GLSL function of glsl/ on arrays: the expression is wrapped in a compute shader."""

from __future__ import annotations

import hashlib
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.gpu.device import Device
from elemental.gpu.refs import Ref
from elemental.gpu.shaders import Compute

_folder = tempfile.TemporaryDirectory(prefix="glsl-harness-")
_SCALARS = {"float": "f4", "int": "i4", "uint": "u4", "bool": "u4"}
_PREFIX = {"float": "", "int": "i", "uint": "u", "bool": "b"}
_TYPE = re.compile(r"^(?:(float|int|uint|bool)|([iub]?)vec([234]))$")


def run_glsl(
    device: Device,
    includes: Sequence[str],
    body: str,
    inputs: Mapping[str, npt.ArrayLike] | None = None,
    output: str = "float",
    *,
    count: int | None = None,
    functions: str = "",
    reads: Mapping[str, Ref] | None = None,
    params: Mapping[str, npt.NDArray[np.void]] | None = None,
    defines: Mapping[str, int | float | bool | str] | None = None,
) -> npt.NDArray[Any]:
    """``body`` for each row of ``inputs``; returns (N,) or (N, components) of GLSL type ``output``.

    ``body`` is an expression, or statements that assign ``result``; ``index`` is the row. Inputs
    are (N,) scalars, (N, k) vectors or (N, k, k) matrices given as M with p' = M @ p; floats,
    integers and booleans by their dtype. ``reads`` and ``params`` bind what the includes declare.
    ``functions`` is GLSL at file scope.
    """
    arrays = {name: _plain(np.asarray(value)) for name, value in (inputs or {}).items()}
    sizes = {len(array) for array in arrays.values()} | ({count} if count else set())
    if len(sizes) != 1:
        raise ValueError(f"inputs have {sorted(sizes)} rows")
    rows = sizes.pop()
    scalar, lanes = _output(output)
    lines = ["layout(local_size_x = 64) in;"]
    lines += [f'#include "{name}"' for name in includes]
    lines += [f"layout(std430) readonly buffer In_{n} {{ {_scalar(a)} in_{n}[]; }};"
              for n, a in arrays.items()]  # fmt: skip
    stored = "uint" if scalar == "bool" else scalar
    lines += [f"layout(std430) writeonly buffer Result {{ {stored} out_result[]; }};", functions]
    lines += ["void main() {", "int index = int(gl_GlobalInvocationID.x);"]
    lines += [f"if (index >= {rows}) return;"]
    lines += [_fetch(name, array) for name, array in arrays.items()]
    statements = body if ";" in body else f"result = {body};"
    lines += [f"{output} result;", statements]
    for lane in range(lanes):
        part = "result" if lanes == 1 else f"result[{lane}]"
        lines.append(f"out_result[index * {lanes} + {lane}] = {stored}({part});")
    lines.append("}")
    text = "\n".join(lines) + "\n"
    path = Path(_folder.name) / f"{hashlib.sha1(text.encode()).hexdigest()}.comp.glsl"
    path.write_text(text)
    buffers = {f"In_{n}": device.buffer(n, a) for n, a in arrays.items()}
    result = device.buffer("result", rows * lanes * 4)
    graph = device.begin_frame()
    graph.compute(
        Compute(path, defines),
        reads={**buffers, **(reads or {})},
        writes={"Result": result},
        params=params,
        threads=rows,
    )
    graph.execute()
    values = result.read(_SCALARS[scalar]).reshape((rows, lanes) if lanes > 1 else (rows,)).copy()
    for buffer in (*buffers.values(), result):
        buffer.release()
    return values.astype(bool) if scalar == "bool" else values


def _plain(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    kinds = {"f": np.float32, "i": np.int32, "u": np.uint32, "b": np.uint32}
    return np.ascontiguousarray(array, kinds[array.dtype.kind])


def _scalar(array: npt.NDArray[Any]) -> str:
    return {"f": "float", "i": "int", "u": "uint"}[array.dtype.kind]


def _fetch(name: str, array: npt.NDArray[Any]) -> str:
    scalar = _scalar(array)
    if array.ndim == 1:
        return f"{scalar} {name} = in_{name}[index];"
    lanes = int(np.prod(array.shape[1:]))
    values = [f"in_{name}[index * {lanes} + {lane}]" for lane in range(lanes)]
    if array.ndim == 2:
        kind = f"{_PREFIX[scalar]}vec{lanes}"
        return f"{kind} {name} = {kind}({', '.join(values)});"
    side = array.shape[1]
    return f"mat{side} {name} = transpose(mat{side}({', '.join(values)}));"


def _output(output: str) -> tuple[str, int]:
    match = _TYPE.match(output)
    if not match:
        raise ValueError(f"output {output!r} is no scalar or vector")
    if match[1]:
        return match[1], 1
    return {"": "float", "i": "int", "u": "uint", "b": "bool"}[match[2]], int(match[3])
