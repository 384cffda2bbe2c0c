"""The scene's tree: models, lights, cameras, volumes, materials; a click shows or goes there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from imgui_bundle import imgui

from elemental.scene.model import Scene
from elemental.ui import icons, theme
from elemental.ui.document import State
from elemental.ui.widgets import Widgets

Kind = Literal["model", "light", "camera", "volume", "material"]
Selection = tuple[Kind, int]
"""What is chosen in the panel: of which kind, which one."""


def scene_page(
    w: Widgets,
    scene: Scene,
    state: State,
    selection: Selection | None,
    searched: str,
    choose: Callable[[Selection], None],
) -> str:
    """Draw the page; ``choose`` is called with what was clicked. Returns what is searched for."""
    searched = w.search("search", searched)
    low, high = scene.bounds()
    size = " x ".join(f"{extent:.3g}" for extent in high - low)
    w.text(f"{scene.triangle_count:,} triangles, {size} m", theme.MUTED)
    branches: tuple[tuple[str, Kind, str, Sequence[str]], ...] = (
        ("Volumes", "volume", icons.VOLUME, [volume.name for volume in state.volumes]),
        ("Lights", "light", icons.LAMP, [light.name for light in state.lights]),
        ("Cameras", "camera", icons.CAMERA, [camera.name for camera in scene.cameras]),
        ("Materials", "material", icons.MATERIAL, [m.name for m in state.materials]),
        ("Models", "model", icons.MODEL, [instance.name for instance in scene.instances]),
    )
    for title, kind, icon, names in branches:
        shown = [(k, name) for k, name in enumerate(names) if searched.lower() in name.lower()]
        is_open = kind not in ("model",) or bool(searched)
        if not shown or not w.section(f"{title} {len(shown)}###{title}", is_open):
            continue
        clipper = imgui.ListClipper()
        clipper.begin(len(shown))
        while clipper.step():
            for k, name in shown[clipper.display_start : clipper.display_end]:
                label = f"{icon}  {name or 'unnamed'}##{kind}{k}"
                if imgui.selectable(label, selection == (kind, k))[0]:
                    choose((kind, k))
                w.note(f"{kind} {name}")
        clipper.end()
    return searched
