"""AP-03: saving into a scene file: what changed, in its place; comments and the rest stay."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core.errors import InputError
from elemental.scene.save_scene import save_scene
from elemental.scene.scene_file import flat_settings

MODELS = '[[models]]\nfile = "m/a.glb"  # the house\n'

LAYOUTS = {
    "none": f"# top\n{MODELS}",
    "quoted": f'# top\n{MODELS}\n[settings]\n"gi.bounces" = 2   # two\nexposure = 1.0  # bright\n',
    "dotted": f"# top\n{MODELS}\n[settings]  # ours\ngi.bounces = 2   # two\ngi.enabled = true\n",
    "tables": f"# top\n{MODELS}\n[settings]\n# gi\n[settings.gi]\nbounces = 2  # two\n\n"
    "[environment]\n",
    "inline": f"settings = {{ gi = {{ bounces = 2 }}, exposure = 1.0 }}  # ours\n{MODELS}# end\n",
    "top": f"settings.gi.bounces = 2  # two\nsettings.exposure = 1.0\n{MODELS}# end\n",
}
VALUES: dict[str, st.SearchStrategy[Any]] = {
    "gi.bounces": st.integers(0, 8),
    "gi.enabled": st.booleans(),
    "exposure": st.floats(-16, 16),
    "sky.image": st.text(st.characters(codec="utf-8", exclude_categories=("C",)), max_size=20),
    "indirect.color": st.tuples(*[st.floats(0, 1)] * 3),
    "shadow.resolution": st.sampled_from([256, 512]),
}
SETTINGS = st.fixed_dictionaries({}, optional=VALUES)


def comments(text: str) -> list[str]:
    """The comments of a file whose strings hold no number sign."""
    return [line.partition("#")[2] for line in text.splitlines() if "#" in line]


@pytest.mark.parametrize("layout", LAYOUTS)
@given(settings=SETTINGS)
def test_what_is_assigned_is_read_back_and_the_rest_stays(
    tmp_path_factory: pytest.TempPathFactory, layout: str, settings: dict[str, Any]
) -> None:
    path = tmp_path_factory.getbasetemp() / f"{layout}.toml"
    path.write_text(LAYOUTS[layout])
    before = tomllib.loads(LAYOUTS[layout])
    save_scene(path, path, settings)
    after = tomllib.loads(path.read_text())
    expected = flat_settings(before.get("settings", {}))
    expected |= {k: list(v) if isinstance(v, tuple) else v for k, v in settings.items()}
    assert flat_settings(after.get("settings", {})) == expected
    assert after["models"] == before["models"]
    if "#" not in str(settings.get("sky.image")):
        assert comments(path.read_text()) == comments(LAYOUTS[layout])


def test_nothing_changed_leaves_every_byte(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["dotted"])
    save_scene(path, path, {})
    assert path.read_text() == LAYOUTS["dotted"]


def test_a_model_is_saved_as_a_scene_that_names_it(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    save_scene(tmp_path / "models" / "a.glb", tmp_path / "a.toml", {"exposure": 1.5})
    written = tomllib.loads((tmp_path / "a.toml").read_text())
    assert written == {"models": [{"file": "models/a.glb"}], "settings": {"exposure": 1.5}}


def test_saved_elsewhere_it_names_the_same_files(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    here = tmp_path / "here.toml"
    here.write_text(f'{MODELS}[environment]\nfile = "sky.hdr"\n')
    save_scene(here, tmp_path / "there" / "b.toml", {})
    written = tomllib.loads((tmp_path / "there" / "b.toml").read_text())
    assert written["models"][0]["file"] == "../m/a.glb"
    assert written["environment"]["file"] == "../sky.hdr"


def test_what_can_not_be_written_is_refused_and_leaves_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LAYOUTS["none"])
    with pytest.raises(InputError, match="a scene is saved as"):
        save_scene(path, tmp_path / "a.glb", {})
    with pytest.raises(InputError, match="can't be written"):
        save_scene(path, tmp_path / "nowhere" / "a.toml", {})
    path.write_text("models = 3 = 4")
    with pytest.raises(InputError, match="broken"):
        save_scene(path, path, {"exposure": 1.0})
    assert [p.name for p in tmp_path.iterdir()] == ["a.toml"]
