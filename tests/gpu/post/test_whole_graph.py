"""All effects together: what a frame allocates, sizes down to one pixel, frames that repeat."""

# PP-12: with all others

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.core import transforms
from elemental.gpu.device import Device
from elemental.scene.model import Camera
from elemental.settings import SETTINGS, Settings
from gpu.post.conftest import MakeDarkroom
from gpu.post.darkroom import PLAIN, Darkroom, hdr
from gpu.post.test_dof import depth_at

DEFAULTS: dict[str, Any] = {
    key.replace(".", "__"): SETTINGS[key].default for key in (*PLAIN, "lens_flare.intensity")
}
EVERYTHING: dict[str, Any] = {
    **DEFAULTS,
    "bloom__dirt_mask": "dirt.png",
    "color_grading__lut": "evening.cube",
    "dof__enabled": True,
    "motion_blur__amount": 0.5,
    "grain__intensity": 0.1,
    "grain__jitter": 0.5,
    "scene_color__fringe": 0.5,
}


def passing_by(frame: int) -> Camera:
    x = 0.3 * np.sin(frame)
    matrix = transforms.inverse(transforms.look_at((x, 0, 0), (0.2 * x, 0, -1)))
    return Camera("test", matrix, 0.8, 0.1, 100.0)


def frame(room: Darkroom, number: int, size: tuple[int, int] = (72, 128)) -> Any:
    room.camera = passing_by(number)
    rng = np.random.default_rng(number)
    depth = depth_at(rng.uniform(2.0, 40.0, size))
    return room.develop(hdr(*size, seed=number), number / 30.0, depth)


def test_a_steady_frame_allocates_nothing(darkroom: MakeDarkroom, device: Device) -> None:
    room = darkroom(**EVERYTHING)
    for number in range(12):  # and what earlier tests left in the pool is freed
        frame(room, number)
    before, made = device.bytes(), device.executor.pool.stats.allocations
    for number in range(12, 24):
        frame(room, number)
    assert device.bytes() == before
    assert device.executor.pool.stats.allocations == made


def test_every_effect_runs_when_all_are_on(darkroom: MakeDarkroom) -> None:
    room = darkroom(**EVERYTHING)
    frame(room, 0)
    frame(room, 1)
    names = set(room.passes())
    wanted = ("dof_gather", "motion_blur", "histogram", "adapt", "bloom_threshold", "sprite",
              "ghosts", "tonemap", "fxaa")  # fmt: skip
    assert {f"post/{name}" for name in wanted} <= names


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (2, 1), (3, 5), (17, 1), (64, 3)])
def test_the_smallest_pictures_are_developed(darkroom: MakeDarkroom, size: tuple[int, int]) -> None:
    room = darkroom(**EVERYTHING)
    for number in range(2):
        assert frame(room, number, size).shape == (*size, 4)


def test_sizes_and_settings_may_change_with_each_frame(
    darkroom: MakeDarkroom, device: Device
) -> None:
    """What is given back is freed: after the storm as much is held as after a frame."""
    room = darkroom(**EVERYTHING)
    rng = np.random.default_rng(2)
    switches = ["bloom__intensity", "lens_flare__intensity", "motion_blur__amount",
                "vignette__intensity", "grain__intensity"]  # fmt: skip

    def settle() -> int:
        room.set(**EVERYTHING)
        for number in range(12):
            frame(room, number)
        return sum(device.bytes().values())

    held = settle()
    for number in range(60):
        room.set(**{key: float(rng.integers(0, 2)) for key in switches})
        room.set(dof__enabled=bool(rng.integers(0, 2)), dof__f_stop=float(rng.uniform(1, 8)))
        frame(room, number, (int(rng.integers(1, 40)), int(rng.integers(1, 60))))
    assert settle() == held


