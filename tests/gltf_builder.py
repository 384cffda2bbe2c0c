"""Builds small glTF files in code: `GltfBuilder().add(...)`, then `.write` or `.load`."""

from __future__ import annotations

import base64
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import PIL.Image

from elemental.scene.load import load_scene
from elemental.scene.model import Scene

Array = npt.NDArray[Any]
Json = dict[str, Any]

COMPONENT_CODE = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPE_NAME = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
ATTRIBUTE_NAME = {
    "positions": "POSITION",
    "normals": "NORMAL",
    "tangents": "TANGENT",
    "uv0": "TEXCOORD_0",
    "uv1": "TEXCOORD_1",
    "colors": "COLOR_0",
}


class GltfBuilder:
    """The JSON (`root`, free to edit) and one buffer. Each method returns an index."""

    def __init__(self) -> None:
        self.root: Json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        self.buffer = bytearray()

    def append(self, key: str, value: Json) -> int:
        self.root.setdefault(key, []).append(value)
        return len(self.root[key]) - 1

    def extend(self, name: str, required: bool = False) -> None:
        """Declare an extension."""
        for key in ("extensionsUsed", "extensionsRequired")[: 2 if required else 1]:
            if name not in self.root.setdefault(key, []):
                self.root[key].append(name)

    # Arrays

    def view(self, encoded: bytes, **more: Any) -> int:
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        offset = len(self.buffer)
        self.buffer += encoded
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(encoded), **more}
        return self.append("bufferViews", view)

    def accessor(self, array: Array, **more: Any) -> int:
        """An accessor of (N, width) or (N,) values; `more` is JSON such as normalized=True."""
        array = np.asarray(array)
        accessor = {
            "bufferView": self.view(array.tobytes()),
            "componentType": COMPONENT_CODE[array.dtype.str[1:]],
            "count": len(array),
            "type": TYPE_NAME[array.shape[1] if array.ndim == 2 else 1],
            **more,
        }
        return self.append("accessors", accessor)

    # Things

    def primitive(
        self,
        positions: Array,
        indices: Array | None = None,
        *,
        material: int | None = None,
        mode: int | None = None,
        **attributes: Array,
    ) -> Json:
        """A primitive. Attributes by name (`ATTRIBUTE_NAME`); integer ones count as normalized."""
        arrays = {"positions": np.asarray(positions, np.float32), **attributes}
        primitive: Json = {"attributes": {}}
        for name, array in arrays.items():
            more = {} if array.dtype.kind == "f" else {"normalized": True}
            values = array.astype(np.float32) if array.dtype.kind == "f" else array
            primitive["attributes"][ATTRIBUTE_NAME[name]] = self.accessor(values, **more)
        if indices is not None:
            primitive["indices"] = self.accessor(np.asarray(indices))
        if material is not None:
            primitive["material"] = material
        if mode is not None:
            primitive["mode"] = mode
        return primitive

    def mesh(self, *primitives: Json, **more: Any) -> int:
        return self.append("meshes", {"primitives": list(primitives), **more})

    def node(self, *, root: bool = True, **node: Any) -> int:
        """A node; `root=False` leaves it for another's `children`."""
        index = self.append("nodes", node)
        if root:
            self.root["scenes"][0]["nodes"].append(index)
        return index

    def add(self, positions: Array, indices: Array | None = None, **more: Any) -> int:
        """A node with a mesh of one primitive; what `primitive` does not know is the node's."""
        known = {"material", "mode", *ATTRIBUTE_NAME}
        primitive = {key: more.pop(key) for key in list(more) if key in known}
        return self.node(mesh=self.mesh(self.primitive(positions, indices, **primitive)), **more)

    def material(
        self,
        base_color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0),
        *,
        metallic: float = 0.0,
        roughness: float = 1.0,
        emissive: tuple[float, float, float] = (0.0, 0.0, 0.0),
        emissive_strength: float | None = None,
        **more: Any,
    ) -> int:
        """A metallic-roughness material; `more` is the material's JSON."""
        material: Json = {
            "pbrMetallicRoughness": {
                "baseColorFactor": list(base_color),
                "metallicFactor": metallic,
                "roughnessFactor": roughness,
                **more.pop("pbr", {}),
            },
            "emissiveFactor": list(emissive),
            **more,
        }
        if emissive_strength is not None:
            self.extend("KHR_materials_emissive_strength")
            strength = {"emissiveStrength": emissive_strength}
            extensions = material.setdefault("extensions", {})
            extensions["KHR_materials_emissive_strength"] = strength
        return self.append("materials", material)

    def texture(self, pixels: Array, kind: str = "PNG", sampler: Json | None = None) -> int:
        """A texture of an embedded image of (H, W, 3 or 4) uint8 pixels."""
        encoded = io.BytesIO()
        options: Json = {"lossless": True} if kind == "WEBP" else {}
        PIL.Image.fromarray(np.asarray(pixels, np.uint8)).save(encoded, kind, **options)
        mime = f"image/{kind.lower()}"
        image = self.append(
            "images", {"bufferView": self.view(encoded.getvalue()), "mimeType": mime}
        )
        texture: Json = {"source": image}
        if sampler is not None:
            texture["sampler"] = self.append("samplers", sampler)
        return self.append("textures", texture)

    def light(self, kind: str, light: Json | None = None, **node: Any) -> int:
        """A node with a punctual light, which shines along the node's -z."""
        self.extend("KHR_lights_punctual")
        extension = self.root.setdefault("extensions", {}).setdefault(
            "KHR_lights_punctual", {"lights": []}
        )
        spot = {"spot": {}} if kind == "spot" else {}
        extension["lights"].append({"type": kind, **spot, **(light or {})})
        index = len(extension["lights"]) - 1
        return self.node(extensions={"KHR_lights_punctual": {"light": index}}, **node)

    def camera(self, fov_y: float = 0.8, near: float = 0.1, **node: Any) -> int:
        """A node with a perspective camera, which looks along the node's -z."""
        lens = {"yfov": fov_y, "znear": near}
        camera = self.append("cameras", {"type": "perspective", "perspective": lens})
        return self.node(camera=camera, **node)

    def animation(self, *channels: tuple[int, str, Any, Any], **more: Any) -> int:
        """An animation of (node, path, times, values) channels; `more` is its JSON and may hold
        interpolation="CUBICSPLINE" or "STEP" for all of them."""
        interpolation = more.pop("interpolation", "LINEAR")
        samplers, targets = [], []
        for number, (node, path, times, values) in enumerate(channels):
            samplers.append({
                "input": self.accessor(np.asarray(times, np.float32)),
                "output": self.accessor(np.asarray(values, np.float32)),
                "interpolation": interpolation,
            })  # fmt: skip
            targets.append({"sampler": number, "target": {"node": node, "path": path}})
        animation = {"samplers": samplers, "channels": targets, **more}
        return self.append("animations", animation)

    def skin(self, joints: list[int], inverse_bind: Array | None = None, **more: Any) -> int:
        """A skin; inverse_bind (J, 4, 4) with p' = m @ p."""
        skin: Json = {"joints": joints, **more}
        if inverse_bind is not None:
            columns = np.asarray(inverse_bind, np.float32).transpose(0, 2, 1).reshape(-1, 16)
            skin["inverseBindMatrices"] = self.accessor(columns)
        return self.append("skins", skin)

    def skinned(self, primitive: Json, joints: Array, weights: Array, number: int = 0) -> Json:
        """The primitive with JOINTS_n and WEIGHTS_n, (N, 4) each."""
        attributes = primitive["attributes"]
        attributes[f"JOINTS_{number}"] = self.accessor(np.asarray(joints, np.uint8))
        attributes[f"WEIGHTS_{number}"] = self.accessor(np.asarray(weights, np.float32))
        return primitive

    def morphed(self, primitive: Json, *targets: dict[str, Array]) -> Json:
        """The primitive with morph targets by attribute name (`ATTRIBUTE_NAME`)."""
        primitive["targets"] = [
            {
                ATTRIBUTE_NAME[name]: self.accessor(np.asarray(a, np.float32))
                for name, a in t.items()
            }
            for t in targets
        ]
        return primitive

    # Files

    def glb(self) -> bytes:
        """The file as .glb."""
        root = {**self.root, "buffers": [{"byteLength": len(self.buffer)}]}
        text = json.dumps(root if self.buffer else self.root).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.buffer) + b"\0" * (-len(self.buffer) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if binary:
            chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self) -> bytes:
        """The file as .gltf with the buffer in a data URI."""
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.buffer).decode()
        buffers = [{"byteLength": len(self.buffer), "uri": uri}] if self.buffer else []
        return json.dumps({**self.root, "buffers": buffers}).encode()

    def write(self, path: Path) -> Path:
        """Write .glb or .gltf, as the name says."""
        path.write_bytes(self.gltf() if path.suffix == ".gltf" else self.glb())
        return path

    def load(self, folder: Path, name: str = "scene.glb", *, default_lights: bool = False) -> Scene:
        """Write the file into `folder` and load it."""
        return load_scene(self.write(folder / name), default_lights=default_lights)
