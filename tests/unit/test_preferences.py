"""AP-03: the panel's layout is kept in the user's folder, and a broken file costs nothing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.core.errors import InputError
from elemental.core.user_files import config_folder
from elemental.ui.preferences import Preferences, load, save


def test_the_folder_is_the_platforms(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert config_folder() == tmp_path / "elemental"
    monkeypatch.delenv("XDG_CONFIG_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert config_folder() == tmp_path / ".config" / "elemental"
    monkeypatch.setattr("sys.platform", "darwin")
    assert config_folder() == tmp_path / "Library" / "Application Support" / "elemental"
    monkeypatch.setattr("sys.platform", "win32")
    monkeypatch.setenv("APPDATA", str(tmp_path / "Roaming"))
    assert config_folder() == tmp_path / "Roaming" / "elemental"


def test_what_is_saved_is_loaded(tmp_path: Path) -> None:
    file = tmp_path / "made" / "panel.json"
    kept = Preferences(
        layout="[Window][Settings]\nPos=1,2", scale=1.5, shows_panel=False, hidden=["Log"]
    )
    save(file, kept)
    assert load(file) == kept
    assert load(tmp_path / "missing.json") == Preferences()
    with pytest.raises(InputError):
        save(file / "below" / "panel.json", kept)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)


@given(
    st.one_of(
        st.binary().map(lambda raw: raw),
        JSON.map(lambda value: json.dumps(value).encode()),
        st.fixed_dictionaries(
            {"version": st.just(1), "layout": JSON, "scale": JSON, "hidden": JSON}
        ).map(lambda value: json.dumps(value).encode()),
    )
)
def test_any_file_gives_usable_preferences(
    tmp_path_factory: pytest.TempPathFactory, raw: bytes
) -> None:
    file = tmp_path_factory.getbasetemp() / "panel.json"
    file.write_bytes(raw)
    found = load(file)
    assert isinstance(found.layout, str)
    assert 0.5 <= found.scale <= 4.0
    assert isinstance(found.shows_panel, bool)
    assert all(isinstance(name, str) for name in found.hidden)
