"""Draco, and extensions that can't be honoured."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import DracoPy
import numpy as np
import pytest

import shapes
from elemental.core.errors import InputError
from elemental.scene.load import load_scene
from elemental.scene.model import Mesh
from gltf_builder import GltfBuilder

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
DRACO = "KHR_draco_mesh_compression"


def draco_builder() -> GltfBuilder:
    """A sphere of radius 1 with normals, compressed as exporters write it."""
    positions, indices = shapes.sphere()
    encoded = DracoPy.encode(
        positions, indices.reshape(-1, 3), quantization_bits=14,
        normals=positions.astype(np.float64),
    )  # fmt: skip
    attributes = {a["attribute_type"]: a["unique_id"] for a in DracoPy.decode(encoded).attributes}
    builder = GltfBuilder()
    builder.extend(DRACO, required=True)
    layout = {"componentType": 5126, "count": len(positions), "type": "VEC3"}
    accessors = [builder.append("accessors", layout) for _ in range(2)]
    count = {"componentType": 5125, "count": len(indices), "type": "SCALAR"}
    extension = {
        "bufferView": builder.view(encoded),
        "attributes": {"POSITION": attributes[0], "NORMAL": attributes[1]},
    }
    primitive = {
        "attributes": {"POSITION": accessors[0], "NORMAL": accessors[1]},
        "indices": builder.append("accessors", count),
        "extensions": {DRACO: extension},
    }
    builder.node(mesh=builder.mesh(primitive))
    return builder


def volume(mesh: Mesh) -> float:
    a, b, c = mesh.positions[mesh.indices].reshape(-1, 3, 3).transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum() / 6)


def test_draco(tmp_path: Path) -> None:
    scene = draco_builder().load(tmp_path)
    mesh = scene.meshes[0]
    plain = GltfBuilder()
    plain.add(*shapes.sphere())
    assert volume(mesh) == pytest.approx(volume(plain.load(tmp_path).meshes[0]), rel=1e-3)
    assert (mesh.normals * mesh.positions).sum(axis=1).min() > 0.999
    assert scene.warnings == []


def test_a_skin_of_compressed_vertices(tmp_path: Path) -> None:
    """A sphere whose right half hangs on the second joint, which stands 3 higher than in the bind
    pose."""
    positions, indices = shapes.sphere()
    right = positions[:, :1] > 0.0
    joints = np.concatenate([right, np.zeros((len(right), 3))], 1).astype(np.uint16)
    weights = np.tile(np.array([1, 0, 0, 0], np.float32), (len(right), 1))
    encoded = DracoPy.encode(
        positions, indices.reshape(-1, 3), quantization_bits=14,
        generic_attributes={7: joints, 8: weights},
    )  # fmt: skip
    builder = GltfBuilder()
    builder.extend(DRACO, required=True)
    ids = {a["attribute_type"]: a["unique_id"] for a in DracoPy.decode(encoded).attributes}
    names = {"POSITION": ids[0], "JOINTS_0": 7, "WEIGHTS_0": 8}
    layout = {"componentType": 5126, "count": len(positions), "type": "VEC4"}
    attributes = {name: builder.append("accessors", layout) for name in names}
    extension = {"bufferView": builder.view(encoded), "attributes": names}
    primitive = {"attributes": attributes, "extensions": {DRACO: extension}}
    skin = builder.skin([builder.node(), builder.node(translation=[0, 3, 0])])
    builder.node(mesh=builder.mesh(primitive), skin=skin)
    shape = builder.load(tmp_path).meshes[0]
    assert shape.positions[shape.positions[:, 0] > 0.05][:, 1].min() == pytest.approx(2, abs=0.02)
    assert shape.positions[shape.positions[:, 0] < -0.05][:, 1].max() == pytest.approx(1, abs=0.02)


def test_draco_without_its_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    with pytest.raises(InputError, match=r"KHR_draco_mesh_compression: needs DracoPy"):
        draco_builder().load(tmp_path)


def test_without_draco_plain_data_beside_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    builder = GltfBuilder()
    builder.extend(DRACO)
    primitive = builder.primitive(TRIANGLE)
    extension = {"bufferView": builder.view(b"whatever"), "attributes": {"POSITION": 0}}
    builder.node(mesh=builder.mesh({**primitive, "extensions": {DRACO: extension}}))
    scene = builder.load(tmp_path)
    np.testing.assert_array_equal(scene.meshes[0].positions, TRIANGLE)
    assert len(scene.warnings) == 1
    assert "needs DracoPy (the extra [draco]); the plain data is read" in scene.warnings[0]


def test_a_buffer_of_meshopt_alone_names_it(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.extend("EXT_meshopt_compression")
    gltf = json.loads(builder.gltf())
    fallback = {"EXT_meshopt_compression": {"fallback": True}}
    gltf["buffers"][0] = {"byteLength": 36, "extensions": fallback}
    (tmp_path / "a.gltf").write_text(json.dumps(gltf))
    with pytest.raises(InputError, match=r"buffers\[0\]: is compressed by EXT_meshopt_compressio"):
        load_scene(tmp_path / "a.gltf", default_lights=False)


def test_broken_draco(tmp_path: Path) -> None:
    builder = draco_builder()
    builder.buffer[:5] = b"wrong"
    with pytest.raises(InputError, match="broken Draco data"):
        builder.load(tmp_path)


@pytest.mark.parametrize(
    "name", ["EXT_meshopt_compression", "EXT_mesh_gpu_instancing", "ACME_curved_space"]
)
def test_required_extensions_that_may_change_geometry_are_errors(name: str, tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.extend(name, required=True)
    with pytest.raises(InputError) as caught:
        builder.load(tmp_path)
    file = tmp_path / "scene.glb"
    assert str(caught.value) == f"{file}: extensionsRequired[0]: {name} is not supported"


@pytest.mark.parametrize("required", [True, False])
def test_unsupported_materials_are_one_warning(required: bool, tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.extend("KHR_materials_sheen", required=required)
    expected = "extensionsUsed: KHR_materials_sheen is not supported and ignored"
    assert [w.partition(": ")[2] for w in builder.load(tmp_path).warnings] == [expected]


def test_unknown_optional_extension_is_one_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(TRIANGLE)
    builder.extend("ACME_curved_space")
    builder.extend("KHR_xmp_json_ld")
    assert len(builder.load(tmp_path).warnings) == 1


def test_extensions_that_the_list_lacks_are_one_warning_each(tmp_path: Path) -> None:
    builder = GltfBuilder()
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": {}}}
    builder.add(TRIANGLE, extensions=instancing)
    builder.add(TRIANGLE, extensions=instancing, extras={"extensions": {"ACME_secret": {}}})
    sheen = {"KHR_materials_sheen": {}, "KHR_materials_ior": {"ior": 1.4}}
    builder.append("materials", {"name": "silk", "extensions": sheen})
    told = [warning.partition(": ")[2] for warning in builder.load(tmp_path).warnings]
    assert sorted(told) == [
        f"{place}.extensions: {name} is not supported and ignored; extensionsUsed lacks it"
        for place, name in (("materials[0]", "KHR_materials_sheen"),
                            ("nodes[0]", "EXT_mesh_gpu_instancing"))
    ]  # fmt: skip
