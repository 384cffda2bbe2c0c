"""The path-traced reference: conversion to mitsuba against closed forms, figures, cache."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import mitsuba as mi
import numpy as np
import pytest

mi.set_variant("scalar_rgb")

from elemental.core import transforms  # noqa: E402
from elemental.scene.model import (  # noqa: E402
    Camera,
    Environment,
    FloatArray,
    Instance,
    Light,
    Material,
    Mesh,
    Scene,
    Texture,
    TextureSlot,
)
from reference.cache import cached, fingerprint  # noqa: E402
from reference.metrics import compare, hdr_flip, noise, relative_error  # noqa: E402
from reference.mitsuba_scene import Job, emission_mask, glass_mask, path_trace  # noqa: E402
from reference.sheet import sheet, wrapped  # noqa: E402
from shapes import box  # noqa: E402

JOB = Job((8, 8), 64, 0)


def camera(eye: tuple[float, float, float], target: tuple[float, float, float]) -> Camera:
    view_from_world = transforms.look_at(np.array(eye), np.array(target))
    return Camera("c", transforms.inverse(view_from_world), math.radians(20.0), 0.01)


FRONT = camera((0.0, 0.0, 4.0), (0.0, 0.0, 0.0))


def square(half: float = 1.0) -> Mesh:
    """A square facing +z whose texture stands upright: v grows downwards."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * half
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
    normals, tangents = np.tile([0, 0, 1], (4, 1)), np.tile([1, 0, 0, 1], (4, 1))
    return Mesh(
        "square",
        corners,
        normals.astype(np.float32),
        tangents.astype(np.float32),
        uv,
        uv,
        np.full((4, 4), 255, np.uint8),
        np.array([0, 1, 2, 0, 2, 3], np.uint32),
        0,
    )


def slab(side: float, thickness: float) -> Mesh:
    """A closed box around the origin, thin along z."""
    positions, indices = box((side, side, thickness))
    normals = np.repeat(positions.reshape(6, 4, 3).mean(axis=1), 4, axis=0)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    plain = [np.zeros((24, n), np.float32) for n in (4, 2, 2)]
    white = np.full((24, 4), 255, np.uint8)
    return Mesh("slab", positions, normals, *plain, white, indices, 0)


def scene(material: Material, *lights: Light, texture: Texture | None = None) -> Scene:
    instance = Instance("i", 0, np.eye(4, dtype=np.float32))
    textures = [] if texture is None else [texture]
    return Scene("s", Path("s"), [square()], [instance], [material], textures, list(lights))


def sun(direction: tuple[float, float, float], irradiance: float = math.pi) -> Light:
    unit = np.array(direction, np.float32) / np.float32(np.linalg.norm(direction))
    zero = np.zeros(3, np.float32)
    return Light("sun", "directional", np.ones(3, np.float32), irradiance, zero, unit)


def matte(albedo: float) -> Material:
    color = np.array([albedo, albedo, albedo, 1.0], np.float32)
    return Material("matte", base_color=color, metallic=0.0, roughness=1.0)


def test_a_matte_square_reflects_albedo_over_pi(tmp_path: Path) -> None:
    lit = scene(matte(0.6), sun((0.0, 0.0, -1.0)))
    # The specular lobe of alpha 1 and reflectance 0.04 adds 0.04 / 4 at normal incidence.
    assert path_trace(lit, FRONT, JOB, tmp_path).mean() == pytest.approx(0.6 + 0.01, rel=0.01)


def test_a_point_light_falls_with_the_square_of_its_distance(tmp_path: Path) -> None:
    position, down = np.array([0.0, 0.0, 3.0], np.float32), np.array([0.0, 0.0, -1.0], np.float32)
    lamp = Light("lamp", "point", np.ones(3, np.float32), 9.0 * math.pi, position, down)
    view = camera((0.0, 0.0, 40.0), (0.0, 0.0, 0.0))
    view.fov_y = math.radians(0.2)
    assert path_trace(scene(matte(0.5), lamp), view, JOB, tmp_path).mean() == pytest.approx(
        0.5 + 0.01, rel=0.01
    )