def test_the_same_frames_come_out_the_same(darkroom: MakeDarkroom) -> None:
    pictures = [
        [frame(room, number) for number in range(3)]
        for room in (darkroom(**EVERYTHING), darkroom(**EVERYTHING))
    ]
    np.testing.assert_array_equal(*pictures)


def test_pictures_without_numbers_in_them_stay_pictures(darkroom: MakeDarkroom) -> None:
    """A broken texel of the scene does not stay in the eye."""
    room = darkroom(**DEFAULTS)
    pixels = hdr(64, 96)
    clean = room.develop(pixels, 0.0)
    pixels[30:33, 40:43, :3] = np.nan
    room.develop(pixels, 0.1)
    assert np.isfinite(room.eye()["brightness"])
    assert np.abs(room.develop(hdr(64, 96), 20.0).astype(int) - clean).max() <= 1


@pytest.mark.parametrize("on", ["bloom", "lens_flare", "dof", "fringe", "all"])
@pytest.mark.parametrize(("broken", "stands_for"), [(np.nan, 0.0), (-np.inf, 0.0), (np.inf, 65504)])
def test_what_is_no_number_spreads_nowhere(
    darkroom: MakeDarkroom, on: str, broken: float, stands_for: float
) -> None:
    """Broken texels are developed as black ones, overflown ones as the brightest."""
    words = {**EVERYTHING, "fxaa__enabled": False}  # which looks far along an edge
    if on != "all":
        words |= {"bloom__intensity": 0.0, "lens_flare__intensity": 0.0, "grain__jitter": 0.0}
        words |= {"dof__enabled": False, "scene_color__fringe": 0.0}
        chosen = ("dof__enabled", "scene_color__fringe", f"{on}__intensity")
        words |= {key: value for key, value in EVERYTHING.items() if key in chosen and on in key}
    pictures = []
    for value in (broken, stands_for):
        pixels = hdr(48, 64)
        pixels[16:24, 24:32, :3] = value  # whole texels of every smaller picture that reads it
        pictures.append(darkroom(**words).develop(pixels, 0.0).astype(int))
    strayed = np.abs(pictures[0] - pictures[1]).max(axis=-1) > 1
    strayed[14:26, 22:34] = False  # a lookup between texels has one of each
    assert not strayed.any()


def test_defaults_are_the_tables() -> None:
    """The figures that artists know."""
    s = Settings()
    assert [s[f"bloom.size{k}"] for k in range(1, 7)] == [1, 4, 16, 32, 64, 64]
    positions = [s[f"lens_flare.position{k}"] for k in range(1, 9)]
    assert positions == [0.6, 0.53, 0.46, 0.39, 0.31, 0.27, 0.22, 0.15]
    figures = {
        "bloom.intensity": 1, "bloom.threshold": 1, "bloom.dirt_intensity": 1,
        "eye_adaptation.low_percent": 80, "eye_adaptation.high_percent": 98.3,
        "eye_adaptation.min_brightness": 0.03, "eye_adaptation.max_brightness": 2,
        "eye_adaptation.speed_up": 3, "eye_adaptation.speed_down": 1,
        "eye_adaptation.log_min": -8, "eye_adaptation.log_max": 4, "exposure": 0,
        "lens_flare.intensity": 0.25, "lens_flare.bokeh_size": 3, "lens_flare.threshold": 8,
        "film.slope": 0.88, "film.toe": 0.55, "film.shoulder": 0.26, "film.black_clip": 0,
        "film.white_clip": 0.04, "vignette.intensity": 0.4, "grain.intensity": 0,
        "grain.jitter": 0, "scene_color.fringe": 0, "color_grading.intensity": 1,
        "dof.focal_distance": 1000, "dof.f_stop": 4, "dof.near_transition": 300,
        "dof.far_transition": 500, "dof.max_bokeh_size": 15,
    }  # fmt: skip
    assert {key: s[key] for key in figures} == figures
    assert all(SETTINGS[key].volume for key in figures)
