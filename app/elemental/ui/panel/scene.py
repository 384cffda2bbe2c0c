"""The scene's tree: models, lights, cameras, volumes, materials; a click shows or goes there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from imgui_bundle import imgui

from elemental.scene.model import FloatArray, Scene
from elemental.ui import icons
from elemental.ui.document import State
from elemental.ui.widgets import Widgets

Kind = Literal["model", "light", "camera", "volume", "material", "region"]
Selection = tuple[Kind, int]
"""What is chosen in the panel: of which kind, which one."""


@dataclass(frozen=True)
class SceneExtent:
    """What is asked of a scene's geometry in each frame, found once."""

    low: FloatArray
    high: FloatArray
    triangles: int

    @classmethod
    def of(cls, scene: Scene) -> SceneExtent:
        """Of a scene as it was opened."""
        return cls(*scene.bounds(), scene.triangle_count)

    @property
    def diagonal(self) -> float:
        """Length, m."""
        return float(np.linalg.norm(self.high.astype(np.float64) - self.low))


def scene_page(
    w: Widgets,
    scene: Scene,
    extent: SceneExtent,
    state: State,
    selection: Selection | None,
    searched: str,
    choose: Callable[[Selection], None],
) -> str:
    """Draw the page; ``choose`` is called with what was clicked. Returns what is searched for."""
    searched = w.search("search", searched)
    size = " x ".join(f"{side:.3g}" for side in extent.high - extent.low)
    w.hint(f"{extent.triangles:,} triangles, {size} m")
    branches: tuple[tuple[str, Kind, str, Sequence[str]], ...] = (
        ("Volumes", "volume", icons.VOLUME, [volume.name for volume in state.volumes]),
        ("Lights", "light", icons.LAMP, [light.name for light in state.lights]),
        ("Cameras", "camera", icons.CAMERA, [camera.name for camera in scene.cameras]),
        ("Materials", "material", icons.MATERIAL, [m.name for m in state.materials]),
        ("Regions", "region", icons.VOLUME, [f"region {k + 1}" for k in range(len(state.regions))]),
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
                w.tell_if_cut(name)
        clipper.end()
    return searched
