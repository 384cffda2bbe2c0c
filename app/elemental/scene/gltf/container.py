"""A glTF file's outer layer: `.gltf` or `.glb`, its JSON, its buffers and the files it names."""

from __future__ import annotations

import base64
import json
import re
import struct
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote, unquote_to_bytes

from elemental.core.errors import InputError
from elemental.core.files import not_utf8, read_file
from elemental.scene.gltf.fields import Field, Report, printable

GLB_MAGIC = b"glTF"
GLB_HEADER = struct.Struct("<4sII")
CHUNK_HEADER = struct.Struct("<I4s")
SUPPORTED_MAJOR_VERSION, SUPPORTED_VERSION = "2", "2.0"

MESHOPT_EXTENSION = "EXT_meshopt_compression"

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")
"""Two letters at least: `C:` is a drive."""


class Document:
    """The parsed JSON as a `Field`, and the bytes behind its buffers, views and URIs."""

    def __init__(self, path: Path) -> None:
        """Raises InputError for a file that is missing, broken or not glTF 2.0."""
        self.path = path
        self.report = Report(path)
        encoded = read_file(path)
        if encoded.startswith(GLB_MAGIC) or path.suffix.lower() == ".glb":
            text, self._binary_chunk = _split_glb(path, encoded)
        else:
            text, self._binary_chunk = encoded, None
        self.root = Field(self.report, "", _parse_json(path, text))
        version = self.root.need("asset").need("version").text()
        if version.split(".")[0] != SUPPORTED_MAJOR_VERSION:
            raise InputError(path, "asset.version", f"glTF {version[:20]} is not supported, only 2")
        least = self.root.need("asset").text_or("minVersion", SUPPORTED_VERSION)
        if least != SUPPORTED_VERSION:
            reason = f"glTF {least[:20]} is not supported, only {SUPPORTED_VERSION}"
            raise InputError(path, "asset.minVersion", reason)
        self.buffers = self.root.elements("buffers")
        self.views = self.root.elements("bufferViews")
        self._loaded: dict[int, bytes] = {}

    def buffer(self, index: int) -> bytes:
        """The `byteLength` bytes of a buffer, read once."""
        if index not in self._loaded:
            self._loaded[index] = self._read_buffer(index)
        return self._loaded[index]

    def view(self, index: int) -> tuple[memoryview, int | None]:
        """The bytes of a buffer view and its stride, if it has one."""
        view = self.views[index]
        source = self.buffer(view.need("buffer").index(len(self.buffers), "buffers"))
        offset = view.integer_or("byteOffset", 0)
        length = view.need("byteLength").integer(low=1)
        if offset + length > len(source):
            raise view.error(
                f"bytes {offset} to {offset + length} reach past the buffer's {len(source)}"
            )
        stride = view.find("byteStride")
        window = memoryview(source)[offset : offset + length]
        return window, stride.integer(4, 252) if stride else None

    def resolve(self, uri: Field) -> bytes:
        """The bytes that a URI names: a data URI's own, or those of a file beside this one."""
        shown = uri.text()
        text: str = uri.raw
        if text.startswith("data:"):
            return _decode_data_uri(uri, text)
        if _SCHEME.match(text):
            raise uri.error(f"{shown[:60]!r} is not a file; only files and data: URIs are read")
        name = unquote(text)
        return read_file(self.path.parent / name, self.path, f"{uri.path}: {printable(name)}")

    def _read_buffer(self, index: int) -> bytes:
        buffer = self.buffers[index]
        length = buffer.need("byteLength").integer(low=1)
        uri = buffer.find("uri")
        if uri is not None:
            source = self.resolve(uri)
        elif index == 0 and self._binary_chunk is not None:
            source = self._binary_chunk
        elif buffer.extension(MESHOPT_EXTENSION) is not None:
            raise buffer.error(f"is compressed by {MESHOPT_EXTENSION}, which is not supported")
        else:
            raise buffer.error("has no uri, and there is no binary chunk for it")
        if len(source) < length:
            raise buffer.error(f"has {len(source)} bytes instead of its byteLength of {length}")
        return source[:length]


def _split_glb(path: Path, encoded: bytes) -> tuple[bytes, bytes | None]:
    """The JSON chunk and the binary chunk of a .glb."""
    if len(encoded) < GLB_HEADER.size:
        raise InputError(path, "header", f"the file has {len(encoded)} bytes, a .glb at least 12")
    magic, version, length = GLB_HEADER.unpack_from(encoded)
    if magic != GLB_MAGIC:
        raise InputError(path, "header", "not a .glb file (it does not start with 'glTF')")
    if version != 2:
        raise InputError(path, "header", f"glb version {version} is not supported, only 2")
    if length > len(encoded):
        raise InputError(path, "header", f"truncated: {len(encoded)} bytes of {length}")
    chunks: dict[bytes, bytes] = {}
    first, at = b"", GLB_HEADER.size
    while at + CHUNK_HEADER.size <= length:
        size, kind = CHUNK_HEADER.unpack_from(encoded, at)
        at += CHUNK_HEADER.size
        if at + size > length:
            raise InputError(path, "chunk", f"truncated: its {size} bytes reach past the end")
        first = first or kind
        chunks.setdefault(kind, encoded[at : at + size])
        at += size
    if first != b"JSON":
        raise InputError(path, "chunk", "the first chunk is not JSON")
    return chunks[b"JSON"], chunks.get(b"BIN\0")


def _parse_json(path: Path, text: bytes) -> object:
    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"{constant} is not JSON")

    try:
        parsed: object = json.loads(text.decode("utf-8-sig"), parse_constant=refuse)
        return parsed
    except RecursionError:
        raise InputError(path, "JSON", "is nested too deeply") from None
    except UnicodeDecodeError as error:
        raise InputError(path, "JSON", not_utf8(error)) from error
    except json.JSONDecodeError as error:
        reason = f"is broken ({error.msg}: line {error.lineno} column {error.colno})"
        raise InputError(path, "JSON", reason) from error
    except ValueError as error:
        reason = str(error) if "JSON" in str(error) else "a number has too many digits"
        raise InputError(path, "JSON", f"is broken ({reason})") from error


def _decode_data_uri(uri: Field, text: str) -> bytes:
    header, comma, body = text.partition(",")
    if not comma:
        raise uri.error("the data: URI has no comma")
    try:
        if not header.endswith(";base64"):
            return unquote_to_bytes(body)
        return base64.b64decode(unquote(body), validate=True)
    except ValueError as error:
        raise uri.error("the data: URI is broken (no base64)") from error
