"""Structs, blocks and constants of ``glsl/shared/*.glsl`` as numpy dtypes and numbers.

The GLSL files are the only place where a layout is written down; Python reads it from there by the
std140 rules (uniform blocks) and the std430 rules (buffers) [GL 4.3, 7.6.2.2]. A test compares each
offset with the driver's own reflection.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping, Set
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from elemental.core.paths import glsl_root

Block: TypeAlias = npt.NDArray[np.void]
"""A packed uniform block or struct: a 0-d structured array, as `pack` makes it."""

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
_CONSTANT = re.compile(
    r"\bconst\s+(?P<type>float|int|uint)\s+(?P<name>\w+)\s*=\s*(?P<value>[^;]+);"
    r"|^[ \t]*#[ \t]*define[ \t]+(?P<macro>\w+)[ \t]+(?P<text>[^\n]+)$",
    re.M,
)
_STRUCT = re.compile(r"\bstruct\s+(?P<name>\w+)\s*\{(?P<body>[^}]*)\}\s*;")
_BLOCK = re.compile(
    r"(?:layout\s*\((?P<layout>[^)]*)\)\s*)?(?:\b(?:readonly|writeonly|coherent|restrict)\s+)*"
    r"\b(?P<kind>uniform|buffer)\s+(?P<name>\w+)\s*\{(?P<body>[^}]*)\}"
)
_SCALARS = {"float": "<f4", "int": "<i4", "uint": "<u4", "bool": "<u4"}
_VECTOR = re.compile(r"^(?P<kind>[iub]?)vec(?P<size>[234])$")
_MATRIX = re.compile(r"^mat(?P<columns>[234])(?:x(?P<rows>[234]))?$")
_VECTOR_SCALARS = {"": "<f4", "i": "<i4", "u": "<u4", "b": "<u4"}


class Member(NamedTuple):
    """A member of a struct or block as written."""

    type: str
    name: str
    extent: int | None
    """Elements of an array; 0: runtime sized; None: no array."""


class _Laid(NamedTuple):
    """One type under one rule."""

    align: int
    size: int
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    """Shape that is stored, after padding to lanes."""
    given: tuple[int, ...]
    """Shape that a caller gives; for a matrix (rows, columns)."""
    matrix: bool = False
    array: bool = False
    padded: bool = False
    """Whether lanes are stored that nobody gives."""


class Layouts:
    """What the files of one folder declare. Raises ValueError for what it can't parse."""

    def __init__(self, folder: Path) -> None:
        self._structs: dict[str, list[Member]] = {}
        self._blocks: dict[str, tuple[str, list[Member]]] = {}
        self._constants: dict[str, int | float] = {}
        self._done: dict[tuple[str, str], np.dtype[np.void]] = {}
        self._done_blocks: dict[str, np.dtype[np.void]] = {}
        self.files: dict[str, Path] = {}
        """File of each struct and block."""
        files = sorted(folder.glob("*.glsl"))
        texts = [(file, _COMMENT.sub(" ", file.read_text())) for file in files]
        self._read_constants("\n".join(text for _, text in texts))
        for file, text in texts:
            for match in _STRUCT.finditer(text):
                self._structs[match["name"]] = self._members(match["body"], file)
                self.files[match["name"]] = file
            for match in _BLOCK.finditer(text):
                rule = "std430" if match["kind"] == "buffer" else "std140"
                if rule not in (match["layout"] or ""):
                    raise ValueError(f"{file}: block {match['name']} needs layout({rule})")
                self._blocks[match["name"]] = (rule, self._members(match["body"], file))
                self.files[match["name"]] = file

    def block(self, name: str) -> np.dtype[np.void]:
        """Layout of a uniform block (std140) or of a buffer block's fixed members (std430)."""
        known = self._done_blocks.get(name)
        if known is None:
            rule, members = self._blocks[name]
            known = self._done_blocks[name] = self._record(f"block {name}", members, rule).dtype
        return known

    def struct(self, name: str, rule: str = "std430") -> np.dtype[np.void]:
        """Layout of a struct as an element of a buffer."""
        known = self._done.get((name, rule))
        if known is None:
            known = self._record(name, self._structs[name], rule).dtype
        return known

    def constant(self, name: str) -> int | float:
        """Value of a ``const`` scalar or of a ``#define``."""
        return self._constants[name]

    @property
    def structs(self) -> list[str]:
        """Names of all structs."""
        return list(self._structs)

    @property
    def blocks(self) -> dict[str, str]:
        """Name and kind (uniform or buffer) of all blocks."""
        kinds = {"std140": "uniform", "std430": "buffer"}
        return {name: kinds[rule] for name, (rule, _) in self._blocks.items()}

    def _read_constants(self, text: str) -> None:
        pending = []
        for match in _CONSTANT.finditer(text):
            name, expression = match["name"], match["value"]
            if name is None:
                name, expression = match["macro"], match["text"]
            pending.append((name, expression, match["type"] == "float"))
        while pending:
            left = []
            for name, expression, is_float in pending:
                try:
                    value = _evaluate(expression, self._constants)
                except (SyntaxError, KeyError, TypeError, ValueError):
                    left.append((name, expression, is_float))
                else:
                    self._constants[name] = float(value) if is_float else value
            if len(left) == len(pending):
                return
            pending = left

    def _members(self, body: str, file: Path) -> list[Member]:
        members = []
        for statement in filter(None, (part.strip() for part in body.split(";"))):
            match = re.fullmatch(
                r"(?:(?:highp|mediump|lowp)\s+)?(\w+)\s+(\w+)\s*(?:\[([^\]]*)\])?", statement
            )
            if not match:
                raise ValueError(f"{file}: can't read the member {statement!r}")
            kind, name, extent = match.groups()
            count: int | None = None
            if extent is not None:
                count = int(_evaluate(extent, self._constants)) if extent.strip() else 0
            members.append(Member(kind, name, count))
        return members

    def _record(self, name: str, members: list[Member], rule: str) -> _Laid:
        offset, align = 0, 16 if rule == "std140" else 4
        names, formats, offsets, info = [], [], [], {}
        for member in members:
            if member.extent == 0:
                break
            laid = self._member(member, rule)
            offset = _round_up(offset, laid.align)
            names.append(member.name)
            formats.append((laid.dtype, laid.shape))
            offsets.append(offset)
            info[member.name] = laid
            offset += laid.size
            align = max(align, laid.align)
        size = _round_up(offset, align)
        key = (name, rule)
        if key not in self._done:
            spec: Any = {"names": names, "formats": formats, "offsets": offsets, "itemsize": size}
            self._done[key] = np.dtype(spec, metadata={"name": name, "members": info})
        return _Laid(align, size, self._done[key], (), ())

    def _member(self, member: Member, rule: str) -> _Laid:
        laid = self._type(member.type, rule)
        if member.extent is None:
            return laid
        align = _round_up(laid.align, 16) if rule == "std140" else laid.align
        stride = _round_up(laid.size, align)
        shape, given = laid.shape, (member.extent, *laid.given)
        padded = laid.padded
        if laid.dtype.fields is None and not laid.matrix and stride > laid.size:
            shape, padded = (stride // 4,), True
        size, shape = stride * member.extent, (member.extent, *shape)
        return _Laid(align, size, laid.dtype, shape, given, laid.matrix, True, padded)

    def _type(self, name: str, rule: str) -> _Laid:
        if name in _SCALARS:
            return _Laid(4, 4, np.dtype(_SCALARS[name]), (), ())
        vector = _VECTOR.match(name)
        if vector:
            size = int(vector["size"])
            scalar = np.dtype(_VECTOR_SCALARS[vector["kind"]])
            return _Laid(8 if size == 2 else 16, 4 * size, scalar, (size,), (size,))
        matrix = _MATRIX.match(name)
        if matrix:
            columns = int(matrix["columns"])
            rows = int(matrix["rows"] or columns)
            stride = 8 if rows == 2 and rule == "std430" else 16
            shape, given = (columns, stride // 4), (rows, columns)
            padded = rows < shape[1]
            return _Laid(
                stride, stride * columns, np.dtype("<f4"), shape, given, True, False, padded
            )
        if name in self._structs:
            return self._record(name, self._structs[name], rule)
        raise ValueError(f"no layout is known for the type {name}")


def pack(dtype: np.dtype[np.void], **fields: npt.ArrayLike) -> npt.NDArray[np.void]:
    """One record of a layout; see ``pack_array``. Returns a 0-d structured array, read-only."""
    record = _fill(np.zeros((), dtype), dtype, fields, ())
    record.flags.writeable = False
    return record


def pack_array(
    dtype: np.dtype[np.void], count: int, **fields: npt.ArrayLike
) -> npt.NDArray[np.void]:
    """``count`` records; every field has a leading axis of ``count``.

    Matrices are given as M with p' = M @ p, (rows, columns), and stored column by column as GLSL
    wants them. Members named ``reserved…`` may be left out. Raises ValueError for a missing or an
    unknown field and for a wrong shape.
    """
    return _fill(np.zeros(count, dtype), dtype, fields, (count,))


def _fill(
    record: npt.NDArray[np.void],
    dtype: np.dtype[np.void],
    fields: Mapping[str, npt.ArrayLike],
    lead: tuple[int, ...],
) -> npt.NDArray[np.void]:
    metadata: Any = dtype.metadata
    members: Mapping[str, _Laid] = metadata["members"]
    if fields.keys() != members.keys():
        _check_names(metadata["name"], fields.keys(), members.keys())
    for name, value in fields.items():
        laid = members[name]
        array = np.asarray(value)
        if array.shape != (lead + laid.given if lead else laid.given):
            wanted = lead + laid.given
            raise ValueError(f"{metadata['name']}.{name}: shape {array.shape}, not {wanted}")
        if laid.matrix:
            array = array.swapaxes(-1, -2)
        if not laid.padded:
            record[name] = array
        elif len(laid.shape) > len(laid.given):
            record[name][..., 0] = array
        else:
            record[name][..., : array.shape[-1]] = array
    return record


def _check_names(record: str, given: Set[str], members: Set[str]) -> None:
    unknown = sorted(given - members)
    missing = sorted(n for n in members - given if not n.startswith("reserved"))
    if unknown or missing:
        raise ValueError(f"{record}: unknown {unknown}, missing {missing}")


@cache
def layouts() -> Layouts:
    """The layouts of ``glsl/shared``, read once."""
    return Layouts(glsl_root() / "shared")


def _round_up(value: int, step: int) -> int:
    return -(-value // step) * step


_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul,
    ast.LShift: operator.lshift, ast.RShift: operator.rshift, ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_, ast.BitXor: operator.xor, ast.Mod: operator.mod,
    ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Invert: operator.invert,
}  # fmt: skip
_SUFFIX = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F]+|\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)[uUfF]\b")


def _evaluate(expression: str, known: Mapping[str, int | float]) -> int | float:
    """Value of a constant GLSL expression. Raises KeyError, SyntaxError, TypeError, ValueError."""
    tree = ast.parse(_SUFFIX.sub(r"\1", expression.strip()), mode="eval")

    def value(node: ast.expr) -> Any:
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.Name):
            return known[node.id]
        if isinstance(node, ast.UnaryOp):
            return _OPERATORS[type(node.op)](value(node.operand))
        if isinstance(node, ast.BinOp):
            left, right = value(node.left), value(node.right)
            if isinstance(node.op, ast.Div):
                whole = isinstance(left, int) and isinstance(right, int)
                return left // right if whole else left / right
            return _OPERATORS[type(node.op)](left, right)
        raise ValueError(expression)

    result: int | float = value(tree.body)
    return result
