"""The G-buffer of known surfaces, read back and decoded. SH-01 SH-02"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.formats import D24S8, RGB10_A2, RGBA8, RGBA16F
from elemental.scene.model import Texture, TextureSlot
from gpu.rig import IDENTITY, UNLIT, MakeRig, Rig, at, camera, material, mesh, read, scene, vector
from shapes import box, quad, sphere

ABOVE = camera(vector(0, 3, 0), vector(0, 0, 0))
CENTER = (32, 48)
HALF_ROUGH_CODE = (np.log2(2 / (128 / 255) ** 4 - 2) + 1) / 19 * 255


def channels(rig: Rig) -> dict[str, np.ndarray]:
    """Each target's centre pixel as the codes that it stores."""
    pixels = {}
    for name in ("scene_color", "a", "b", "c", "d", "depth"):
        g, _, gb = rig.begin()
        pixels[name] = read(g, getattr(gb, name))[CENTER]
    return pixels


def ten_bits(code: int) -> np.ndarray:
    return np.array([code >> shift & 1023 for shift in (0, 10, 20)])


def decoded_normal(code: int) -> np.ndarray:
    n = (ten_bits(code) - 512) / 511
    return n / np.linalg.norm(n)


def test_targets_have_the_slide_s_formats(rig: MakeRig) -> None:
    _, _, gb = rig(scene((mesh(quad()), IDENTITY)), ABOVE).begin()
    formats = [gb.depth, gb.scene_color, gb.a, gb.b, gb.c, gb.d]
    assert [t.format for t in formats] == [D24S8, RGBA16F, RGB10_A2, RGBA8, RGBA8, RGBA8]


def test_a_surface_is_stored_by_the_table(rig: MakeRig) -> None:
    surface = material(
        base_color=vector(0.25, 0.5, 0.04, 1),
        metallic=0.25,
        roughness=0.5,
        emissive=vector(3, 2, 1),
    )
    got = channels(rig(scene((mesh(quad()), IDENTITY), materials=[surface]), ABOVE))
    np.testing.assert_array_equal(got["scene_color"], [3, 2, 1, 1])
    np.testing.assert_array_equal(decoded_normal(int(got["a"])), [0, 1, 0])
    assert int(got["a"]) >> 30 == 1  # default lit
    base = np.array([0.25, 0.5, 0.04])
    diffuse, specular = base * 0.75, 0.04 + 0.25 * (base - 0.04)
    np.testing.assert_allclose(got["b"][:3], np.sqrt(specular) * 255, atol=0.51)
    np.testing.assert_allclose(got["c"][:3], np.sqrt(diffuse) * 255, atol=0.51)
    assert got["b"][3] == 255  # no ambient occlusion
    power = 2 / 0.5**4 - 2
    np.testing.assert_allclose(got["d"][0], (np.log2(power) + 1) / 19 * 255, atol=0.51)


def test_unlit_is_its_base_colour_and_says_so(rig: MakeRig) -> None:
    surface = material(base_color=vector(0.25, 0.5, 0.75, 1), definition=UNLIT)
    got = channels(rig(scene((mesh(quad()), IDENTITY), materials=[surface]), ABOVE))
    np.testing.assert_array_equal(got["scene_color"][:3], [0.25, 0.5, 0.75])
    assert int(got["a"]) >> 30 == 0


def test_normals_follow_a_scaled_and_turned_instance(rig: MakeRig) -> None:
    stretched = IDENTITY.copy()
    stretched[:3, :3] = np.array([[0, 0, 2], [0, 0.5, 0], [-4, 0, 0]])
    world = rig(scene((mesh(sphere(rings=48), smooth=True), stretched)), ABOVE, size=(95, 63))
    g, _, gb = world.begin()
    a = read(g, gb.a)
    points = world.positions()
    hit = np.isfinite(points[..., 0])
    local = points[hit] @ np.linalg.inv(stretched[:3, :3]).T
    want = local @ np.linalg.inv(stretched[:3, :3])
    want /= np.linalg.norm(want, axis=1, keepdims=True)
    got = np.array([decoded_normal(int(code)) for code in a[hit]])
    assert hit.sum() > 1000
    assert np.degrees(np.arccos(np.clip((got * want).sum(axis=1), -1, 1))).max() < 4.0


@pytest.mark.parametrize(
    ("slot", "pixel", "channel", "codes"),
    [
        ("base_color_texture", (128, 255, 0, 255), "c", np.sqrt([0.2159, 1, 0]) * 255),
        ("metallic_roughness_texture", (0, 128, 255, 255), "c", [0, 0, 0]),
        ("metallic_roughness_texture", (0, 128, 255, 255), "d", [HALF_ROUGH_CODE]),
        ("occlusion_texture", (64, 0, 0, 255), "b", [51, 51, 51, 64]),
        ("emissive_texture", (128, 255, 0, 255), "scene_color", [0.2159, 1, 0]),
    ],
)
def test_textures_multiply_their_factors(
    rig: MakeRig, slot: str, pixel: tuple[int, ...], channel: str, codes: Any
) -> None:
    image = Texture("t", np.tile(np.array(pixel, np.uint8), (4, 4, 1)))
    surface = material(metallic=1.0 if "metallic" in slot else 0.0, emissive=vector(1, 1, 1))
    setattr(surface, slot, TextureSlot(0))
    world = scene((mesh(quad()), IDENTITY), materials=[surface], textures=[image])
    got = channels(rig(world, ABOVE))[channel]
    np.testing.assert_allclose(
        got[: len(codes)], codes, rtol=2e-3, atol=0.51 if channel != "scene_color" else 1e-3
    )


