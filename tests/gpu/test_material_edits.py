"""Edits of artist's materials while they are drawn, broken ones and what is no number. SH-10"""

from __future__ import annotations

import time

import numpy as np
import pytest

from elemental.gpu.device import Device
from elemental.scene.definitions import builtin
from gpu.artist import HALVES, Artist, albedo, draws, emission, halves
from gpu.rig import MakeRig, material, vector

FAULT = """/*
[parameters]
a = { type = "float", default = 1 }
*/
void material(inout Surface s, MaterialInput m, Parameters p) {
    s.albedo = vec3(0.25);
    if (m.position_ws.x > 0.0) s.KEY;
}
"""


def test_a_saved_edit_is_drawn_and_a_broken_one_keeps_the_last(
    rig: MakeRig, artist: Artist, device: Device
) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    artist.save(HALVES.replace("p.left :", "p.left * 2.0 :"))
    assert device.reload_changed_shaders() == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=4e-3)

    artist.save(HALVES.replace("p.left :", "p.lost :"))
    (error,) = device.reload_changed_shaders()
    line = HALVES.splitlines().index("    s.albedo = is_left ? p.left : p.right;") + 1
    assert f"{artist.path}:{line}: error: " in error
    assert "lost" in error
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=4e-3)
    assert device.library.problems() == [error]

    artist.save(HALVES.replace("p.left :", "p.left * 3.0 :"))
    assert device.reload_changed_shaders() == []
    assert device.library.problems() == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.75, abs=6e-3)


def test_an_edited_heading_brings_its_parameters(
    rig: MakeRig, artist: Artist, device: Device
) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    wider = HALVES.replace("[parameters]", '[parameters]\ngain = { type = "float", default = 3 }')
    artist.save(wider.replace("p.left :", "p.left * p.gain :"))
    assert device.reload_changed_shaders() == []
    view.gpu.update(None)
    assert len(view.gpu.changes) == 1
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.75, abs=6e-3)
    worn = view.scene.materials[0]
    view.gpu.set_material(0, worn.with_value("gain", 2))
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=6e-3)

    view.gpu.update(None)
    artist.save(wider.replace("default = 3", "default = three"))
    (error,) = device.reload_changed_shaders()
    assert str(artist.path) in error
    assert "heading: is broken TOML" in error
    view.gpu.update(None)
    assert view.gpu.changes == []
    assert albedo(view)[left].mean(axis=0)[0] == pytest.approx(0.5, abs=6e-3)


def test_one_that_never_compiled_is_loud(rig: MakeRig, artist: Artist, device: Device) -> None:
    view = draws(rig, artist, HALVES.replace("p.left", "p.lost"))
    shown = emission(view)[np.isfinite(view.positions()[..., 0])]
    squares = np.unique(shown[:, 0].round(2))
    np.testing.assert_allclose(squares, [0.05, 1.0])
    np.testing.assert_allclose(shown[:, 1], 0.0)
    np.testing.assert_allclose(shown[:, 2], shown[:, 0])
    assert any("lost" in problem for problem in device.library.problems())
    artist.save(HALVES)
    assert device.reload_changed_shaders() == []
    left, _ = halves(view)
    np.testing.assert_allclose(albedo(view)[left].mean(axis=0), [0.25, 0, 0], atol=3e-3)
    assert device.library.problems() == []


@pytest.mark.parametrize(
    "fault",
    [
        "albedo = vec3(sqrt(-p.a))",
        "emissive = vec3(p.a / (p.a - 1.0))",
        "roughness = log(-p.a)",
        "normal_ts = normalize(vec3(p.a - 1.0))",
    ],
)
def test_what_is_no_number_is_shown_and_named(
    rig: MakeRig, artist: Artist, device: Device, fault: str
) -> None:
    view = draws(rig, artist, FAULT.replace("KEY", fault), emissive=vector(1, 1, 1))
    left, right = halves(view)
    shown = emission(view)
    assert shown[left].max() == 0.0
    assert set(shown[right][:, 0].round(2).tolist()) == {np.float32(0.05), np.float32(1.0)}
    assert shown[right][:, 1].max() == 0.0
    g = device.begin_frame()
    view.gpu.materials.watch_faults(g)
    g.execute()
    device.finish()
    (line,) = view.gpu.materials.faults()
    assert "draft.glsl: material 'test': writes what is no finite number" in line
    view.gpu.set_material(0, material(definition=builtin("standard")))
    g = device.begin_frame()
    view.gpu.materials.watch_faults(g)
    g.execute()
    device.finish()
    assert view.gpu.materials.faults() == []


def test_a_watched_folder_tells_of_edits(rig: MakeRig, artist: Artist, device: Device) -> None:
    view = draws(rig, artist)
    left, _ = halves(view)
    device.watch_shaders()
    try:
        time.sleep(0.3)  # until the watch is set up
        device.reload_changed_shaders()
        artist.save(HALVES.replace("p.left :", "p.left * 2.0 :"))
        for _ in range(100):
            device.reload_changed_shaders()
            if albedo(view)[left].mean(axis=0)[0] > 0.45:
                break
            time.sleep(0.05)
        else:
            pytest.fail("the edit was never taken up")
    finally:
        device.stop_watching_shaders()


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("float alone() { return 1.0; }", "{path}: has no function `void material("),
        ("// void material(inout Surface s)", "{path}: has no function `void material("),
        ("void material(inout Surface s) { s.albedo = vec3(1.0); }", "{path}: lib/material.glsl:"),
        ('#include "lib/gone.glsl"', "{path}:5: can't read lib/gone.glsl: No such file"),
        ('#include "lib"', "{path}:5: can't read lib: Is a directory"),
    ],
    ids=["no function", "in a comment", "other arguments", "no such include", "a folder"],
)
def test_what_a_material_lacks_is_told_by_its_own_file(
    rig: MakeRig, artist: Artist, device: Device, code: str, told: str
) -> None:
    heading = "\n".join(FAULT.splitlines()[:4])
    good = "\nvoid material(inout Surface s, MaterialInput m, Parameters p) {}\n"
    text = f"{heading}\n{code}{good if '#include' in code else ''}\n"
    albedo(draws(rig, artist, text))
    (problem, *_) = device.library.problems()
    assert problem.startswith(told.format(path=artist.path))
    assert "/glsl/" not in problem.replace(str(artist.path), "")
