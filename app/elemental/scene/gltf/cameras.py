"""Perspective cameras."""

from __future__ import annotations

import math

import numpy as np

from elemental.scene.gltf.fields import Field
from elemental.scene.model import Camera, FloatArray

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
        world_from_view=_rigid(world_from_local),
        fov_y=lens.need("yfov").number(NARROWEST_FOV, WIDEST_FOV),
        near=near,
        far=far,
        aspect=aspect,
    )


def _rigid(world_from_local: FloatArray) -> FloatArray:
    """The transform without scale, mirroring or shear; -z keeps its direction, y its half plane."""
    z, y = world_from_local[:3, 2].astype(np.float64), world_from_local[:3, 1].astype(np.float64)
    x = np.cross(y, z)
    if not (np.linalg.norm(x) > 0.0 and np.isfinite(x).all()):
        x, z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    z /= np.linalg.norm(z)
    rigid = np.eye(4, dtype=np.float32)
    rigid[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    rigid[:3, 3] = world_from_local[:3, 3]
    return rigid
