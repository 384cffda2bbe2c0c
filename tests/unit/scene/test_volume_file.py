# PP-11
"""Volumes in scene files: read with every mistake named, saved with comments kept, whole or not."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import shapes
from cli.process import python
from elemental.core.errors import InputError
from elemental.scene.load import load_scene
from elemental.scene.scene_file import parse_scene_file
from elemental.scene.volume_file import volumes_of
from elemental.scene.volume_save import same_volumes, save_volumes, with_volumes
from elemental.scene.volumes import Volume
from gltf_builder import GltfBuilder
from unit.scene.volume_values import volumes

PATH = Path("yard.toml")
HEAD = '# the yard\n[[models]]\nfile = "model.glb"  # ours\n\n'
TAIL = "\n[settings]\n# fast\ngi.resolution = 64  # voxels\n"
VOLUMES = """\
# where it is dark
[[volumes]]
name = "cellar"     # below
shape = "box"
center = [0.0, -2.0, 0.0]   # m
size = [4.0, 2.0, 4.0]
[volumes.settings]
exposure = 2.0      # EV, bright enough
indirect.intensity = 1.5

# by the lamp
[[volumes]]
name = "lamp"
shape = "sphere"
radius = 2.0
settings = { exposure = -1.0, indirect = { color = [1.0, 0.5, 0.25] } }
"""


def read(text: str) -> list[Volume]:
    return volumes_of(parse_scene_file(text, PATH).volumes, PATH)


def mistakes(text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        read(HEAD + text)
    return [line.removeprefix("yard.toml: ") for line in caught.value.lines]


def test_volumes_come_out_of_the_file_as_they_stand(tmp_path: Path) -> None:
    builder = GltfBuilder()
    builder.add(*shapes.box())
    builder.write(tmp_path / "model.glb")
    (tmp_path / "yard.toml").write_text(HEAD + VOLUMES)
    cellar, lamp = load_scene(tmp_path / "yard.toml", default_lights=False).volumes
    assert cellar == Volume(
        "cellar",
        "box",
        center=(0.0, -2.0, 0.0),
        size=(4.0, 2.0, 4.0),
        overrides={"exposure": 2.0, "indirect.intensity": 1.5},
    )
    color = (1.0, 0.5, 0.25)
    assert lamp == Volume(
        "lamp", "sphere", radius=2.0, overrides={"exposure": -1.0, "indirect.color": color}
    )


def test_a_volume_without_a_name_gets_a_free_one() -> None:
    named = read(HEAD + '[[volumes]]\n[[volumes]]\nname = "volume0"\n[[volumes]]\n')
    assert [volume.name for volume in named] == ["volume0.2", "volume0", "volume2"]


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("shape = 'cone'", "volumes[0].shape: should be 'box' or 'sphere'"),
        ("size = [1, 0, 1]", "volumes[0].size[1]: should be greater than 0"),
        ("radius = 1.0", "volumes[0]: a box has a size, not a radius"),
        ("blend_weight = 1.5", "volumes[0].blend_weight: should be 1 or less"),
        ("blend_weight = nan", "volumes[0].blend_weight: should be a finite number"),
        ("priority = -1", "volumes[0].priority: should be 0 or more"),
        ("weight = 1.0", "volumes[0].weight: is an unknown key"),
        ("settings.exposure = 99", "volumes[0].settings.exposure: '99' is not -16 to 16 EV"),
        ("settings.exposure = 'x'", "volumes[0].settings.exposure: 'x' is not -16 to 16 EV"),
        (
            "settings.exposure.x = 1",
            "volumes[0].settings.exposure.x: unknown setting; did you mean",
        ),
        (
            "settings.gi.resolution = 64",
            "volumes[0].settings.gi.resolution: is not a setting that volumes may override",
        ),
        (
            "settings.indirect.color = [1, 0.5]",
            "volumes[0].settings.indirect.color: '[1, 0.5]' is not",
        ),
    ],
)
def test_each_mistake_names_file_and_field(text: str, wrong: str) -> None:
    (line,) = mistakes(f"[[volumes]]\n{text}\n")
    assert line.startswith(wrong)


def test_all_mistakes_come_at_once() -> None:
    bad = "[[volumes]]\nname = 'a'\nsettings.exposure = 99\nsettings.nonsense = 1\n"
    fields = [line.split(":")[0] for line in mistakes(bad + "[[volumes]]\nname = 'a'\n")]
    assert fields == [
        "volumes[0].settings.exposure",
        "volumes[0].settings.nonsense",
        "volumes[1].name",
    ]


def test_saving_changes_the_lines_that_differ_and_no_other() -> None:
    text = HEAD + VOLUMES + TAIL
    cellar, lamp = read(text)
    moved = replace(
        cellar,
        center=(1.0, -2.0, 0.5),
        blend_weight=0.25,
        overrides={"exposure": 3.0, "indirect.intensity": 1.5, "ambient_cubemap.intensity": 0.5},
    )
    dimmed = replace(lamp, overrides={"exposure": -2.0})
    saved = with_volumes(text, [moved, dimmed], PATH)
    assert read(saved) == [moved, dimmed]
    before, after = text.splitlines(), saved.splitlines()
    assert [line for line in before if line not in after] == [
        "center = [0.0, -2.0, 0.0]   # m",
        "exposure = 2.0      # EV, bright enough",
        "settings = { exposure = -1.0, indirect = { color = [1.0, 0.5, 0.25] } }",
    ]
    assert "center = [1.0, -2.0, 0.5]   # m" in after
    assert "exposure = 3.0      # EV, bright enough" in after
    assert after.index("ambient_cubemap.intensity = 0.5") < after.index("# by the lamp")


def test_new_volumes_come_last_and_dropped_ones_go_with_their_table() -> None:
    text = HEAD + VOLUMES + TAIL
    cellar, lamp = read(text)
    new = Volume(
        "new", center=(1.0, 2.0, 3.0), overrides={"exposure": 1.0, "indirect.intensity": 0.0}
    )
    saved = with_volumes(text, [lamp, new], PATH)
    assert read(saved) == [lamp, new]
    assert "cellar" not in saved
    for kept in ("# the yard", "# ours", "# fast", "gi.resolution = 64  # voxels"):
        assert kept in saved
    assert same_volumes(read(with_volumes(saved, [new, cellar, lamp], PATH)), [new, cellar, lamp])
    emptied = with_volumes(saved, [], PATH)
    assert read(emptied) == []
    assert "gi.resolution = 64  # voxels" in emptied


LAYOUTS = {
    "none": HEAD + TAIL,
    "tables": HEAD + VOLUMES + TAIL,
    "dotted": HEAD + """[[volumes]]