@pytest.mark.parametrize(
    ("direction", "share"),
    [((0.0, -1.0, -1.0), 1.0), ((0.0, 1.0, -1.0), 0.0), ((1.0, 0.0, -1.0), 0.5)],
)
def test_green_in_a_normal_map_is_up(
    tmp_path: Path, direction: tuple[float, float, float], share: float
) -> None:
    pixels = np.tile(np.array([128, 217, 217, 255], np.uint8), (4, 4, 1))
    material = matte(1.0)
    material.normal_texture = TextureSlot(0)
    lit = scene(material, sun(direction), texture=Texture("up", pixels))
    assert path_trace(lit, FRONT, JOB, tmp_path).mean() == pytest.approx(share, abs=0.03)


def test_an_emitter_shows_its_texture_upright(tmp_path: Path) -> None:
    pixels = np.zeros((2, 2, 4), np.uint8)
    pixels[0, 0] = 255  # top left
    material = matte(0.0)
    material.emissive = np.full(3, 2.0, np.float32)
    material.emissive_texture = TextureSlot(0)
    shown = scene(material, texture=Texture("t", pixels, nearest=True))
    image = path_trace(shown, FRONT, JOB, tmp_path)
    assert image[1, 1] == pytest.approx([2.0, 2.0, 2.0])
    assert image[6:, :].max() == 0.0
    assert image[:, 6:].max() == 0.0


@pytest.mark.parametrize("textured", [False, True])
def test_all_of_a_tiled_emitters_light_is_found(tmp_path: Path, textured: bool) -> None:
    """A lamp over a square lights it alike, whatever its uv: even, or with a tiled pattern."""
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[:, ::2, :3] = 0
    lamp = matte(0.0)
    lamp.emissive = np.full(3, 6.0 if textured else 3.0, np.float32)
    if textured:
        lamp.emissive_texture = TextureSlot(0)
    lit = scene(matte(0.8), texture=Texture("stripes", pixels, nearest=True))
    lit.materials.append(lamp)
    above = np.diag(np.array([-1.0, 1.0, -1.0, 1.0], np.float32))
    above[2, 3] = 5.0
    lit.instances.append(Instance("lamp", 1, above))

    def seen(uv_scale: float, uv_offset: float) -> float:
        panel = square()
        panel.material = 1
        panel.uv0 = panel.uv1 = (panel.uv0 * uv_scale + uv_offset).astype(np.float32)
        lit.meshes = [square(), panel]
        return float(path_trace(lit, FRONT, Job((8, 8), 256, 1), tmp_path).mean())

    assert seen(4.0, -1.75) == pytest.approx(seen(1.0, 0.0), rel=0.04)


