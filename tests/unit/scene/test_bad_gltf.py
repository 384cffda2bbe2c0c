"""Broken glTF files: one InputError that names the file, the field and the reason."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.core.errors import InputError
from elemental.scene.load import load_scene
from gltf_builder import GltfBuilder

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def small() -> GltfBuilder:
    """A file with one of everything."""
    builder = GltfBuilder()
    texture = builder.texture(np.zeros((2, 2, 4)), sampler={"wrapS": 10497})
    slot = {"index": texture, "extensions": {"KHR_texture_transform": {"offset": [0, 0]}}}
    builder.material(
        emissive=(1, 1, 1), emissive_strength=2.0, pbr={"baseColorTexture": slot},
        normalTexture={"index": texture, "scale": 1.0},
    )  # fmt: skip
    builder.add(TRIANGLE, np.array([0, 1, 2], np.uint16), uv0=TRIANGLE[:, :2], material=0, name="n")
    builder.light("spot", {"spot": {"outerConeAngle": 0.5}})
    builder.camera()
    return builder


def refusal(builder: GltfBuilder, folder: Path, name: str = "a.gltf") -> str:
    """The error's text behind the file's name."""
    path = builder.write(folder / name)
    with pytest.raises(InputError) as caught:
        load_scene(path, default_lights=True)
    text = str(caught.value)
    assert "\n" not in text
    assert text.startswith(f"{path}: ")
    return text.removeprefix(f"{path}: ")


def test_the_small_file_is_fine(tmp_path: Path) -> None:
    scene = small().load(tmp_path)
    assert scene.warnings == []
    assert scene.triangle_count == 1


PBR = "materials[0].pbrMetallicRoughness"
DAMAGE: list[tuple[str, Any, str]] = [
    ("asset", None, "asset: expected an object"),
    ("asset", {}, "asset: version is missing"),
    ("asset.version", "1.0", "asset.version: glTF 1.0 is not supported, only 2"),
    ("asset.minVersion", "2.1", "asset.minVersion: glTF 2.1 is not supported, only 2.0"),
    ("accessors", {}, "accessors: expected an array"),
    ("accessors.0", [], "accessors[0]: expected an object"),
    ("accessors.0.count", 4, "accessors[0]: 4 elements end at byte 48 of a view of 36"),
    ("accessors.0.count", 0, "accessors[0].count: 0 is out of range"),
    ("accessors.0.count", "3", "accessors[0].count: expected a whole number"),
    ("accessors.0.count", 3.5, "accessors[0].count: expected a whole number"),
    ("accessors.0.byteOffset", -4, "accessors[0].byteOffset: -4 is out of range"),
    ("accessors.0.bufferView", 99, "out of range, there are"),
    ("accessors.0.componentType", 5124, "componentType 5124 is none of"),
    ("accessors.0.type", "VEC7", "accessors[0]: expected a type of"),
    ("accessors.0.type", "VEC2", "POSITION: expected an accessor of 3 components"),
    ("accessors.2.componentType", 5126, "accessors[2]: 3 elements end at byte 12 of a view of 6"),
    ("bufferViews.1.byteLength", 10**9, "reach past the buffer's"),
    ("bufferViews.1.byteOffset", 2**50, "reach past the buffer's"),
    ("bufferViews.1.byteStride", 4, "a stride of 4 bytes is less than an element's 12"),
    ("bufferViews.1.buffer", 1, "bufferViews[1].buffer: 1 is out of range, there are 1 buffers"),
    ("images.0.uri", "http://example.org/a.png", "only files and data: URIs are read"),
    ("images.0.uri", "file:///etc/passwd", "only files and data: URIs are read"),
    ("images.0.uri", "missing.png", "images[0].uri: missing.png: does not exist"),
    ("images.0.uri", "..", "images[0].uri: ..: is a folder"),
    ("images.0.uri", "%00", "images[0].uri: ?: does not exist"),
    ("images.0.uri", "data:image/png;base64", "the data: URI has no comma"),
    ("images.0.uri", "data:image/png;base64,%%%", "the data: URI is broken"),
    ("images.0.uri", "data:image/png,abc", "images[0]: image0: not a PNG"),
    ("images.0.uri", 7, "images[0].uri: expected a string"),
    ("textures.0.source", 4, "textures[0].source: 4 is out of range, there are 1 images"),
    ("textures.0.sampler", 4, "textures[0].sampler: 4 is out of range, there are 1 samplers"),
    ("samplers.0.wrapS", 1, "samplers[0].wrapS: expected one of 10497, 33071, 33648"),
    ("samplers.0.wrapS", [1], "samplers[0].wrapS: expected one of 10497, 33071, 33648"),
    ("materials.0", 3, "materials[0]: expected an object"),
    ("materials.0.pbrMetallicRoughness.baseColorFactor", [1, 1, 1],
     f"{PBR}.baseColorFactor: expected 4 numbers"),
    ("materials.0.pbrMetallicRoughness.baseColorFactor", [1, 1, 1, "a"],
     f"{PBR}.baseColorFactor[3]: expected a number"),
    ("materials.0.pbrMetallicRoughness.baseColorFactor", [1, 1, 1, True],
     f"{PBR}.baseColorFactor[3]: expected a number"),
    ("materials.0.pbrMetallicRoughness.metallicFactor", 1e39,
     f"{PBR}.metallicFactor: expected a finite number within the range of 32-bit floats"),
    ("materials.0.pbrMetallicRoughness.metallicFactor", 10**400,
     f"{PBR}.metallicFactor: expected a finite number within the range of 32-bit floats"),
    ("materials.0.pbrMetallicRoughness.baseColorTexture.index", 1,
     f"{PBR}.baseColorTexture.index: 1 is out of range, there are 1 textures"),
    ("materials.0.pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.offset",
     [1], "KHR_texture_transform.offset: expected 2 numbers"),
    ("materials.0.emissiveFactor", [0, -1, 0],
     "materials[0].emissiveFactor[1]: expected a number of at least 0, not -1"),
    ("materials.0.alphaMode", "GLASS", "materials[0].alphaMode: expected one of OPAQUE, MASK"),
    ("materials.0.doubleSided", 1, "materials[0].doubleSided: expected true or false"),
    ("materials.0.name", 1, "materials[0].name: expected a string"),
    ("meshes.0.primitives", {}, "meshes[0].primitives: expected an array"),
    ("meshes.0.primitives.0.mode", 7, "meshes[0].primitives[0].mode: 7 is out of range"),
    ("meshes.0.primitives.0.attributes", {}, "attributes: POSITION is missing"),
    ("meshes.0.primitives.0.attributes.POSITION", 77, "POSITION: 77 is out of range"),
    ("meshes.0.primitives.0.indices", 0, "expected an accessor of unsigned integer scalars"),
    ("meshes.0.primitives.0.material", -1, "material: -1 is out of range"),
    ("nodes.0.mesh", 1, "nodes[0].mesh: 1 is out of range, there are 1 meshes"),
    ("nodes.0.mesh", "cube", "nodes[0].mesh: expected a whole number"),
    ("nodes.0.matrix", [1] * 15, "nodes[0].matrix: expected 16 numbers"),
    ("nodes.0.matrix", [1] * 16, "nodes[0].matrix: expected a last row of 0 0 0 1"),
    ("nodes.0.rotation", [0, 0, 0, 0], "nodes[0].rotation: a quaternion of length 0"),
    ("nodes.0.scale", [1e30] * 3, "reaches beyond"),
    ("nodes.0.children", [0], "nodes[0].children[0]: the node is its own child"),
    ("nodes.0.children", [9], "nodes[0].children[0]: 9 is out of range, there are 3 nodes"),
    ("nodes.0.children", 1, "nodes[0].children: expected an array"),
    ("nodes.1.extensions.KHR_lights_punctual.light", 5, "5 is out of range, there are 1 lights"),
    ("nodes.2.camera", 5, "nodes[2].camera: 5 is out of range, there are 1 cameras"),
    ("extensions.KHR_lights_punctual.lights.0.type", "laser", "expected one of directional"),
    ("extensions.KHR_lights_punctual.lights.0.intensity", -1, "expected a number of at least 0"),
    ("extensions.KHR_lights_punctual.lights.0.spot.outerConeAngle", 0, "outerConeAngle is 0"),
    ("cameras.0.perspective.znear", 0, "znear: expected a number greater than 0"),
    ("cameras.0.perspective.zfar", 0.05, "zfar: is not beyond znear (0.05 <= 0.1)"),
    ("cameras.0.perspective.yfov", 4, "yfov: expected a number from"),
    ("cameras.0.type", "fisheye", "cameras[0].type: expected perspective or orthographic"),
    ("scene", 1, "scene: 1 is out of range, there are 1 scenes"),
    ("scenes.0.nodes", [0, 0], "nodes[0]: is reached twice"),
    ("scenes.0.nodes", [], "the scene has no triangles"),
]  # fmt: skip


@pytest.mark.parametrize(("place", "value", "reason"), DAMAGE)
def test_wrong_values(place: str, value: Any, reason: str, tmp_path: Path) -> None:
    builder = small()
    *path, last = place.split(".")
    owner: Any = builder.root
    for key in path:
        owner = owner[int(key) if key.isdigit() else key]
    owner[int(last) if last.isdigit() else last] = value
    assert reason in refusal(builder, tmp_path)


def test_radiance_that_overflows(tmp_path: Path) -> None:
    builder = small()
    builder.root["materials"][0]["emissiveFactor"] = [10, 0, 0]
    extension = builder.root["materials"][0]["extensions"]["KHR_materials_emissive_strength"]
    extension["emissiveStrength"] = 3e38
    assert "the emitted radiance overflows" in refusal(builder, tmp_path)


def cycle(builder: GltfBuilder) -> None:
    builder.root["nodes"] += [{"children": [4]}, {"children": [3]}]
    builder.root["scenes"][0]["nodes"].append(3)


def only_cycles(builder: GltfBuilder) -> None:
    builder.root["nodes"] = [{"children": [1]}, {"children": [0]}]
    del builder.root["scenes"], builder.root["scene"]


def two_parents(builder: GltfBuilder) -> None:
    builder.root["nodes"] += [{"children": [0]}, {"children": [0]}]


def transform_overflow(builder: GltfBuilder) -> None:
    builder.root["nodes"][0]["scale"] = [1e30] * 3
    builder.root["nodes"].append({"children": [0], "scale": [1e30] * 3})
    builder.root["scenes"][0]["nodes"] = [3]


def no_nodes(builder: GltfBuilder) -> None:
    del builder.root["nodes"]
    builder.root["scenes"] = [{}]


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (cycle, "nodes[3]: is reached twice: a cycle"),
        (only_cycles, "nodes: every node is a child of another: a cycle"),
        (two_parents, "nodes[4].children[0]: node 0 is already a child of node 3"),
        (transform_overflow, "nodes[0]: its transform to the world overflows"),
        (no_nodes, "the scene has no triangles"),
    ],
)
def test_broken_trees(damage: Callable[[GltfBuilder], None], reason: str, tmp_path: Path) -> None:
    builder = small()
    damage(builder)
    assert reason in refusal(builder, tmp_path)


def test_deep_trees_are_fine(tmp_path: Path) -> None:
    builder = GltfBuilder()
    child = builder.add(TRIANGLE, root=False)
    for _ in range(5000):
        child = builder.node(root=False, children=[child])
    builder.node(children=[child])
    assert builder.load(tmp_path).triangle_count == 1


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_positions_that_are_not_finite(value: float, tmp_path: Path) -> None:
    positions = TRIANGLE.copy()
    positions[1, 2] = value
    builder = GltfBuilder()
    builder.add(positions)
    expected = "meshes[0].primitives[0].attributes.POSITION: vertex 1 is NaN or infinite"
    assert refusal(builder, tmp_path) == expected


def test_index_out_of_range(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, np.array([0, 1, 3], np.uint16))
    expected = "indices: index 3 is out of range, there are 3 vertices"
    assert expected in refusal(builder, tmp_path)


def test_attributes_of_different_length(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE, uv0=np.zeros((4, 2), np.float32))
    assert "TEXCOORD_0: has 4 vertices, POSITION 3" in refusal(builder, tmp_path)


def test_sparse_out_of_range(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    values = {"bufferView": builder.view(bytes(12))}
    indices = {"bufferView": builder.view(b"\3"), "componentType": 5121}
    sparse = {"count": 1, "indices": indices, "values": values}
    builder.root["accessors"][0]["sparse"] = sparse
    assert "sparse.indices: 3 is out of range, there are 3" in refusal(builder, tmp_path)


def test_zeros_without_end(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    accessor = builder.root["accessors"][0]
    del accessor["bufferView"]
    accessor["count"] = 10**12
    assert "without a bufferView are too many" in refusal(builder, tmp_path)


def test_only_degenerate_triangles(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE * np.array([1, 0, 0], np.float32))
    assert refusal(builder, tmp_path) == "the scene has no triangles"


def test_too_small_and_too_large(tmp_path: Path) -> None:
    for size, reason in ((1e-12, "is only 1e-12 m across"), (1e12, "reaches beyond 1e+09 m")):
        builder = GltfBuilder()
        builder.add((TRIANGLE * size).astype(np.float32))
        assert reason in refusal(builder, tmp_path)


@pytest.mark.parametrize("size", [1e-3, 1e4])
def test_1_mm_and_10_km_are_fine(size: float, tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add((TRIANGLE * size).astype(np.float32))
    scene = builder.load(tmp_path)
    np.testing.assert_allclose(scene.bounds()[1], [size, size, 0], rtol=1e-6)


def test_every_truncation_of_a_glb(tmp_path: Path) -> None:
    whole = small().glb()
    path = tmp_path / "cut.glb"
    for length in range(0, len(whole), 7):
        path.write_bytes(whole[:length])
        with pytest.raises(InputError):
            load_scene(path, default_lights=True)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "JSON: is broken"),
        (b"{", "JSON: is broken"),
        (b"\xff\xfe", "JSON: is not UTF-8 text (byte 1)"),
        (b"[]", "expected an object"),
        (b'{"asset": {"version": "2.0"}, "x": NaN}', "NaN is not JSON"),
        (b'{"asset": {"version": "2.0"}}', "the scene has no triangles"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"asset": {"version": "2.0"}, "x": ' + b"1" * 10_000 + b"}", "too many digits"),
        (b"glTF\x01\0\0\0\x0c\0\0\0", "glb version 1 is not supported"),
        (b"glTF\x02\0\0\0\x0c\0\0\0", "the first chunk is not JSON"),
    ],
)
def test_broken_files(content: bytes, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "a.gltf"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load_scene(path, default_lights=True)
    assert reason in str(caught.value)


def test_buffers_that_are_short_or_missing(tmp_path: Path) -> None:
    path = tmp_path / "a.gltf"
    root = json.loads(small().gltf())
    for buffer, reason in (
        ({"byteLength": 10**6, "uri": "data:;base64,AAAA"}, "has 3 bytes instead of its byteLen"),
        ({"byteLength": 10}, "has no uri, and there is no binary chunk"),
        ({"byteLength": 10, "uri": "gone.bin"}, "buffers[0].uri: gone.bin: does not exist"),
    ):
        path.write_text(json.dumps({**root, "buffers": [buffer]}))
        with pytest.raises(InputError) as caught:
            load_scene(path, default_lights=True)
        assert reason in str(caught.value)


def test_control_characters_never_reach_the_terminal(tmp_path: Path) -> None:
    builder = small()
    builder.root["nodes"][0]["name"] = "a\x1b[2J\ud800b\n"
    assert builder.load(tmp_path).instances[0].name == "a?[2J?b?"


def test_missing_file_and_folder(tmp_path: Path) -> None:
    for path, reason in ((tmp_path / "none.glb", "does not exist"), (tmp_path, "is a folder")):
        with pytest.raises(InputError, match=reason):
            load_scene(path, default_lights=True)
