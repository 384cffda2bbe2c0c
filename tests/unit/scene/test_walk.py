"""PP-11: the volumes of the walk that comes along, by its file alone."""

from __future__ import annotations

import itertools
import tomllib
from pathlib import Path

import numpy as np

from elemental.core.paths import content_root
from elemental.scene.scene_file import flat_settings, parse_scene_file
from elemental.scene.volume_file import volumes_of
from elemental.scene.volume_save import with_volumes
from elemental.scene.volumes import Volume, blend
from elemental.settings import Settings

PATH = content_root() / "scenes" / "atrium_walk.toml"
STEPS = 200
"""On each leg of the walk."""


def volumes(path: Path = PATH) -> tuple[Volume, ...]:
    return tuple(volumes_of(parse_scene_file(path.read_text(), path).volumes, path))


def eyes() -> list[tuple[float, float, float]]:
    """Along the straight lines between the path's keys."""
    keys = [np.array(key["eye"]) for key in tomllib.loads(PATH.read_text())["camera_path"]["keys"]]
    ways = [a + (b - a) * s / STEPS for a, b in itertools.pairwise(keys)
            for s in range(STEPS)]  # fmt: skip
    return [(float(x), float(y), float(z)) for x, y, z in ways]


def test_each_place_is_entered_and_left() -> None:
    for volume in volumes():
        weights = [volume.weight(eye) for eye in eyes()]
        assert max(weights) == 1.0, volume.name
        assert min(weights) == 0.0, volume.name
        assert volume.overrides, volume.name


def test_nothing_jumps_on_the_way() -> None:
    """Between two steps, a few centimetres apart, every number moves by little."""
    settings = Settings(flat_settings(tomllib.loads(PATH.read_text())["settings"]))
    walk = [blend(settings, volumes(), eye) for eye in eyes()]
    driven = sorted({key for volume in volumes() for key in volume.overrides})
    assert {"exposure", "bloom.intensity", "color_grading.lut", "dof.enabled"} <= set(driven)
    for key in driven:
        if not isinstance(settings[key], float | tuple):
            continue
        values = np.array([np.atleast_1d(frame[key]) for frame in walk], np.float64)
        span = np.ptp(values, axis=0).max()
        assert span > 0.0, key
        assert np.abs(np.diff(values, axis=0)).max() <= 0.05 * span, key


def test_saving_one_number_leaves_the_rest_of_the_file() -> None:
    text = PATH.read_text()
    first, *others = volumes()
    moved = Volume(**{**vars(first), "blend_weight": 0.5})
    lines = with_volumes(text, [moved, *others], PATH).splitlines()
    assert [line for line in lines if line not in text.splitlines()] == ["blend_weight = 0.5"]
    assert all(line in lines for line in text.splitlines())
