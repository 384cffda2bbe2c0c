"""The rows of a light's mask: its picture, how large it is, how it drifts, how it is turned."""

from __future__ import annotations

import math
from typing import Any

from elemental.scene.lights import Light
from elemental.settings import Setting
from elemental.ui.images import Place
from elemental.ui.panel.image_row import ImageRow, Images, image_row
from elemental.ui.rows import property_row, vector_row
from elemental.ui.widgets import Widgets

FASTEST = 10.0
"""Masks a second that can be dragged to; faster ones can't be followed by an eye."""
SIZE = Setting(
    "mask_size", "float", 1.0, "of the mask, which repeats over all that the sun meets",
    unit="m", lo=0.01, hi=1000.0,
)  # fmt: skip
ROLL = Setting(
    "roll", "float", 0.0, "of the mask, counterclockwise for who looks along the direction",
    unit="°", lo=-180.0, hi=180.0,
)  # fmt: skip
DRIFT_HELP = "widths and heights of the mask that it drifts in a second, to the right and down"


def mask_rows(
    w: Widgets, images: Images, number: int, light: Light, saved: Light
) -> tuple[dict[str, Any], Any]:
    """Draw the rows of a spot or directional light. Returns (changed fields, gesture)."""
    place = Place("light", number, "mask")
    shines = "what the light shines through: colours, and opacity as darkness"
    image_row(
        w, images, place, ImageRow("Mask", shines, light.mask, place, saved.mask, "the whole light")
    )
    if light.mask is None:
        return {}, None
    changed: dict[str, Any] = {}
    gesture: Any = None
    if light.kind == "directional":
        edit = property_row(w, "mask_size", "Mask size", SIZE, light.mask_size, saved.mask_size)
        if edit is not None:
            changed["mask_size"], gesture = edit
    edit = vector_row(
        w, "mask_scroll", "Mask drift", light.mask_scroll, saved.mask_scroll,
        unit="1/s", help=DRIFT_HELP, lo=-FASTEST, hi=FASTEST,
    )  # fmt: skip
    if edit is not None:
        changed["mask_scroll"], gesture = edit
    here, there = (float(f"{math.degrees(one.roll):.6g}") for one in (light, saved))
    edit = property_row(w, "roll", "Mask roll", ROLL, here, there)
    if edit is not None:
        changed["roll"], gesture = math.radians(edit.value), edit.gesture
    return changed, gesture
