"""Perspective cameras."""

from __future__ import annotations

import math

from elemental.scene.gltf.fields import Field
from elemental.scene.model import Camera, FloatArray
from elemental.scene.placement import rigid

NARROWEST_FOV = math.radians(0.01)
WIDEST_FOV = math.radians(179.0)


def place_camera(field: Field, name: str, world_from_local: FloatArray) -> Camera | None:
    """The camera at a node; None, with a warning, if it is orthographic."""
    kind = field.need("type").text()
    if kind == "orthographic":
        field.warn("orthographic cameras are not supported; the camera is left out")
        return None
    if kind != "perspective":
        raise field.need("type").error(f"expected perspective or orthographic, not {kind[:20]!r}")
    lens = field.need("perspective")
    near = lens.need("znear").number(0.0)
    far = lens.number_or("zfar", None, 0.0)
    aspect = lens.number_or("aspectRatio", None, 0.0)
    if near == 0.0:
        raise lens.need("znear").error("expected a number greater than 0")
    if far is not None and far <= near:
        raise lens.need("zfar").error(f"is not beyond znear ({far:g} <= {near:g})")
    if aspect == 0.0:
        raise lens.need("aspectRatio").error("expected a number greater than 0")
    return Camera(
        name=name,
        world_from_view=rigid(world_from_local),
        fov_y=lens.need("yfov").number(NARROWEST_FOV, WIDEST_FOV),
        near=near,
        far=far,
        aspect=aspect,
    )