@pytest.mark.parametrize(
    ("target", "column"), [((0, 0, -1), 2), ((1, 0, 0), 3), ((0, 0, 1), 0), ((-1, 0, 0), 1)]
)
def test_the_sky_stands_as_the_model_says(
    tmp_path: Path, target: tuple[float, float, float], column: int
) -> None:
    radiance = np.zeros((64, 128, 3), np.float32)
    # Quarters about the seam, -x, -z (the middle) and +x, each 32 texels wide.
    quarter = ((np.arange(128) + 16) // 32) % 4
    radiance[:, quarter == column] = 1.0
    empty = scene(matte(0.5))
    empty.meshes[0] = square(1e-3)
    empty.environment = Environment(radiance, np.ones(3, np.float32), 3.0)
    view = camera((0.0, 0.0, 0.0), target)
    view.world_from_view[:3, 3] = [0.0, 50.0, 0.0]
    assert path_trace(empty, view, JOB, tmp_path).mean() == pytest.approx(3.0, rel=0.05)


def test_the_sky_s_rows_lie_where_the_model_has_them(tmp_path: Path) -> None:
    """A wall under one bright row 51 degrees high; mitsuba's own rows begin and end on the poles,
    where it would bring 15 % less light."""
    radiance = np.zeros((16, 32, 3), np.float32)
    radiance[3] = 10.0
    lit = scene(matte(0.8))
    lit.environment = Environment(radiance, np.ones(3, np.float32), 1.0)
    got = path_trace(lit, FRONT, Job((8, 8), 1024, 1), tmp_path).mean()
    # Linear between the rows' centres.
    fine = (np.arange(4096) + 0.5) / 4096 * np.pi
    tent = np.maximum(1.0 - np.abs(fine * 16 / np.pi - 3.5), 0.0)
    irradiance = 2.0 * 10.0 * (tent * np.sin(fine) ** 2).sum() * np.pi / 4096
    assert got == pytest.approx(0.8 / np.pi * irradiance, rel=0.04)  # and some gloss


def test_depth_counts_gathers(tmp_path: Path) -> None:
    lit = scene(matte(0.8))
    lit.environment = Environment(None, np.ones(3, np.float32), 1.0)
    seen = [path_trace(lit, FRONT, Job((4, 4), 256, n), tmp_path).mean() for n in (0, 1, 2)]
    assert seen[0] == 0.0  # no gather: the sky lights nothing
    assert seen[1] == pytest.approx(0.8, abs=0.08)
    assert seen[2] == pytest.approx(seen[1], rel=0.02)  # one square: nothing bounces twice
    assert emission_mask(lit, FRONT, JOB, tmp_path).min() == 1.0


@pytest.mark.parametrize("thickness", [0.0, 0.2])
def test_light_passes_a_pane_and_its_body_absorbs(tmp_path: Path, thickness: float) -> None:
    """A glowing wall through a wall of glass: (1 - R)² k / (1 - R² k²), R of a face, k absorbed.
    SH-06"""
    wall = matte(0.0)
    wall.emissive = np.full(3, 2.0, np.float32)
    pane = Material("pane", metallic=0.0, roughness=0.0, transmission=1.0)
    pane.alpha_mode, pane.thickness = "blend", thickness
    pane.attenuation_color = np.full(3, 0.5, np.float32)
    pane.attenuation_distance = 0.1
    shown = scene(wall)
    shown.materials.append(pane)
    shown.meshes.append(replace(slab(0.6, thickness) if thickness else square(0.3), material=1))
    shown.instances.append(
        Instance("pane", 1, transforms.compose([0, 0, 1], [0, 0, 0, 1], [1, 1, 1]))
    )
    face, kept = 0.04, 0.25 if thickness else 1.0
    image = path_trace(shown, FRONT, Job((8, 8), 512, 0), tmp_path)
    want = 2.0 * (1 - face) ** 2 * kept / (1 - (face * kept) ** 2)
    assert image[4, 4] == pytest.approx(want, rel=0.03)
    mask = glass_mask(shown, FRONT, JOB, tmp_path)[..., 0]
    assert (mask[3:5, 3:5].min(), mask[0].max()) == (1.0, 0.0)


def test_figures_of_known_pictures() -> None:
    reference: FloatArray = np.full((4, 4, 3), 0.5, np.float32)
    mask: FloatArray = np.ones((4, 4), np.float32)
    same = compare(reference, reference, mask)
    assert (same["rmse"], same["energy_ratio"]) == (0.0, pytest.approx(1.0))
    double = compare(reference * 2, reference, mask)
    assert double["energy_ratio"] == pytest.approx(2.0)
    assert double["relative_error"]["p50"] == pytest.approx(1.0)
    assert double["rmse"] == pytest.approx(0.5)
    assert compare(reference, reference, mask * 0) == {"pixels": 0}
    assert hdr_flip(reference, reference) == pytest.approx(0.0, abs=1e-6)
    assert relative_error(reference * 0.5, reference) == pytest.approx(-0.5)
    assert noise(reference * 0.9, reference * 1.1, mask)["p50"] == pytest.approx(0.1, rel=1e-4)
    assert sheet(reference, reference, "t").size[0] == 16


def test_long_titles_stay_over_their_own_picture() -> None:
    grey: FloatArray = np.full((40, 160, 3), 0.5, np.float32)
    title = "atrium gi.resolution=128 gi.bounces=2 eye_adaptation.min_brightness=1"
    lines = wrapped(f"ours: {title} {'x' * 60}", 152)
    assert "".join(lines).replace(" ", "") == f"ours:{title}{'x' * 60}".replace(" ", "")
    pictures = [np.asarray(sheet(grey, grey, words)) for words in ("t", title)]
    assert pictures[0].shape[1] == pictures[1].shape[1]
    tops = [picture.shape[0] - 40 for picture in pictures]
    assert tops[0] < tops[1]
    right = pictures[1][: tops[1], 162:164]  # the gap behind the first
    assert (right == pictures[1][0, 0]).all()


def test_the_cache_knows_what_changed(tmp_path: Path) -> None:
    one, other = scene(matte(0.5)), scene(matte(0.6))
    assert fingerprint(one.materials, JOB) == fingerprint(scene(matte(0.5)).materials, JOB)
    assert fingerprint(one.materials) != fingerprint(other.materials)
    calls: list[int] = []

    def make() -> FloatArray:
        calls.append(1)
        return np.full((2, 2, 3), 0.25, np.float32)

    for _ in range(2):
        assert cached(tmp_path, "key", make) == pytest.approx(0.25)
    assert calls == [1]
