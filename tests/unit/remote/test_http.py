# PP-11
"""Volumes driven over HTTP: what may be written arrives, and nothing else does."""

from __future__ import annotations

from dataclasses import replace
from typing import Any
from urllib.parse import quote

import pytest

from elemental.remote import changes
from elemental.settings import Setting, Settings, values
from unit.remote.client import Rig


@pytest.mark.parametrize(
    ("property", "value", "field"),
    [
        ("weight", 0.25, {"blend_weight": 0.25}),
        ("weight", 1, {"blend_weight": 1.0}),
        ("priority", 3.5, {"priority": 3.5}),
        ("blend_radius", 0, {"blend_radius": 0.0}),
        ("enabled", False, {"enabled": False}),
        ("unbound", True, {"unbound": True}),
        ("exposure", -2, {"overrides": {"exposure": -2.0}}),
        ("exposure", None, {"overrides": {}}),
        ("indirect.intensity", 2, {"overrides": {"exposure": 1.0, "indirect.intensity": 2.0}}),
    ],
)
def test_what_is_put_is_in_the_next_frame(rig: Rig, property: str, value: Any, field: Any) -> None:
    before = list(rig.frame())
    status, answer = rig.put(f"/volumes/cellar/{property}", value)
    assert (status, answer) == (200, {"volume": "cellar", "property": property, "value": value})
    listed = rig.ask("GET", "/volumes/cellar")[1]
    assert rig.frame() == [replace(before[0], **field), before[1]]
    assert rig.ask("GET", "/volumes/cellar")[1] == listed  # told as it was to be, and as it is
    assert rig.frame() is rig.scene.volumes


def test_volumes_are_listed_with_all_that_they_have(rig: Rig) -> None:
    status, answer = rig.ask("GET", "/volumes")
    assert status == 200
    assert answer["volumes"][1] == {
        "name": "the lamp/ü",
        "shape": "sphere",
        "center": [0.0, 0.0, 0.0],
        "rotation_deg": [0.0, 0.0, 0.0],
        "radius": 1.0,
        "weight": 1.0,
        "priority": 1.0,
        "blend_radius": 1.0,
        "enabled": True,
        "unbound": False,
        "settings": {},
    }
    path = f"/volumes/{quote('the lamp/ü', safe='')}"
    assert rig.ask("GET", path) == (200, answer["volumes"][1])
    assert rig.put(f"{path}/weight", 0.5)[0] == 200
    assert rig.frame()[1].blend_weight == 0.5


REFUSED = [
    ("PUT", "/volumes/cellar/weight", "1.5", 400, "is not 0 to 1"),
    ("PUT", "/volumes/cellar/weight", "NaN", 400, "not a JSON value"),
    ("PUT", "/volumes/cellar/weight", "1e999", 400, "is not 0 to 1"),
    ("PUT", "/volumes/cellar/weight", "true", 400, "is not 0 to 1"),
    ("PUT", "/volumes/cellar/weight", "null", 400, "is not 0 to 1"),
    ("PUT", "/volumes/cellar/weight", "9" * 4000, 400, "is not 0 to 1"),
    ("PUT", "/volumes/cellar/weight", "", 400, "not a JSON value"),
    ("PUT", "/volumes/cellar/weight", "[" * 4000, 400, "not a JSON value"),
    ("PUT", "/volumes/cellar/enabled", "1", 400, "is not true or false"),
    ("PUT", "/volumes/cellar/exposure", '"x"', 400, "is not -16 to 16 EV"),
    ("PUT", "/volumes/cellar/indirect.color", "[1, 1]", 400, "is not"),
    ("PUT", "/volumes/cellar/gi.resolution", "64", 404, "no property 'gi.resolution'"),
    ("PUT", "/volumes/cellar/name", '"x"', 404, "no property"),
    ("PUT", "/volumes/cellar/center", "[0, 0, 0]", 404, "no property"),
    ("PUT", "/volumes/attic/weight", "1", 404, "no volume is named 'attic'"),
    ("PUT", "/volumes/cellar", "1", 405, "GET /volumes"),
    ("PUT", "/volumes", "1", 405, "GET /volumes"),
    ("GET", "/volumes/cellar/weight", None, 405, "GET /volumes"),
    ("DELETE", "/volumes/cellar", None, 405, "GET /volumes"),
    ("GET", "/", None, 404, "known are"),
    ("GET", "/../etc/passwd", None, 404, "known are"),
    ("PUT", "/volumes/cellar/weight/x", "1", 404, "known are"),
]


@pytest.mark.parametrize(("method", "path", "body", "status", "reason"), REFUSED)
def test_everything_else_is_refused(
    shared: Rig, method: str, path: str, body: str | None, status: int, reason: str
) -> None:
    before = list(shared.frame())
    got, answer = shared.ask(method, path, body)
    assert got == status
    assert reason in answer["error"]
    assert shared.frame() == before


@pytest.mark.parametrize("token", ["", "x", "ü", "Bearer"])
def test_without_the_token_nothing_is_told_or_done(shared: Rig, token: str) -> None:
    before = list(shared.frame())
    for method, path, body in (("GET", "/volumes", None), ("PUT", "/volumes/cellar/weight", "0")):
        status, answer = shared.ask(method, path, body, token)
        assert (status, list(answer)) == (401, ["error"])
    assert shared.frame() == before


def test_texts_are_those_that_the_scene_names(monkeypatch: pytest.MonkeyPatch, rig: Rig) -> None:
    lut = Setting("test.lut", "text", "", "a LUT", volume=True)
    for module in (changes, values):
        monkeypatch.setattr(module, "SETTINGS", {**values.SETTINGS, "test.lut": lut})
    rig.settings = Settings({"test.lut": "base.cube"})
    named = replace(rig.scene.volumes[1], overrides={"test.lut": "warm.cube"})
    rig.scene.volumes = [rig.scene.volumes[0], named]
    rig.frame()
    for text, status in (("warm.cube", 200), ("base.cube", 200), ("", 200), ("/dev/zero", 400)):
        assert rig.put("/volumes/cellar/test.lut", text)[0] == status


def test_a_connection_serves_many_requests(rig: Rig) -> None:
    connection = rig.connection()
    for step in range(20):
        headers = {"Authorization": f"Bearer {rig.remote.token}"}
        connection.request("PUT", "/volumes/cellar/weight", str(step / 20), headers)
        response = connection.getresponse()
        assert response.status == 200
        response.read()
    connection.close()
    assert rig.frame()[0].blend_weight == 19 / 20