name = "a"
settings.exposure = 1.0
settings.indirect.intensity = 2.0
""",
    "inline": """volumes = [{ name = "a", settings = { exposure = 1.0 } }, { name = "b" }]
""" + HEAD,
    "quoted": HEAD + """[[volumes]]
name = "b"
[volumes.settings]
"exposure" = 1.0
"indirect.intensity" = 2.0
""",
    "nested": HEAD + """[[volumes]]
[volumes.settings.indirect]
intensity = 2.0
color = [0, 1, 0]
""" + TAIL,
    "windows": (HEAD + VOLUMES + TAIL).replace("\n", "\r\n"),
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
@settings(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_any_volumes_survive_any_layout(layout: str, data: st.DataObject) -> None:
    text = LAYOUTS[layout]
    names = ["a", "cellar", "volume0", "ü \" \\ '", "b", "lamp"]
    chosen = data.draw(st.lists(st.sampled_from(names), unique=True, max_size=4))
    wanted = [data.draw(volumes(name)) for name in chosen]
    saved = with_volumes(text, wanted, PATH)
    assert same_volumes(read(saved), wanted)
    for kept in ("# the yard", "# ours", *(["# fast", "# voxels"] if "# fast" in text else [])):
        assert kept in saved
    assert with_volumes(saved, wanted, PATH) == saved


@settings(max_examples=200)
@given(st.text(max_size=200), st.dictionaries(st.text(max_size=12), st.integers()))
def test_any_text_is_volumes_or_one_clear_error(text: str, keys: dict[str, int]) -> None:
    lines = "".join(f"{key} = {value}\n" for key, value in keys.items())
    for tried in (f"[[volumes]]\n{text}", f"[[volumes]]\n{lines}", f"[[volumes]]\nsettings.{text}"):
        error = None
        try:
            assert read(HEAD + tried)
        except InputError as raised:
            error = raised
        assert error is None or str(error).startswith("yard.toml: ")


def test_a_link_is_followed_and_an_unwritable_place_is_told(tmp_path: Path) -> None:
    real, link = tmp_path / "real.toml", tmp_path / "link.toml"
    real.write_text(HEAD)
    link.symlink_to(real)
    save_volumes(link, [Volume("a")])
    assert link.is_symlink()
    assert [volume.name for volume in read(real.read_text())] == ["a"]
    with pytest.raises(InputError, match="does not exist"):
        save_volumes(tmp_path / "none.toml", [])


KILLS = 25
KILLED_SAVERS = """
import json, os, random, signal, sys, time
from pathlib import Path
from elemental.scene.save_scene import Changes, save_scene
from elemental.scene.volume_save import save_volumes
from elemental.scene.volumes import Volume
file, kills = Path(sys.argv[1]), int(sys.argv[3])
whole = lambda path, volumes: save_scene(path, path, Changes(volumes=volumes))
save = save_volumes if sys.argv[2] == "volumes" else whole
chance = random.Random(5)
for _ in range(kills):
    saver = os.fork()
    signal.alarm(20)  # of a saver that nobody kills
    while saver == 0:
        for count in (1, 60):
            save(file, [Volume(f"v{i}") for i in range(count)])
    time.sleep(chance.uniform(0.0, 0.1))
    os.kill(saver, signal.SIGKILL)
    os.waitpid(saver, 0)
    print(json.dumps(file.read_text()))
"""


@pytest.mark.parametrize("what", ["volumes", "scene"])
def test_a_kill_in_the_middle_of_a_save_leaves_the_old_or_the_new_file(
    tmp_path: Path, what: str
) -> None:
    file = tmp_path / "yard.toml"
    file.write_text(HEAD + TAIL)
    result = python("-c", KILLED_SAVERS, file, what, KILLS)
    texts = [json.loads(line) for line in result.stdout.splitlines()]
    assert len(texts) == KILLS, result.stderr
    for text in texts:
        assert text.startswith("# the yard")
        assert "gi.resolution = 64  # voxels" in text
    counts = {len(read(text)) for text in texts}
    assert counts <= {0, 1, 60}
    assert counts & {1, 60}
