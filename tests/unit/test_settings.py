"""The settings table and its parsing: every value is in range or one InputError names it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import elemental
from elemental.core.errors import InputError
from elemental.settings import SETTINGS, Setting, Settings


def values_of(setting: Setting) -> st.SearchStrategy[Any]:
    lo, hi = setting.lo, setting.hi
    if setting.kind == "bool":
        return st.booleans()
    if setting.kind == "choice":
        return st.sampled_from(setting.choices)
    if setting.kind == "text":
        return st.text(st.characters(categories=("L", "N", "P")), max_size=20)
    if setting.kind == "int":
        assert lo is not None
        assert hi is not None
        return st.integers(int(lo), int(hi))
    number = st.floats(lo, hi, allow_nan=False, allow_infinity=False)
    return st.tuples(number, number, number) if setting.kind == "color" else number


APP = Path(elemental.__file__).parent
ANY_SETTING = st.sampled_from(list(SETTINGS.values()))
TINT = Setting("test.tint", "color", (1.0, 1.0, 1.0), "a colour", lo=0, hi=1)


@pytest.mark.parametrize("setting", SETTINGS.values(), ids=lambda s: s.key)
def test_a_row_is_complete_and_its_default_is_valid(setting: Setting) -> None:
    assert setting.check(setting.default) == setting.default
    assert setting.parse(setting.value_text(setting.default)) == setting.default
    assert setting.help
    assert "\n" not in setting.help
    assert setting.kind != "choice" or setting.choices
    if setting.kind in ("int", "float", "color"):
        assert setting.lo is not None
        assert setting.hi is not None
        assert setting.lo < setting.hi


def test_every_setting_is_read_somewhere() -> None:
    sources = [p.read_text() for p in APP.rglob("*.py") if p.parent.name != "settings"]
    unread = [key for key in SETTINGS if not any(f'"{key}"' in text for text in sources)]
    assert unread == []


@given(st.data())
def test_every_valid_value_survives_text(data: st.DataObject) -> None:
    setting = data.draw(ANY_SETTING)
    value = data.draw(values_of(setting))
    numbers = {"float": (value,), "color": value}.get(setting.kind, ())
    text = ",".join(map(repr, numbers)) or setting.value_text(value)
    parsed = Settings.parse([f"{setting.key}={text}"])
    assert parsed[setting.key] == (value.strip() if isinstance(value, str) else value)
    assert Settings().replace({setting.key: parsed[setting.key]}) == parsed


def outcome(assignment: str) -> Settings | InputError:
    try:
        return Settings.parse([assignment])
    except InputError as error:
        return error


@given(st.text())
def test_any_text_gives_settings_or_one_line(text: str) -> None:
    result = outcome(text)
    assert isinstance(result, Settings) or str(result).startswith("--set: ")
    assert "\n" not in str(result)


@given(ANY_SETTING, st.text())
def test_any_value_gives_a_checked_value_or_names_its_key(setting: Setting, text: str) -> None:
    result = outcome(f"{setting.key}={text}")
    if isinstance(result, InputError):
        assert result.field == setting.key
    else:
        assert setting.check(result[setting.key]) == result[setting.key]


def test_the_last_assignment_wins_and_the_base_shows_through() -> None:
    base = Settings().replace({"exposure": 2}, "scene.toml")
    settings = Settings.parse(["gi.resolution=64", "gi.resolution = 256"], base)
    assert settings["gi.resolution"] == 256
    assert settings["exposure"] == 2.0
    assert settings.changed() == {"gi.resolution": 256, "exposure": 2.0}
    assert hash(settings) == hash(Settings(settings.changed()))


def test_tables_of_a_scene_file_are_read_nested_or_flat() -> None:
    nested = Settings().replace({"gi": {"enabled": False}, "sky.intensity": 3}, "a.toml")
    assert not nested["gi.enabled"]
    assert nested["sky.intensity"] == 3.0


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("gi.resolution", "--set: gi.resolution: expected key=value"),
        ("gi.resolutoin=64", "unknown setting; did you mean gi.resolution?"),
        ("zzzz=1", "unknown setting; see `elemental list settings`"),
        ("gi.resolution=100", "gi.resolution: '100' is not 64, 128, 256, 512"),
        ("gi.enabled=maybe", "gi.enabled: 'maybe' is not true or false"),
        ("exposure=17", "exposure: '17.0' is not -16 to 16 EV"),
        ("exposure=nan", "exposure: 'nan' is not -16 to 16 EV"),
        ("gi.bounces=1.5", "gi.bounces: '1.5' is not a whole number, 0 to 8 gathers"),
        ("gi.bounces=-1", "gi.bounces: '-1' is not a whole number, 0 to 8 gathers"),
        ("sky.image=\x00", "sky.image: '\\x00' is not text"),
    ],
)
def test_a_bad_assignment_says_what_is_allowed(assignment: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        Settings.parse([assignment])
    assert message in str(error.value)


@pytest.mark.parametrize("value", [True, "64", 64.0, None, [64], 65])
def test_a_scene_file_value_needs_its_own_type(value: object) -> None:
    with pytest.raises(InputError, match=r"^s\.toml: gi\.resolution: "):
        Settings().replace({"gi.resolution": value}, "s.toml")


def test_a_color_is_three_numbers_in_range() -> None:
    assert TINT.parse("1, 0.5,0") == (1.0, 0.5, 0.0)
    assert TINT.check([1, 0, 0]) == (1.0, 0.0, 0.0)
    for text in ("1,0", "1,0,0,0", "1,0,2", "a,b,c", "1,0,nan", ""):
        with pytest.raises(ValueError, match="is not r,g,b"):
            TINT.parse(text)


def test_settings_cannot_be_assigned() -> None:
    with pytest.raises(TypeError):
        Settings()["exposure"] = 1.0  # type: ignore[index]
