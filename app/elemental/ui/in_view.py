"""Things of the scene drawn over its picture: outlines of volumes, and the gizmo that moves one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from imgui_bundle import imgui, imguizmo

from elemental.core import transforms
from elemental.passes.camera_view import clip_range
from elemental.scene.model import Camera, FloatArray
from elemental.scene.volumes import Volume, rotation_rows
from elemental.ui import theme
from elemental.ui.words import Rect

gizmo = imguizmo.im_guizmo
OPERATIONS = {
    "Move": gizmo.OPERATION.translate,
    "Rotate": gizmo.OPERATION.rotate,
    "Scale": gizmo.OPERATION.scale,
}
GIZMO_SIZE = 0.17
"""Of the picture's height, about; ImGuizmo's own 0.1 is hard to hit in a docked view."""
SMALLEST_M = 1e-3
CIRCLE_STEPS = 48
LEAST_W = 1e-4
"""Lines are cut where they come this near to the eye's plane, m."""

Points = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Lens:
    """How the picture shows the world: matrices, and its place on the window."""

    view_from_world: FloatArray
    clip_from_view: FloatArray
    place: Rect

    @classmethod
    def of(cls, camera: Camera, bounds: tuple[FloatArray, FloatArray], place: Rect) -> Lens:
        """The lens of a frame that fills ``place``."""
        aspect = max(place[2] - place[0], 1.0) / max(place[3] - place[1], 1.0)
        near, far = clip_range(camera, bounds)
        return cls(
            transforms.inverse(camera.world_from_view),
            transforms.perspective(camera.fov_y, aspect, near, far),
            place,
        )

    def lines(self, starts: Points, ends: Points) -> list[tuple[float, float, float, float]]:
        """World-space lines (N, 3) as (x0, y0, x1, y1) px, cut at the eye's plane."""
        clip_from_world = (self.clip_from_view @ self.view_from_world).astype(np.float64)
        found = []
        one = np.ones((len(starts), 1))
        a_all = np.hstack([starts, one]) @ clip_from_world.T
        b_all = np.hstack([ends, one]) @ clip_from_world.T
        for a, b in zip(a_all, b_all, strict=True):
            if a[3] < LEAST_W and b[3] < LEAST_W:
                continue
            if min(a[3], b[3]) < LEAST_W:
                cut = a + (b - a) * (LEAST_W - a[3]) / (b[3] - a[3])
                a, b = (cut, b) if a[3] < LEAST_W else (a, cut)  # noqa: PLW2901
            found.append((*self._pixel(a), *self._pixel(b)))
        return found

    def _pixel(self, clip: Points) -> tuple[float, float]:
        left, top, right, bottom = self.place
        x, y = clip[0] / clip[3], clip[1] / clip[3]
        return (
            left + (0.5 + 0.5 * float(x)) * (right - left),
            top + (0.5 - 0.5 * float(y)) * (bottom - top),
        )


def draw_volumes(lens: Lens, volumes: Sequence[Volume], chosen: int) -> None:
    """Outlines: the chosen one bright, with the reach of its blend radius."""
    canvas = imgui.get_background_draw_list()
    left, top, right, bottom = lens.place
    canvas.push_clip_rect(imgui.ImVec2(left, top), imgui.ImVec2(right, bottom), True)
    for number, volume in enumerate(volumes):
        if volume.unbound:
            continue
        lit = number == chosen
        hue = theme.ACCENT if lit else theme.TEXT
        _draw(canvas, lens, outline(volume, 0.0), theme.packed(hue, 0.9 if lit else 0.35))
        if lit and volume.blend_radius > 0.0:
            _draw(canvas, lens, outline(volume, volume.blend_radius), theme.packed(hue, 0.3))
    canvas.pop_clip_rect()


