"""Materials, textures and the extensions that change them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elemental.scene.load import load_scene
from elemental.scene.model import Material, Scene, TextureSlot
from gltf_builder import GltfBuilder

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
PIXELS = np.random.default_rng(5).integers(0, 256, (4, 3, 4)).astype(np.uint8)
KTX2 = b"\xabKTX 20\xbb\r\n\x1a\n" + bytes(100)


def load(builder: GltfBuilder, folder: Path, name: str = "scene.glb") -> tuple[Scene, Material]:
    """The scene with a triangle of the first material."""
    builder.add(TRIANGLE, material=0, uv0=TRIANGLE[:, :2], uv1=TRIANGLE[:, :2])
    scene = builder.load(folder, name)
    return scene, scene.materials[0]


def test_factors(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.material(
        (0.1, 0.2, 0.3, 0.4), metallic=0.5, roughness=0.6, emissive=(1.0, 0.5, 0.25),
        emissive_strength=20.0, name="steel", doubleSided=True, alphaMode="MASK", alphaCutoff=0.3,
    )  # fmt: skip
    _, material = load(builder, tmp_path)
    np.testing.assert_array_equal(material.base_color, np.array([0.1, 0.2, 0.3, 0.4], "f4"))
    np.testing.assert_array_equal(material.emissive, [20.0, 10.0, 5.0])
    assert (material.metallic, material.roughness) == (0.5, 0.6)
    assert (material.name, material.double_sided) == ("steel", True)
    assert (material.alpha_mode, material.alpha_cutoff) == ("mask", 0.3)
    assert not material.unlit
    assert material.emits


def test_defaults_are_gltfs(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.append("materials", {})
    _, material = load(builder, tmp_path)
    np.testing.assert_array_equal(material.base_color, [1, 1, 1, 1])
    assert (material.metallic, material.roughness, material.alpha_mode) == (1.0, 1.0, "opaque")
    assert not material.emits


@pytest.mark.parametrize(
    ("mode", "expected", "opacity"),
    [("OPAQUE", "opaque", 1.0), ("MASK", "mask", 0.25), ("BLEND", "blend", 0.25)],
)
def test_alpha_modes(mode: str, expected: str, opacity: float, tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.material((1, 1, 1, 0.25), alphaMode=mode)
    _, material = load(builder, tmp_path)
    assert material.alpha_mode == expected
    assert material.base_color[3] == opacity


def test_unlit(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.extend("KHR_materials_unlit", required=True)
    builder.material(extensions={"KHR_materials_unlit": {}})
    assert load(builder, tmp_path)[1].unlit


@pytest.mark.parametrize("name", ["scene.glb", "scene.gltf"])
def test_every_texture(name: str, tmp_path: Path) -> None:
    builder = GltfBuilder()
    slots = [{"index": builder.texture(np.roll(PIXELS, k, axis=0))} for k in range(5)]
    builder.material(
        pbr={"baseColorTexture": slots[0], "metallicRoughnessTexture": slots[1]},
        normalTexture={**slots[2], "scale": 0.5, "texCoord": 1},
        occlusionTexture={**slots[3], "strength": 0.75},
        emissiveTexture=slots[4],
    )
    scene, material = load(builder, tmp_path, name)
    used = [
        material.base_color_texture, material.metallic_roughness_texture,
        material.normal_texture, material.occlusion_texture, material.emissive_texture,
    ]  # fmt: skip
    for k, slot in enumerate(used):
        assert slot is not None
        assert slot.uv_set == (1 if k == 2 else 0)
        np.testing.assert_array_equal(slot.uv_from_uv, np.eye(2, 3))
        np.testing.assert_array_equal(scene.textures[slot.texture].pixels, np.roll(PIXELS, k, 0))
    assert (material.normal_scale, material.occlusion_strength) == (0.5, 0.75)


def test_samplers(tmp_path: Path) -> None:
    builder = GltfBuilder()
    first = builder.texture(PIXELS, sampler={"wrapS": 33071, "wrapT": 33648, "magFilter": 9728})
    second = builder.append("textures", {"source": 0})
    third = builder.append("textures", {"source": 0})
    builder.material(
        pbr={"baseColorTexture": {"index": first}, "metallicRoughnessTexture": {"index": second}},
        emissiveTexture={"index": third},
    )
    scene, _ = load(builder, tmp_path)
    # Textures of one image and one sampler are one.
    assert len(scene.textures) == 2
    clamped, plain = scene.textures
    assert (clamped.wrap_u, clamped.wrap_v, clamped.nearest) == ("clamp", "mirror", True)
    assert (plain.wrap_u, plain.wrap_v, plain.nearest) == ("repeat", "repeat", False)
    assert clamped.pixels is plain.pixels


def base_color_slot(builder: GltfBuilder, folder: Path, **slot: Any) -> TextureSlot:
    texture = builder.texture(PIXELS)
    builder.material(pbr={"baseColorTexture": {"index": texture, **slot}})
    found = load(builder, folder)[1].base_color_texture
    assert found is not None
    return found


def test_texture_transform(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.extend("KHR_texture_transform", required=True)
    transform = {"offset": [0, 1], "rotation": math.pi / 2, "scale": [0.5, 0.5], "texCoord": 1}
    slot = base_color_slot(builder, tmp_path, extensions={"KHR_texture_transform": transform})
    assert slot.uv_set == 1
    # The extension's own example: it shows the lower left quadrant, turned clockwise.
    corners = np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]) @ slot.uv_from_uv.T
    expected = [[0, 1], [0, 0.5], [0.5, 1], [0.5, 0.5]]
    np.testing.assert_allclose(corners, expected, atol=1e-7)


def test_texture_transform_scales_before_it_rotates(tmp_path: Path) -> None:
    transform = {"rotation": math.pi / 2, "scale": [2.0, 3.0]}
    slot = base_color_slot(GltfBuilder(), tmp_path, extensions={"KHR_texture_transform": transform})
    np.testing.assert_allclose(slot.uv_from_uv, [[0, 3, 0], [-2, 0, 0]], atol=1e-6)


def test_jpeg_and_webp(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.extend("EXT_texture_webp", required=True)
    jpeg = builder.texture(np.full((8, 8, 3), 100), "JPEG")
    webp = builder.texture(np.full((8, 8, 3), 200), "WEBP")
    builder.root["textures"][webp] = {"extensions": {"EXT_texture_webp": {"source": 1}}}
    builder.material(pbr={"baseColorTexture": {"index": jpeg}}, emissiveTexture={"index": webp})
    scene, _ = load(builder, tmp_path)
    assert [int(t.pixels[0, 0, 0]) for t in scene.textures] == [100, 200]
    assert scene.warnings == []


def test_external_files_with_escaped_names(tmp_path: Path) -> None:
    builder = GltfBuilder()
    texture = builder.texture(PIXELS)
    view = builder.root["bufferViews"][0]
    png = bytes(builder.buffer[view["byteOffset"] :][: view["byteLength"]])
    (tmp_path / "a b.png").write_bytes(png)
    builder.root["images"][0] = {"uri": "a%20b.png"}
    builder.material(pbr={"baseColorTexture": {"index": texture}})
    scene, _ = load(builder, tmp_path)
    assert scene.textures[0].name == "a b.png"
    np.testing.assert_array_equal(scene.textures[0].pixels, PIXELS)


def test_ktx2_alone_is_one_warning_and_the_factor(tmp_path: Path) -> None:
    (tmp_path / "rock.ktx2").write_bytes(KTX2)
    builder = GltfBuilder()
    builder.append("images", {"uri": "rock.ktx2"})
    for _ in range(2):
        builder.append("textures", {"source": 0})
    builder.material(
        (0.5, 0.5, 0.5, 1.0), pbr={"baseColorTexture": {"index": 0}}, normalTexture={"index": 1}
    )
    scene, material = load(builder, tmp_path)
    assert material.base_color_texture is None
    assert material.normal_texture is None
    assert scene.warnings == [
        f"{tmp_path / 'scene.glb'}: images[0]: rock.ktx2: KTX2 is not supported; "
        "the material's factor is used alone"
    ]


def test_ktx2_with_a_plain_source_is_no_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.extend("KHR_texture_basisu", required=True)
    texture = builder.texture(PIXELS)
    ktx2 = builder.append("images", {"bufferView": builder.view(KTX2)})
    extension = {"KHR_texture_basisu": {"source": ktx2}}
    builder.root["textures"][texture]["extensions"] = extension
    builder.material(pbr={"baseColorTexture": {"index": texture}})
    scene, material = load(builder, tmp_path)
    assert material.base_color_texture is not None
    np.testing.assert_array_equal(scene.textures[0].pixels, PIXELS)
    assert scene.warnings == []


def test_unused_images_are_not_read(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.append("images", {"uri": "missing.png"})
    builder.append("textures", {"source": 0})
    builder.material()
    assert load(builder, tmp_path)[0].textures == []


GLASS = ("KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume")


def glass(tmp_path: Path, *tables: dict[str, Any]) -> tuple[Scene, Material]:
    """A material with the tables of GLASS."""
    builder = GltfBuilder()
    for name in GLASS:
        builder.extend(name, required=True)
    builder.material(extensions=dict(zip(GLASS, tables, strict=False)))
    return load(builder, tmp_path)


def test_transmission_ior_and_volume_are_read(tmp_path: Path) -> None:
    """SH-06: glass as the extensions state it."""
    volume = {
        "thicknessFactor": 0.2,
        "attenuationDistance": 0.5,
        "attenuationColor": [0.9, 0.5, 0.1],
    }
    scene, material = glass(tmp_path, {"transmissionFactor": 0.75}, {"ior": 1.33}, volume)
    assert scene.warnings == []
    assert (material.alpha_mode, material.transmission, material.ior) == ("blend", 0.75, 1.33)
    assert material.transmits
    assert float(material.base_color[3]) == 1.0
    assert (material.thickness, material.attenuation_distance) == (0.2, 0.5)
    np.testing.assert_allclose(material.attenuation_color, [0.9, 0.5, 0.1])


def test_glass_has_the_defaults_of_the_extensions(tmp_path: Path) -> None:
    _, material = glass(tmp_path, {"transmissionFactor": 1.0}, {}, {})
    assert (material.ior, material.thickness, material.attenuation_distance) == (1.5, 0.0, 0.0)
    np.testing.assert_array_equal(material.attenuation_color, 1.0)
    _, opaque = glass(tmp_path, {"transmissionFactor": 0.0})
    assert opaque.alpha_mode == "opaque"


def test_pictures_of_glass_make_it_the_artists_glass(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.extend(GLASS[0])
    slots = [{"index": builder.texture(PIXELS)}, {"index": builder.texture(PIXELS[::-1])}]
    tables = (
        {"transmissionFactor": 1.0, "transmissionTexture": slots[0]},
        {"ior": 9.0},
        {"thicknessFactor": 2.0, "thicknessTexture": slots[1]},
    )
    builder.material(extensions=dict(zip(GLASS, tables, strict=True)))
    scene, material = load(builder, tmp_path)
    assert scene.warnings == []
    assert (material.definition.name, material.ior) == ("glass", 3.0)
    found = [scene.textures[material.textures[name].texture].pixels
             for name in ("transmission_texture", "thickness_texture")]  # fmt: skip
    np.testing.assert_array_equal(found[0], PIXELS)
    np.testing.assert_array_equal(found[1], PIXELS[::-1])


def test_pictures_of_glass_keep_their_place_among_other_models(tmp_path: Path) -> None:
    plain, window = GltfBuilder(), GltfBuilder()
    plain.material(pbr={"baseColorTexture": {"index": plain.texture(PIXELS[::-1])}})
    plain.add(TRIANGLE, material=0)
    plain.write(tmp_path / "plain.glb")
    window.extend(GLASS[0])
    picture = {"index": window.texture(PIXELS)}
    window.material(
        extensions={GLASS[0]: {"transmissionFactor": 1, "transmissionTexture": picture}}
    )
    window.add(TRIANGLE, material=0)
    window.write(tmp_path / "window.glb")
    file = tmp_path / "both.toml"
    file.write_text('[[models]]\nfile = "plain.glb"\n[[models]]\nfile = "window.glb"\n')
    scene = load_scene(file, default_lights=False)
    slot = scene.materials[1].textures["transmission_texture"]
    np.testing.assert_array_equal(scene.textures[slot.texture].pixels, PIXELS)


def test_a_material_that_is_made_glass_is_blended() -> None:
    made = Material("wall").with_value("transmission", 0.5)
    assert made.transmits
    assert not made.with_value("transmission", 0.0).transmits
    assert Material("wall").with_value("transmission", 0.0).alpha_mode == "opaque"


def test_factors_out_of_range_are_clamped_with_a_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.material((1.5, 0.5, -1.0, 1.0), roughness=1.25, metallic=-0.5)
    scene, material = load(builder, tmp_path)
    np.testing.assert_array_equal(material.base_color, [1, 0.5, 0, 1])
    assert (material.roughness, material.metallic) == (1.0, 0.0)
    assert len(scene.warnings) == 3


def test_third_texture_coordinates_are_a_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.material(pbr={"baseColorTexture": {"index": builder.texture(PIXELS), "texCoord": 2}})
    scene, material = load(builder, tmp_path)
    assert material.base_color_texture is None
    assert "TEXCOORD_2 is not supported" in scene.warnings[0]


def test_textures_on_a_mesh_without_their_coordinates_are_one_warning(tmp_path: Path) -> None:
    builder = GltfBuilder()
    texture = builder.texture(PIXELS)
    builder.material(pbr={"baseColorTexture": {"index": texture}},
                     emissiveTexture={"index": texture, "texCoord": 1})  # fmt: skip
    uv = np.zeros((3, 2), np.float32)
    builder.add(TRIANGLE, material=0, uv0=uv)
    builder.add(TRIANGLE, material=0, uv0=uv)
    told = [warning.partition(": ")[2] for warning in builder.load(tmp_path).warnings]
    reason = "a mesh has no TEXCOORD_1: one texel of its textures is all it shows"
    assert told == [f"materials[0]: {reason}"]
