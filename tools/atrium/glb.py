"""The glb container: meshes once, nodes many times."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from atrium.mesh import Mesh

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


@dataclass
class GlbWriter:
    """Collects glTF 2.0 objects and their bytes; `bytes()` closes the file."""

    json: dict[str, Any] = field(default_factory=dict)
    binary: bytearray = field(default_factory=bytearray)

    def add(self, kind: str, entry: Mapping[str, Any]) -> int:
        """Appends to a top-level array; its index."""
        entries = self.json.setdefault(kind, [])
        entries.append(dict(entry))
        return len(entries) - 1

    def _view(self, content: bytes, target: int | None = None) -> int:
        self.binary.extend(b"\0" * (-len(self.binary) % 4))
        entry = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(content)}
        self.binary.extend(content)
        return self.add("bufferViews", entry if target is None else {**entry, "target": target})

    def _attribute(self, values: np.ndarray[Any, np.dtype[np.float32]]) -> int:
        entry: dict[str, Any] = {
            "bufferView": self._view(values.astype("<f4").tobytes(), ARRAY_BUFFER),
            "componentType": FLOAT,
            "count": len(values),
            "type": f"VEC{values.shape[1]}",
        }
        if values.shape[1] == 3:
            entry |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        return self.add("accessors", entry)

    def texture(self, name: str, jpeg: bytes) -> int:
        """An image with a repeating, mipmapped sampler; the texture's index."""
        if "samplers" not in self.json:
            self.add("samplers", {"magFilter": 9729, "minFilter": 9987})
        image = self.add(
            "images", {"name": name, "bufferView": self._view(jpeg), "mimeType": "image/jpeg"}
        )
        return self.add("textures", {"name": name, "source": image, "sampler": 0})

    def primitive(self, mesh: Mesh) -> dict[str, Any]:
        """The mesh's accessors as a primitive that still lacks its material."""
        short = len(mesh.position) < 65535
        index = mesh.index.astype("<u2" if short else "<u4")
        indices = self.add(
            "accessors",
            {
                "bufferView": self._view(index.tobytes(), ELEMENT_ARRAY_BUFFER),
                "componentType": UINT16 if short else UINT32,
                "count": len(index),
                "type": "SCALAR",
            },
        )
        attributes = {
            "POSITION": self._attribute(mesh.position),
            "NORMAL": self._attribute(mesh.normal),
            "TEXCOORD_0": self._attribute(mesh.uv),
        }
        return {"attributes": attributes, "indices": indices}

    def node(
        self, name: str, mesh: int, translation: Sequence[float], yaw: float, scale: float
    ) -> int:
        """A node that shows a mesh, turned about y by `yaw` radians."""
        entry: dict[str, Any] = {"name": name, "mesh": mesh}
        if any(translation):
            entry["translation"] = [round(float(t), 6) for t in translation]
        if yaw:
            entry["rotation"] = [
                0.0,
                round(float(np.sin(yaw / 2.0)), 7),
                0.0,
                round(float(np.cos(yaw / 2.0)), 7),
            ]
        if scale != 1.0:
            entry["scale"] = [scale] * 3
        return self.add("nodes", entry)

    def bytes(
        self, extensions: Sequence[str], name: str = "atrium", maker: str = "tools/make_atrium.py"
    ) -> bytes:
        """The whole file: one scene of all nodes."""
        document = {
            "asset": {"version": "2.0", "generator": f"elemental {maker}"},
            "extensionsUsed": list(extensions),
            "scene": 0,
            "scenes": [{"name": name, "nodes": list(range(len(self.json["nodes"])))}],
            **self.json,
            "buffers": [{"byteLength": len(self.binary)}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        body = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        total = 12 + 8 + len(text) + 8 + len(body)
        return (
            struct.pack("<4sII", b"glTF", 2, total)
            + struct.pack("<I4s", len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(body), b"BIN\0")
            + body
        )
