"""A few glTF quads written by the tests: a lit corner, and the ways in which it can be broken."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Quad = tuple[tuple[float, float, float], ...]

FLOOR: Quad = ((-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1))
WALL: Quad = ((-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1))
LAMP: Quad = ((-0.5, 1.9, -0.5), (0.5, 1.9, -0.5), (0.5, 1.9, 0.5), (-0.5, 1.9, 0.5))


def corner() -> dict[str, Any]:
    """White floor, red wall, a lamp above, one camera named "front"; 6 triangles."""
    quads = (FLOOR, WALL, LAMP)
    positions = np.array(quads, np.float32)
    indices = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    binary = positions.tobytes() + indices.tobytes()
    encoded = base64.b64encode(binary).decode()
    materials = [
        {"pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0}}
        for color in ([0.8, 0.8, 0.8, 1], [0.8, 0.1, 0.1, 1], [0, 0, 0, 1])
    ]
    materials[2]["emissiveFactor"] = [1, 1, 1]  # type: ignore[assignment]
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3]}],
        "nodes": [{"mesh": 0}, {"mesh": 1}, {"mesh": 2},
                  {"name": "front", "camera": 0, "translation": [0, 1, 4]}],
        "cameras": [{"type": "perspective",
                     "perspective": {"yfov": 0.7, "znear": 0.1, "zfar": 20}}],
        "materials": materials,
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": i}, "indices": 3, "material": i}]}
            for i in range(3)
        ],
        "accessors": [
            *({"bufferView": 0, "byteOffset": 48 * i, "componentType": 5126, "count": 4,
               "type": "VEC3", "min": positions[i].min(0).tolist(),
               "max": positions[i].max(0).tolist()} for i in range(3)),
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 144},
                        {"buffer": 0, "byteOffset": 144, "byteLength": 12}],
        "buffers": [{"byteLength": len(binary),
                     "uri": f"data:application/octet-stream;base64,{encoded}"}],
    }  # fmt: skip


def write_corner(folder: Path) -> Path:
    """``corner.gltf`` in ``folder``."""
    path = folder / "corner.gltf"
    path.write_text(json.dumps(corner()))
    return path


def _edited(edit: Callable[[dict[str, Any]], object]) -> bytes:
    gltf = corner()
    edit(gltf)
    return json.dumps(gltf).encode()


def _nan_position(gltf: dict[str, Any]) -> None:
    binary = bytearray(base64.b64decode(gltf["buffers"][0]["uri"].split(",")[1]))
    binary[0:4] = struct.pack("<f", float("nan"))
    encoded = base64.b64encode(bytes(binary)).decode()
    gltf["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{encoded}"


def _glb(declared_length: int) -> bytes:
    text = json.dumps(corner()).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, declared_length, len(text), 0x4E4F534A) + text


BROKEN_FILES: dict[str, bytes] = {
    "empty.gltf": b"",
    "not_json.gltf": b"{]",
    "not_an_object.gltf": b"[]",
    "not_utf8.gltf": b"\xff\xfe{}",
    "not_a_glb.glb": b"PNG?",
    "truncated.glb": _glb(100_000)[:300],
    "future_version.gltf": _edited(lambda g: g["asset"].update(version="3.0")),
    "accessor_out_of_range.gltf": _edited(lambda g: g["accessors"][0].update(count=4000)),
    "no_such_accessor.gltf": _edited(
        lambda g: g["meshes"][0]["primitives"][0]["attributes"].update(POSITION=99)
    ),
    "index_out_of_range.gltf": _edited(
        lambda g: g["accessors"][3].update(bufferView=0, byteOffset=0)
    ),
    "nan_position.gltf": _edited(_nan_position),
    "no_triangles.gltf": _edited(lambda g: g.update(nodes=[{}, {}, {}, {}])),
    "cyclic_nodes.gltf": _edited(lambda g: g["nodes"][0].update(children=[1]) or
                                 g["nodes"][1].update(children=[0])),
    "unknown_required_extension.gltf": _edited(
        lambda g: g.update(extensionsUsed=["X_y"], extensionsRequired=["X_y"])
    ),
    "missing_buffer.gltf": _edited(lambda g: g["buffers"][0].update(uri="nowhere.bin")),
    "unknown_key.toml": b"nonsense = 1\n",
    "two_wrong_keys.toml": b"nonsense = 1\nsettings = 3\n",
    "unknown_setting.toml": b'models = [{ file = "a.gltf" }]\n[settings]\nnonsense = 1\n',
    "not_toml.toml": b"= =\n",
    "picture.obj": b"o x\n",
}  # fmt: skip
"""Files that can't be honoured; each is refused in one line."""