def test_a_normal_map_bends_along_tangent_and_bitangent(rig: MakeRig) -> None:
    """Codes 128 +- 60 of 127: the tangent-space normal (60, 30, 100) / 127, normalized."""
    image = Texture("n", np.tile(np.array([188, 158, 228, 255], np.uint8), (4, 4, 1)))
    surface = material(normal_texture=TextureSlot(0))
    plane = mesh(quad())
    plane.tangents[:] = vector(1, 0, 0, -1)
    world = scene((plane, IDENTITY), materials=[surface], textures=[image])
    got = decoded_normal(int(channels(rig(world, ABOVE))["a"]))
    # tangent +x, normal +y, bitangent -cross(y, x) = +z
    want = np.array([60, 100, 30]) / np.linalg.norm([60, 100, 30])
    np.testing.assert_allclose(got, want, atol=2e-3)


def test_texture_transforms_choose_the_texel(rig: MakeRig) -> None:
    pixels = np.zeros((2, 2, 4), np.uint8)
    pixels[..., 3] = 255
    pixels[1, 1] = (255, 255, 255, 255)  # u and v in 0.5..1
    image = Texture("t", pixels, nearest=True)
    plane = mesh(quad(), uv=np.zeros((6, 2), np.float32))
    matrix = np.array([[1, 0, 0.75], [0, 1, 0.75]], np.float32)
    surface = material(base_color_texture=TextureSlot(0, 1, matrix))
    world = scene((plane, IDENTITY), materials=[surface], textures=[image])
    np.testing.assert_array_equal(channels(rig(world, ABOVE))["c"][:3], 255)


def test_culling_and_double_sided_normals(rig: MakeRig) -> None:
    below = camera(vector(0, -3, 0), vector(0, 0, 0))
    got = channels(rig(scene((mesh(quad()), IDENTITY)), below))
    assert got["scene_color"][3] == 0  # its back is culled
    surface = material(double_sided=True)
    got = channels(rig(scene((mesh(quad()), IDENTITY), materials=[surface]), below))
    np.testing.assert_array_equal(decoded_normal(int(got["a"])), [0, -1, 0])


def test_masked_texels_are_cut_out(rig: MakeRig) -> None:
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 0, 3] = 0
    surface = material(alpha_mode="mask", base_color_texture=TextureSlot(0))
    plane = mesh(quad())
    plane.uv0[:, 0] += 0.5
    world = scene(
        (plane, IDENTITY), materials=[surface], textures=[Texture("t", pixels, nearest=True)]
    )
    view = rig(world, ABOVE)
    whole = rig(scene((mesh(quad()), IDENTITY)), ABOVE).positions()
    g, _, gb = view.begin()
    covered = read(g, gb.scene_color)[..., 3] == 1.0
    assert covered[whole[..., 0] > 0.02].all()
    assert not covered[whole[..., 0] < -0.02].any()


def test_instances_of_many_materials_land_where_they_belong(rig: MakeRig) -> None:
    """Batches, shared meshes and base instances: each box shows its own colour."""
    rng = np.random.default_rng(2)
    colors = rng.uniform(0.1, 1.0, (12, 4)).astype(np.float32)
    colors[:, 3] = 1.0
    materials = [
        material(base_color=c, double_sided=bool(n % 2), roughness=0.5)
        for n, c in enumerate(colors)
    ]
    parts = [(mesh(box((0.4, 0.4, 0.4)), n), at(n % 4 - 1.5, 0, n // 4 - 1)) for n in range(12)]
    world = scene(*parts, materials=materials)
    # The first mesh stands at two places.
    world.instances.append(type(world.instances[0])("again", 0, at(0, 0, 0.5)))
    view = rig(world, camera(vector(0, 6, 0), vector(0, 0, 0)), size=(192, 128))
    g, _, gb = view.begin()
    stored = (read(g, gb.c)[..., :3] / 255.0) ** 2
    points = view.positions()
    centers = np.array([part[1][:3, 3] for part in parts] + [[0, 0, 0.5]])
    owners = [*range(12), 0]
    for center, owner in zip(centers, owners, strict=True):
        distance = np.linalg.norm((points - center)[..., [0, 2]], axis=-1)
        near = distance < 0.1
        assert near.sum() > 4
        np.testing.assert_allclose(
            stored[near], np.tile(colors[owner, :3], (near.sum(), 1)), atol=6e-3
        )


@pytest.mark.parametrize("uv_set", [0, 1])
def test_fine_triangles_take_the_same_mip_level_as_coarse_ones(rig: MakeRig, uv_set: int) -> None:
    """Every pixel quad of a fine mesh straddles triangles; its helpers must not spoil the level."""
    checks = np.indices((64, 64)).sum(axis=0) % 2 * 255
    pixels = np.full((64, 64, 4), 255, np.uint8)
    pixels[..., :3] = checks[..., None]
    surface = material(base_color_texture=TextureSlot(0, uv_set))
    shown = []
    for cells in (1, 60):
        x, z = np.meshgrid(*[np.linspace(-1, 1, cells + 1)] * 2)
        points = np.stack([x.ravel(), 0 * x.ravel(), z.ravel()], axis=-1).astype(np.float32)
        corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()[:, None]
        faces = corner + np.array([0, cells + 1, cells + 2, 0, cells + 2, 1])
        plane = mesh((points, faces.astype(np.uint32).ravel()))
        plane.uv0 = (plane.positions[:, [0, 2]] + 1) * 0.2
        plane.uv1 = plane.uv0
        image = Texture("t", pixels)
        view = rig(scene((plane, IDENTITY), materials=[surface], textures=[image]), ABOVE)
        g, _, gb = view.begin()
        shown.append(read(g, gb.c)[..., 0].astype(int))
    assert np.ptp(shown[0]) > 200
    assert np.mean(np.abs(shown[0] - shown[1]) > 40) < 0.01
