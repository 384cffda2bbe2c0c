"""Mutated glTF files: a scene that holds together, or an InputError; never anything else."""

from __future__ import annotations

import json
import random
import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import shapes
from elemental.core.errors import InputError
from elemental.scene import extent
from elemental.scene.evaluate import evaluate
from elemental.scene.load import load_scene
from elemental.scene.model import Scene
from gltf_builder import GltfBuilder

INPUTS_AN_EXAMPLE = 10

FUZZ = settings(
    max_examples=150,
    deadline=None,
    database=None,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
)


def seed() -> GltfBuilder:
    """A file of a few hundred bytes of geometry that passes through every reader."""
    builder = GltfBuilder()
    texture = builder.texture(np.zeros((2, 2, 3)), sampler={"wrapS": 33071, "magFilter": 9729})
    transform = {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1, "scale": [2, 2]}}
    slot = {"index": texture, "texCoord": 0, "extensions": transform}
    material = builder.material(
        emissive=(1, 1, 1), emissive_strength=2.0, pbr={"baseColorTexture": slot},
        normalTexture={"index": texture, "scale": 0.5}, alphaMode="MASK", alphaCutoff=0.5,
        occlusionTexture={"index": texture, "strength": 1}, doubleSided=True, name="m",
    )  # fmt: skip
    positions, indices = shapes.quad()
    mesh = builder.mesh(
        builder.primitive(
            positions, indices.astype(np.uint8), uv0=positions[:, ::2], material=material,
            normals=np.tile(np.array([0, 1, 0], np.float32), (4, 1)),
            colors=np.full((4, 4), 200, np.uint8),
        ),
        builder.primitive(positions, mode=5, uv1=positions[:, :2]),
    )  # fmt: skip
    builder.root["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": builder.view(b"\1"), "componentType": 5121},
        "values": {"bufferView": builder.view(bytes(12))},
    }
    child = builder.node(root=False, mesh=mesh, scale=[-1, 1, 2], rotation=[0, 0, 0, 1])
    builder.node(children=[child], translation=[1, 2, 3])
    builder.node(mesh=mesh, matrix=np.eye(4).reshape(-1).tolist())
    builder.light("spot", {"spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}, "range": 5})
    builder.camera(name="cam")
    skinned = builder.skinned(builder.primitive(positions, mode=5), np.zeros((4, 4)), np.eye(4))
    bent = builder.morphed(skinned, {"positions": positions, "normals": positions})
    mover = builder.node(mesh=mesh)
    skin = builder.skin([mover], np.eye(4)[None])
    body = builder.node(mesh=builder.mesh(bent, weights=[0.5]), skin=skin)
    builder.animation((mover, "rotation", [0, 1], np.eye(4)[2:]), (body, "weights", [1], [1]))
    cubic = np.arange(18).reshape(6, 3)
    builder.animation((mover, "scale", [0, 2], cubic), interpolation="CUBICSPLINE")
    return builder


SEED = seed()
SEED_GLB = SEED.glb()
SEED_TEXT = SEED.gltf()
FEW_MOMENTS = {"SAMPLES": 16, "PHASE_SAMPLES": 8}
"""Of a motion: how many are looked at says nothing of what is refused."""
JSON_LENGTH = struct.unpack_from("<I", SEED_GLB, 12)[0]


def check(scene: Scene) -> None:
    """What the renderer relies on."""
    for mesh in scene.meshes:
        count = len(mesh.positions)
        for name, width in {
            "positions": 3, "normals": 3, "tangents": 4, "uv0": 2, "uv1": 2, "colors": 4,
        }.items():  # fmt: skip
            array = getattr(mesh, name)
            assert array.shape == (count, width), name
            assert np.isfinite(array).all(), name
        assert len(mesh.indices) % 3 == 0
        assert mesh.indices.max() < count
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-4)
        np.testing.assert_allclose(np.linalg.norm(mesh.tangents[:, :3], axis=1), 1.0, atol=1e-4)
        assert (np.abs(mesh.tangents[:, 3]) == 1.0).all()
        assert mesh.material < len(scene.materials)
    for material in scene.materials:
        assert np.isfinite(material.base_color).all()
        assert np.isfinite(material.emissive).all()
        for slot in (material.base_color_texture, material.normal_texture):
            assert slot is None or slot.texture < len(scene.textures)
    for instance in scene.instances:
        assert instance.mesh < len(scene.meshes)
        assert np.isfinite(instance.world_from_local).all()
        if instance.dynamic:
            assert instance.node >= 0 or instance.skin >= 0
    if scene.motion is not None:
        pose = evaluate(scene, 0.7)
        assert np.isfinite(pose.world_from_local[pose.visible]).all()
    for light in scene.lights:
        assert np.linalg.norm(light.direction) == pytest.approx(1.0, abs=1e-5)
    for camera in scene.cameras:
        rotation = camera.world_from_view[:3, :3]
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-5)
    assert np.isfinite(scene.bounds()).all()
    assert all(line.isprintable() for line in scene.warnings + scene.notes)


