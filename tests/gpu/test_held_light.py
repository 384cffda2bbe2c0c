"""Gathered light outlives its frame while nothing that it depends on changes: to the bit, nothing
stale. GI-12, GI-13"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from elemental.frame import Renderer
from elemental.gpu.device import Device, GpuMemoryError
from elemental.passes.cone_trace.held import HeldLight
from elemental.scene.model import Decal, Environment, Region
from elemental.scene.volumes import Volume
from elemental.settings import SETTINGS, Setting
from gpu.artist import Artist
from gpu.moving import EYE, SIZE, stage
from gpu.moving import SETTINGS as SMALL
from gpu.rig import at, camera, material, mesh, vector
from gpu.test_material_motion import TICKING
from gpu.voxel.scenes import glowing, turned
from shapes import quad

Array = npt.NDArray[Any]
TEXTS = frozenset(key for key, setting in SETTINGS.items() if setting.kind == "text")
"""Names of files and animations."""
MOST = 3
"""How far numbers are changed: a thousand shadow maps need more memory than a test may."""
DECAL = np.array([[1, 0, 0, 0], [0, 0, 1, 0.2], [0, -1, 0, 2], [0, 0, 0, 1]], np.float32)
"""world_from_decal: onto the floor of the stage, in view."""

LAMP = at(0.5, 1.8, 0.5) @ turned(vector(1, 0, 0), np.pi)
"""It stands, looks down, and has shadow maps."""


class Viewer:
    """A scene looked at frame by frame."""

    def __init__(self, renderer: Renderer, passes: Callable[[], set[str]]) -> None:
        self.renderer = renderer
        self.eye = EYE
        self.time_s = 0.25
        self._passes = passes

    def frame(self, view: str = "scene_color") -> Array:
        made = self.renderer.render(self.eye, self.time_s, 0, view)
        self.renderer.device.finish()
        return self.renderer.read(made)

    def traces(self) -> bool:
        """Whether the last frame traced cones."""
        return any(name.startswith("cones.") for name in self._passes())

    def check(self, what: str) -> Array:
        """The picture, the same as if voxels were lit and cones traced now."""
        for _ in range(3):  # one takes over what changed; pools may grow with the one after it
            held = self.frame()
            if not self.traces():
                break
        assert not self.traces(), what
        self.renderer.invalidate("light")
        traced = self.frame()
        assert self.traces(), what
        assert np.array_equal(held, traced), what
        return traced


@pytest.fixture
def viewer(device: Device, artist: Artist) -> Iterator[Viewer]:
    world = stage()
    world.environment = Environment(None, vector(0.3, 0.6, 1.0), 1.0)
    ticking = artist.definition(TICKING.replace("animated = true", "animated = false"))
    world.instances.append(
        replace(world.instances[1], mesh=len(world.meshes), world_from_local=LAMP)
    )
    world.meshes.append(mesh(quad(0.6), len(world.materials)))
    world.materials += [glowing(9.0), material(definition=ticking), material(roughness=0.1)]
    *_, worn, polish = range(len(world.materials))
    world.meshes[1] = replace(world.meshes[1], material=worn)
    world.decals = [Decal("polish", polish, DECAL, channels=("roughness",))]
    renderer = Renderer(device, world, SMALL, SIZE)
    yield Viewer(renderer, lambda: {timing.name for timing in device.timings})
    renderer.release()


def other(setting: Setting) -> Any:
    """A value that is not the default."""
    if setting.kind == "bool":
        return not setting.default
    if setting.kind == "choice":
        return next(c for c in setting.choices if c not in (setting.default, SMALL[setting.key]))
    if setting.kind == "color":
        return (0.3, 0.6, 0.9)
    assert setting.lo is not None
    assert setting.hi is not None
    number = type(setting.default)
    higher = number(min(setting.hi, setting.default + MOST))
    return higher if higher != setting.default else number(setting.lo)


def test_no_setting_leaves_stale_light(viewer: Viewer) -> None:
    plain = viewer.check("the defaults")
    changed = set()
    for key, setting in SETTINGS.items():
        if key in TEXTS or key in {"gi.enabled", "gi.bounces"}:
            continue
        viewer.renderer.set_settings(SMALL.replace({key: other(setting)}))
        if not np.array_equal(viewer.check(key), plain):
            changed.add(key)
    assert len(changed) > 15, changed
    assert "gi.area_shadows" in changed
    viewer.renderer.set_settings(SMALL)
    assert np.array_equal(viewer.check("the defaults again"), plain)


def test_nothing_that_changes_leaves_stale_light(viewer: Viewer, artist: Artist) -> None:
    renderer = viewer.renderer
    world = renderer.scene
    floor, polish = 0, world.decals[0].material
    glows = TICKING.replace("animated = true", "animated = false")

    def move(seconds: float) -> None:
        viewer.time_s = seconds

    def look(eye: Any) -> None:
        viewer.eye = eye

    def recolor(index: int, color: Array) -> None:
        renderer.set_material(index, replace(world.materials[index], base_color=color))

    def dim() -> None:
        renderer.set_lights([replace(light, intensity=0.5) for light in world.lights])

    def carry() -> None:
        moved = replace(world.lights[-1], position=vector(-0.5, 1.5, 1.0), node=-1)
        renderer.set_lights([*world.lights[:-1], moved])

    def cloud() -> None:
        world.environment = Environment(None, vector(1.0, 0.2, 0.2), 1.0)

    def surround() -> None:
        around = {"overrides": {"indirect.intensity": 0.25, "ao.intensity": 0.0}, "unbound": True}
        world.volumes = [Volume("dim", **around)]

    def save(text: str) -> None:
        artist.save(text)
        assert renderer.device.reload_changed_shaders() == []

    changes: list[tuple[str, Callable[[], object]]] = [
        ("a camera that moves", lambda: look(camera(vector(1, 3, 5), vector(0, 0.5, 0)))),
        ("time", lambda: move(0.5)),
        ("a material", lambda: recolor(floor, vector(0.1, 0.9, 0.1, 1))),
        ("a decal's material", lambda: renderer.set_material(polish, material(roughness=0.8))),
        ("lights", dim),
        ("a lamp elsewhere", carry),
        ("the sky", cloud),
        ("a volume", surround),
        (
            "a region",
            lambda: renderer.set_regions([Region(vector(-3, -1, -3), vector(0, 3, 3), -1)]),
        ),
        ("an artist's code", lambda: save(glows.replace("fract", "cos"))),
        ("code that ticks", lambda: save(TICKING)),
        ("its time", lambda: move(0.625)),
        ("the size", lambda: renderer.resize((48, 40))),
        ("the same size again", lambda: renderer.resize(SIZE)),
    ]
    before = viewer.check("a still view")
    for what, change in changes:
        change()
        after = viewer.check(what)
        assert what == "its time" or not np.array_equal(before, after), what
        before = after


def test_targets_that_do_not_fit_leave_nothing(
    device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    held, g = HeldLight(device), device.begin_frame()
    before = device.bytes()
    one = 8 * SIZE[0] * SIZE[1]
    monkeypatch.setattr(device, "memory_budget", sum(before.values()) + one)
    for _ in range(2):
        with pytest.raises(GpuMemoryError, match="specular_gi"):
            held.stands(g, SIZE, "key")
    held.release()
    assert device.bytes() == before


def test_a_reloaded_shader_gathers_anew(viewer: Viewer, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer.check("a still view")
    viewer.frame()
    assert not viewer.traces()
    library = viewer.renderer.device.library
    monkeypatch.setattr(library, "version", library.version + 1)  # as of a program replaced
    viewer.frame()
    assert viewer.traces()


def test_a_frame_that_failed_held_nothing(viewer: Viewer, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = viewer.frame()
    viewer.renderer.invalidate("view")
    with monkeypatch.context() as broken:
        broken.setattr(viewer.renderer.device.executor, "run", _fail)
        with pytest.raises(RuntimeError):
            viewer.frame()
    assert np.array_equal(viewer.frame(), expected)
    assert viewer.traces()


def _fail(_: object) -> None:
    raise RuntimeError("lost")
