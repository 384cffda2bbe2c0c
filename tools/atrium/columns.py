"""Columns, balusters and corbels."""

from __future__ import annotations

import numpy as np

from atrium.mesh import F64, Soup, join, sheet
from atrium.shapes import box, revolve


def _bulge(
    radius: float, bottom: float, height: float, swell: float, steps: int
) -> list[tuple[float, float]]:
    """A torus moulding: a half round of `swell` metres standing out of `radius`."""
    angle = np.linspace(0.0, np.pi, steps + 1)
    return [
        (float(radius + swell * np.sin(a)), float(bottom + height * (1.0 - np.cos(a)) / 2.0))
        for a in angle
    ]


def _entasis(
    bottom_radius: float, top_radius: float, bottom: float, top: float, steps: int
) -> list[tuple[float, float]]:
    """A shaft that narrows upwards in a curve, as classical columns do."""
    share = np.linspace(0.0, 1.0, steps + 1)
    radius = bottom_radius + (top_radius - bottom_radius) * share**1.8
    return list(zip(radius.tolist(), (bottom + (top - bottom) * share).tolist(), strict=True))


def _leaf(root: F64, width: float, height: float, curl: float, thickness: float) -> Soup:
    """One capital leaf leaning against the bell: a closed patch whose tip curls outwards (+x)."""
    along, across = np.linspace(0.0, 1.0, 5), np.linspace(-1.0, 1.0, 3)
    outline = width * np.sqrt(np.clip(1.0 - (1.7 * along - 0.55).clip(0.0) ** 2.2, 0.02, 1.0)) / 2.0
    lean = 0.05 * along + curl * along**4
    rise = height * (along - 0.16 * along**6)
    front = np.empty((len(along), len(across), 3))
    front[..., 0] = lean[:, None] + thickness * (1.0 - 0.45 * across**2)
    front[..., 1] = rise[:, None]
    front[..., 2] = -outline[:, None] * across
    back = front.copy()
    back[..., 0] -= thickness * 1.6
    rim_front = np.concatenate([front[0, :-1], front[:-1, -1], front[-1, :0:-1], front[::-1, 0]])
    rim_back = np.concatenate([back[0, :-1], back[:-1, -1], back[-1, :0:-1], back[::-1, 0]])
    leaf = join(sheet(front).flipped(), sheet(back), sheet(np.stack([rim_back, rim_front], axis=1)))
    return Soup(leaf.position + root, leaf.uv)


def ground_column(height: float) -> Soup:
    """A column with attic base and leafed capital; foot at y = 0, abacus top at `height`."""
    top = height - 0.11
    bell = top - 0.44
    turned = revolve(
        [
            (0.0, 0.10),
            (0.29, 0.10),
            *_bulge(0.285, 0.10, 0.09, 0.035, 4),
            (0.262, 0.20),
            (0.250, 0.235),
            *_bulge(0.255, 0.245, 0.06, 0.022, 3),
            *_entasis(0.242, 0.205, 0.33, bell - 0.06, 5),
            *_bulge(0.207, bell - 0.055, 0.045, 0.022, 3),
            (0.205, bell),
            (0.212, bell + 0.16),
            (0.245, bell + 0.33),
            (0.315, bell + 0.44),
            (0.0, bell + 0.44),
        ],
        20,
    )
    parts = [
        box((0.66, 0.12, 0.66), (0.0, 0.06, 0.0), 0.015),
        box((0.66, 0.12, 0.66), (0.0, height - 0.06, 0.0), 0.02),
        turned,
    ]
    root = np.array([0.203, bell + 0.01, 0.0])
    low, high = _leaf(root, 0.15, 0.27, 0.055, 0.016), _leaf(root, 0.17, 0.42, 0.11, 0.018)
    parts += [low.turned_y(k * np.pi / 4.0) for k in range(8)]
    parts += [high.turned_y((k + 0.5) * np.pi / 2.0) for k in range(4)]
    return join(*parts)


def loggia_column(height: float, pedestal: float) -> Soup:
    """The upper storey's column on its square pedestal of height `pedestal`; foot at y = 0."""
    base = pedestal
    top = height - 0.07
    turned = revolve(
        [
            (0.0, base),
            *_bulge(0.135, base, 0.06, 0.03, 4),
            (0.125, base + 0.085),
            *_entasis(0.115, 0.096, base + 0.12, top - 0.2, 4),
            *_bulge(0.098, top - 0.195, 0.03, 0.014, 3),
            (0.098, top - 0.155),
            (0.13, top - 0.06),
            (0.155, top),
            (0.0, top),
        ],
        14,
    )
    return join(
        box((0.34, pedestal - 0.2, 0.34), (0.0, pedestal / 2.0, 0.0)),
        box((0.40, 0.10, 0.40), (0.0, 0.05, 0.0), 0.012),
        box((0.40, 0.10, 0.40), (0.0, pedestal - 0.05, 0.0), 0.012),
        box((0.36, 0.08, 0.36), (0.0, height - 0.04, 0.0), 0.012),
        turned,
    )


def baluster(height: float) -> Soup:
    """A turned vase baluster, foot at y = 0."""
    waist = [
        (0.0, 0.0),
        (0.052, 0.0),
        (0.052, 0.06),
        (0.032, 0.10),
        (0.062, 0.27),
        (0.052, 0.40),
        (0.026, 0.62),
        (0.034, 0.84),
        (0.052, 0.92),
        (0.052, 1.0),
        (0.0, 1.0),
    ]
    return revolve([(r, y * height) for r, y in waist], 8)


def corbel() -> Soup:
    """The stepped bracket at the outer wall (+x side) that carries a rib; top at y = 0."""
    steps = ((0.52, 0.11, 0.34), (0.44, 0.16, 0.26), (0.36, 0.16, 0.18), (0.28, 0.14, 0.10))
    parts, y = [], 0.0
    for width, tall, reach in steps:
        depth = reach + 0.1  # 0.1 m of it stands inside the wall
        parts.append(box((depth, tall, width), (0.1 - depth / 2.0, y - tall / 2.0, 0.0), 0.015))
        y -= tall
    return join(*parts)