def outline(volume: Volume, margin_m: float) -> tuple[Points, Points]:
    """(starts, ends), (N, 3) m each, of the lines around a volume grown by a margin."""
    turned = np.array(rotation_rows(volume.rotation_deg), np.float64)
    center = np.array(volume.center, np.float64)
    if volume.shape == "sphere":
        angles = np.linspace(0.0, math.tau, CIRCLE_STEPS + 1)
        ring = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
        rings = [np.roll(ring, shift, axis=1) * (volume.radius + margin_m) for shift in range(3)]
        starts = np.vstack([points[:-1] for points in rings])
        ends = np.vstack([points[1:] for points in rings])
        return starts + center, ends + center
    half = np.array(volume.size, np.float64) / 2 + margin_m
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = (signs * half) @ turned.T + center
    edges = [
        (a, b) for a in range(8) for b in range(a + 1, 8) if np.abs(signs[a] - signs[b]).sum() == 2
    ]
    return corners[[a for a, _ in edges]], corners[[b for _, b in edges]]


def _draw(canvas: imgui.ImDrawList, lens: Lens, lines: tuple[Points, Points], hue: int) -> None:
    for x0, y0, x1, y1 in lens.lines(*lines):
        canvas.add_line(imgui.ImVec2(x0, y0), imgui.ImVec2(x1, y1), hue, 1.5)


def begin_gizmo() -> None:
    """Once a frame, before any widget."""
    gizmo.begin_frame()


def gizmo_has_mouse() -> bool:
    """Whether the mouse is on a handle of the gizmo, or drags one."""
    return bool(gizmo.is_over() or gizmo.is_using())


def draw_gizmo(lens: Lens, volume: Volume, mode: str) -> Volume | None:
    """The gizmo on a volume. Returns the volume as it was dragged in this frame."""
    left, top, right, bottom = lens.place
    gizmo.set_drawlist(imgui.get_background_draw_list())
    gizmo.set_rect(left, top, right - left, bottom - top)
    gizmo.set_orthographic(False)
    gizmo.allow_axis_flip(False)
    gizmo.set_gizmo_size_clip_space(GIZMO_SIZE)
    held = _matrix(placement(volume))
    frame = gizmo.MODE.world if mode == "Move" else gizmo.MODE.local
    used = gizmo.manipulate(
        _matrix(lens.view_from_world), _matrix(lens.clip_from_view), OPERATIONS[mode], frame, held
    )
    if not used:
        return None
    return placed(volume, np.array(held.values, np.float64).reshape(4, 4).T, mode)


def placement(volume: Volume) -> Points:
    """(4, 4) world from the unit cube or unit sphere."""
    size = (2.0 * volume.radius,) * 3 if volume.shape == "sphere" else volume.size
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(rotation_rows(volume.rotation_deg)) * np.array(size)
    matrix[:3, 3] = volume.center
    return matrix


def placed(volume: Volume, matrix: Points, mode: str) -> Volume:
    """The volume where ``matrix`` puts it; only what ``mode`` changes is taken from it."""
    if mode == "Move":
        return replace(volume, center=_short(matrix[:3, 3]))
    sizes = np.linalg.norm(matrix[:3, :3], axis=0)
    if mode == "Scale":
        if volume.shape == "sphere":
            diameter = 2.0 * volume.radius
            furthest = sizes[np.argmax(np.abs(np.log(np.maximum(sizes, SMALLEST_M) / diameter)))]
            return replace(volume, radius=max(float(f"{furthest / 2:.4g}"), SMALLEST_M))
        return replace(volume, size=_short(np.maximum(sizes, SMALLEST_M)))
    return replace(volume, rotation_deg=_short(np.degrees(angles_of(matrix[:3, :3] / sizes))))


def angles_of(rows: Points) -> Points:
    """(x, y, z) rad of a rotation about the x, then the y, then the z axis."""
    y = math.asin(min(max(-rows[2, 0], -1.0), 1.0))
    if abs(rows[2, 0]) > 1.0 - 1e-9:  # x and z turn about one axis: all of it is x's
        return np.array([math.atan2(-rows[1, 2], rows[1, 1]), y, 0.0])
    x, z = math.atan2(rows[2, 1], rows[2, 2]), math.atan2(rows[1, 0], rows[0, 0])
    return np.array([x, y, z])


def _matrix(matrix: Any) -> Any:
    """As ImGuizmo has it: column by column."""
    return gizmo.Matrix16([float(value) for value in np.asarray(matrix).T.reshape(16)])


def _short(vector: Points) -> tuple[float, float, float]:
    x, y, z = (float(f"{part:.5g}") for part in vector)
    return x, y, z