@pytest.fixture(autouse=True)
def few_moments(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, count in FEW_MOMENTS.items():
        monkeypatch.setattr(extent, name, count)


def load_or_refuse(path: Path, encoded: bytes) -> None:
    path.write_bytes(encoded)
    refusal = ""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            check(load_scene(path, default_lights=True))
        except InputError as error:
            refusal = str(error)
    assert "\n" not in refusal
    assert refusal.startswith(str(path)) or not refusal


def test_the_seed_is_fine(tmp_path: Path) -> None:
    path = SEED.write(tmp_path / "seed.glb")
    scene = load_scene(path, default_lights=True)
    check(scene)
    assert scene.warnings == []
    assert len(scene.meshes) == 5
    assert [i.dynamic for i in scene.instances].count(True) == 3


def mutated_bytes(rng: random.Random) -> bytes:
    encoded = bytearray(SEED_GLB)
    for _ in range(rng.randint(1, 4)):
        # Half of the edits hit the binary chunk, where most of them still parse.
        low = min(rng.choice([0, 20 + JSON_LENGTH]), len(encoded) - 1)
        at = rng.randint(low, len(encoded) - 1)
        edit = rng.choice(["set", "flip", "float", "float", "cut", "insert"])
        if edit == "set":
            encoded[at] = rng.randrange(256)
        elif edit == "flip":
            encoded[at] ^= 1 << rng.randrange(8)
        elif edit == "float":
            value = rng.choice([np.nan, np.inf, 3e38, -3e38, 1e-45, 1e30, 0.0])
            encoded[at // 4 * 4 : at // 4 * 4 + 4] = struct.pack("<f", value)
        elif edit == "cut":
            del encoded[at : at + rng.randint(1, 8)]
        else:
            encoded[at:at] = rng.randbytes(rng.randint(1, 4))
    return bytes(encoded)


STRANGE: list[Any] = [
        None, True, False, 0, 1, 2, 3, 4, 5, 7, -1, 1.5, 2.0, 255, 5121, 5126, 65536, 2**31, 2**63,
        10**400, 1e-300, 1e39, -1e38, 3e38, "", "a", "data:,", "data:;base64,AAAA", "\ud800",
        "http://x/y", "../..", "%00", "OPAQUE", "BLEND", "VEC4", "SCALAR", "point", "directional",
        [], [0], [1, 2, 3], [0, 0, 0], [1e20, 0, 0], [0, 0, 0, 0], [0.0] * 16, [[]], {}, {"a": 1},
    ]  # fmt: skip


def places(value: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The path of every value inside a JSON value."""
    children = value.items() if isinstance(value, dict) else enumerate(value)
    found = []
    for key, child in children if isinstance(value, dict | list) else ():
        found.append((*at, key))
        found += places(child, (*at, key)) if isinstance(child, dict | list) else []
    return found


PLACES = places(json.loads(SEED_TEXT))


def mutated_json(rng: random.Random) -> bytes:
    root = json.loads(SEED_TEXT)
    for _ in range(rng.randint(1, 3)):
        *path, last = rng.choice(PLACES)
        owner: Any = root
        try:
            for key in path:
                owner = owner[key]
            if rng.randrange(5) == 0:
                del owner[last]
            else:
                owner[last] = rng.choice(STRANGE)
        except (KeyError, IndexError, TypeError):
            continue  # an earlier edit took the place away
    return json.dumps(root).encode()


@FUZZ
@given(seed=st.integers(0, 2**32))
@pytest.mark.parametrize(("name", "mutated"), [("a.glb", mutated_bytes), ("a.gltf", mutated_json)])
def test_mutations(
    name: str,
    mutated: Callable[[random.Random], bytes],
    seed: int,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    rng = random.Random(seed)
    for _ in range(INPUTS_AN_EXAMPLE):
        load_or_refuse(tmp_path_factory.getbasetemp() / name, mutated(rng))
