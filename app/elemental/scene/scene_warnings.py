"""What a scene file says to no effect: no mistake that stops it, yet hardly what was meant."""

from __future__ import annotations

from pathlib import Path

from elemental.core.errors import InputError
from elemental.scene.scene_file import SceneFile
from elemental.scene.tables.lights import LightTable

CONE_KEYS = frozenset({"inner_angle_deg", "outer_angle_deg"})
MASK_KEYS = frozenset({"mask_size", "mask_scroll"})
PLACE_KEYS = frozenset({"position", "range"})


def idle_keys(file: SceneFile, path: Path) -> list[str]:
    """A line for each key that the kind of its light has no use for."""
    return [
        str(InputError(path, f"lights[{number}].{key}", f"has no effect: {reason}"))
        for number, table in enumerate(file.lights)
        for key, reason in _idle_keys_of(table).items()
    ]


def _idle_keys_of(table: LightTable) -> dict[str, str]:
    idle: dict[str, str] = {}
    if table.ies is None and table.mask is None:
        idle["roll_deg"] = "there is no ies file and no mask to turn"
    if table.mask is None:
        idle |= dict.fromkeys(sorted(MASK_KEYS), "there is no mask")
    elif table.kind == "spot":
        idle["mask_size"] = "a spot light's mask fills its cone"
    if table.kind != "spot":
        idle |= dict.fromkeys(sorted(CONE_KEYS), f"a {table.kind} light has no cone")
    if table.kind == "directional":
        idle |= dict.fromkeys(sorted(PLACE_KEYS), "a directional light is everywhere")
        if table.mask is not None:
            del idle["position"]
    if table.kind == "point" and table.ies is None:
        idle["direction"] = "a point light without ies shines all round"
    return {key: reason for key, reason in idle.items() if key in table.model_fields_set}


def covered_models(file: SceneFile, path: Path) -> list[str]:
    """A line for each model that stands exactly in one that is there already."""
    moved = {motion.model for motion in file.motions}
    first: dict[str, int] = {}
    lines = []
    for number, table in enumerate(file.models):
        place = repr((table.file, table.translation, table.rotation_deg, table.scale))
        if (table.name or Path(table.file).stem) in moved:
            continue
        if place in first:
            reason = f"stands where models[{first[place]}] of the same file does"
            lines.append(str(InputError(path, f"models[{number}]", reason)))
        first.setdefault(place, number)
    return lines
