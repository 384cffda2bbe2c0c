"""[[lights]] of scene files: units, colour temperature, photometric files, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import shapes
from elemental.core.errors import InputError
from elemental.scene.blackbody import blackbody_color
from elemental.scene.load import load_scene
from elemental.scene.model import Light
from gltf_builder import GltfBuilder

IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n200 100 0\n"


def lights(folder: Path, text: str) -> list[Light]:
    """What a scene file with these tables holds."""
    model = GltfBuilder()
    model.add(*shapes.quad())
    model.write(folder / "model.glb")
    (folder / "lamp.ies").write_text(IES)
    scene = folder / "scene.toml"
    scene.write_text('[[models]]\nfile = "model.glb"\n' + text)
    return load_scene(str(scene), default_lights=False).lights


POINT = '[[lights]]\nkind = "point"\nposition = [0, 1, 0]\n'
SPOT = '[[lights]]\nkind = "spot"\nposition = [0, 1, 0]\ndirection = [0, -1, 0]\n'
SUN = '[[lights]]\nkind = "directional"\ndirection = [0, -1, 0]\n'


def test_lumens_become_candela(tmp_path: Path) -> None:
    bulb, beam = lights(tmp_path, f"{POINT}lumen = 800\n{SPOT}lumen = 800\nouter_angle_deg = 60\n")
    assert bulb.intensity == pytest.approx(800.0 / (4.0 * math.pi))
    assert beam.intensity == pytest.approx(800.0 / (2.0 * math.pi * 0.5 / 3.0))


def test_a_temperature_colours_and_the_colour_tints_it(tmp_path: Path) -> None:
    lamp = lights(tmp_path, POINT + "temperature = 2700\ncolor = [1, 1, 0.5]\nintensity = 10\n")[0]
    np.testing.assert_allclose(
        lamp.strength, 10.0 * blackbody_color(2700.0) * (1, 1, 0.5), rtol=1e-6
    )


def test_a_photometric_file_gives_shape_and_intensity(tmp_path: Path) -> None:
    own, scaled, lumens, aimed = lights(
        tmp_path,
        f'{POINT}ies = "lamp.ies"\n{POINT}ies = "lamp.ies"\nintensity = 5\n'
        f'{POINT}ies = "lamp.ies"\nlumen = 100\n'
        f'{SPOT}ies = "lamp.ies"\nroll_deg = 90\n',
    )
    assert (own.intensity, scaled.intensity) == (200.0, 5.0)
    np.testing.assert_array_equal(own.direction, [0, -1, 0])
    # 200 cd at the nadir, linear to 100 at 45 degrees and 0 at 90: peak times 1 - angle / 90.
    assert lumens.intensity == pytest.approx(100.0 / (2 * math.pi * (1 - 2 / math.pi)), rel=1e-3)
    assert aimed.roll == pytest.approx(math.pi / 2)
    assert aimed.profile is not None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            POINT + "intensity = -1\n",
            r"lights\[0\].intensity: should be 0 or more",
        ),
        (POINT + "intensity = nan\n", r"lights\[0\].intensity: should be a finite number"),
        (POINT + "range = 0\n", r"lights\[0\].range: should be greater than 0"),
        (POINT + "source_radius = -1\n", r"lights\[0\].source_radius: should be 0 or more"),
        (
            POINT + "temperature = 300\n",
            r"lights\[0\].temperature: should be [0-9]+ or more",
        ),
        (POINT + "temperature = 1e5\n", r"lights\[0\].temperature: should be [0-9]+ or less"),
        (POINT + "lumen = 5\nintensity = 5\n", r"lights\[0\]: intensity and lumen say the same"),
        (SUN + "lumen = 5\n", r"lights\[0\]: a directional light has no lumen"),
        (SUN + 'ies = "lamp.ies"\n', r"lights\[0\]: a directional light has no ies"),
        (POINT + 'ies = "none.ies"\n', r"scene.toml: lights\[0\].ies: none.ies: does not exist"),
        (
            POINT + 'ies = "model.glb"\n',
            r"lights\[0\].ies: model.glb: TILT: is missing: not an IES LM-63 file",
        ),
        (POINT + 'mask = "leaves.png"\n', r"lights\[0\]: a point light has no mask"),
        (SUN + 'mask = "none.png"\n', r"scene.toml: lights\[0\].mask: none.png: does not exist"),
        (SUN + 'mask = "model.glb"\n', r"lights\[0\].mask: model.glb: not a PNG"),
        (SUN + "mask_size = 0\n", r"lights\[0\].mask_size: should be greater than 0"),
        (SUN + "mask_scroll = [1]\n", r"lights\[0\].mask_scroll: "),
        (SPOT + "inner_angle_deg = 50\n", r"lights\[0\]: inner_angle_deg is greater"),
        (SPOT + "outer_angle_deg = 1e-30\nlumen = 9\n", r"outer_angle_deg: should be 0.01 or more"),
        (SPOT + "outer_angle_deg = 95\n", r"lights\[0\].outer_angle_deg: should be 90 or less"),
    ],
)
def test_what_no_light_is_is_refused_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as refused:
        lights(tmp_path, text)
    assert len(refused.value.lines) == 1


def test_a_light_without_radius_or_intensity_is_one(tmp_path: Path) -> None:
    lamp = lights(tmp_path, POINT + "source_radius = 0\nintensity = 0\n")[0]
    assert (lamp.source_radius, lamp.strength.max()) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("text", "warning"),
    [
        (POINT + "roll_deg = 9\n", "lights[0].roll_deg: has no effect: there is no ies file"),
        (POINT + "outer_angle_deg = 9\n", "lights[0].outer_angle_deg: has no effect: a point"),
        (POINT + "direction = [1, 0, 0]\n", "lights[0].direction: has no effect: a point light"),
        (SUN + "range = 5\n", "lights[0].range: has no effect: a directional light is everywhere"),
        (SPOT + "mask_size = 5\n", "lights[0].mask_size: has no effect: there is no mask"),
        (SPOT + "inner_angle_deg = 5\n", None),
        (POINT + 'ies = "lamp.ies"\nroll_deg = 9\ndirection = [1, 0, 0]\n', None),
    ],
)
def test_a_key_of_no_effect_is_warned_of(tmp_path: Path, text: str, warning: str | None) -> None:
    lights(tmp_path, text)
    told = load_scene(tmp_path / "scene.toml", default_lights=False).warnings
    assert len(told) == (warning is not None)
    if warning is not None:
        assert told[0].startswith(f"{tmp_path / 'scene.toml'}: {warning}")


def test_names_of_lights_differ(tmp_path: Path) -> None:
    named = POINT + 'name = "a"\n'
    with pytest.raises(InputError, match=r"lights\[1\]\.name: another light is named 'a'"):
        lights(tmp_path, named * 2)
    both = lights(tmp_path, POINT + POINT + 'name = "point0"\n')
    assert [light.name for light in both] == ["point0.2", "point0"]
