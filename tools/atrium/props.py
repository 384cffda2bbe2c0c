"""What stands and hangs in the atrium: cloth, the forge, planters, lanterns, the door."""

from __future__ import annotations

import numpy as np

from atrium.mesh import F64, Soup, join, sheet, triangles
from atrium.shapes import arc, box, revolve, thick_strip


def banner(width: float, drop: float, folds: float, depth: float, seed: int) -> Soup:
    """A free-hanging cloth in the plane z = 0, top edge at y = 0, centred on x; one thin sheet."""
    rng = np.random.default_rng(seed)
    u, v = np.linspace(0.0, 1.0, 26), np.linspace(0.0, 1.0, 20)
    phase, drift = rng.uniform(0.0, 2.0 * np.pi, 3), rng.uniform(0.6, 1.4, 3)
    grow = (0.25 + 0.75 * v)[None, :]
    harmonics = zip((0.6, 0.3, 0.15), (1.0, 1.9, 3.1), phase, drift, strict=True)
    wave = sum(
        amplitude * np.sin(2.0 * np.pi * folds * rate * u[:, None] + p + d * v[None, :])
        for amplitude, rate, p, d in harmonics
    )
    z = depth * grow * wave + 0.12 * depth * np.sin(3.0 * np.pi * v)[None, :]
    x = width * (u[:, None] - 0.5) * (1.0 - 0.06 * np.sin(np.pi * v)[None, :] ** 2)
    hem = 0.1 * width * np.cos(2.0 * np.pi * (u[:, None] - 0.5))
    y = -drop * v[None, :] - hem * v[None, :] ** 6
    return _cloth(x, y, z, width, drop)


def curtain(width: float, drop: float, seed: int) -> Soup:
    """A gathered curtain on a rod along x = 0 .. `width`, tied back at two thirds of its drop."""
    rng = np.random.default_rng(seed)
    u, v = np.linspace(0.0, 1.0, 31), np.linspace(0.0, 1.0, 17)
    tie = np.exp(-(((v - 0.66) / 0.2) ** 2))
    span = 0.72 - 0.46 * tie - 0.14 * v
    lean = 0.10 * tie
    x = width * (lean[None, :] * 0.3 + u[:, None] * span[None, :])
    squeeze = 0.045 + 0.05 * v + 0.03 * tie
    wave = np.sin(2.0 * np.pi * 5.5 * u[:, None] + rng.uniform(0, 6) + 0.8 * v[None, :])
    wave += 0.35 * np.sin(2.0 * np.pi * 12.0 * u[:, None] + rng.uniform(0, 6) - 1.1 * v[None, :])
    z = squeeze[None, :] * wave
    y = np.broadcast_to(-drop * v[None, :], x.shape) - 0.03 * np.cos(2.0 * np.pi * 5.5 * u)[
        :, None
    ] * (1.0 - v[None, :])
    return _cloth(x, y, z, width, drop)


def _cloth(x: F64, y: F64, z: F64, width: float, drop: float) -> Soup:
    """The sheet over a (U, V) cloth grid with u across and v down; its front looks along +z."""
    points = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
    count_u, count_v = points.shape[:2]
    uv = np.stack(
        np.broadcast_arrays(
            np.linspace(0.0, width, count_u)[:, None], np.linspace(0.0, drop, count_v)[None, :]
        ),
        axis=-1,
    )
    return sheet(points, uv).flipped()


def rod(length: float) -> Soup:
    """A curtain rod along x from 0 to `length`, with knobs."""
    turned = revolve(
        [
            (0.0, -0.06),
            (0.04, -0.04),
            (0.04, 0.0),
            (0.018, 0.02),
            (0.018, length - 0.02),
            (0.04, length),
            (0.04, length + 0.04),
            (0.0, length + 0.06),
        ],
        8,
    )
    lying = turned.position[..., [1, 0, 2]] * np.array([1.0, -1.0, 1.0])
    return Soup(lying, turned.uv)


def forge_base() -> Soup:
    """The forge's stone foot: two octagonal steps and a turned pedestal, 1.0 m tall."""
    steps = [
        revolve([(0.0, y), (r, y), (r, y + 0.16), (r - 0.03, y + 0.19), (0.0, y + 0.19)], 8)
        for r, y in ((2.1, -0.01), (1.35, 0.18))
    ]
    pedestal = revolve(
        [
            (0.0, 0.36),
            (0.78, 0.36),
            (0.78, 0.46),
            (0.62, 0.52),
            (0.44, 0.66),
            (0.40, 0.78),
            (0.46, 0.90),
            (0.62, 0.98),
            (0.62, 1.06),
            (0.0, 1.06),
        ],
        32,
    )
    turn = np.pi / 8.0
    return join(*(s.turned_y(turn) for s in steps), pedestal)


def forge_bowl() -> Soup:
    """The bronze bowl on the pedestal with four ring handles; rim at 1.62 m, 1.1 m in radius."""
    bowl = revolve(
        [
            (0.0, 1.05),
            (0.40, 1.05),
            (0.72, 1.14),
            (0.95, 1.32),
            (1.05, 1.50),
            (1.14, 1.54),
            (1.16, 1.60),
            (1.10, 1.64),
            (1.02, 1.60),
            (0.96, 1.46),
            (0.86, 1.36),
            (0.0, 1.34),
        ],
        36,
    )
    handle = thick_strip(
        arc(0.14, 14, np.pi, -np.pi + 0.02), arc(0.18, 14, np.pi, -np.pi + 0.02), 0.05
    )
    hung = [handle.moved(z=1.12, y=1.36).turned_y(k * np.pi / 2.0) for k in range(4)]
    return join(bowl, *hung)


def molten_metal(seed: int) -> Soup:
    """The glowing melt in the bowl: a closed lens of 0.97 m radius with a heaving surface."""
    rng = np.random.default_rng(seed)
    rings, spokes = 9, 36
    radius = np.linspace(0.0, 0.98, rings + 1)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, spokes + 1)[None, :]
    x, z = radius * np.cos(angle), -radius * np.sin(angle)
    heave = np.zeros_like(x)
    for _ in range(7):
        direction, rate, phase = rng.uniform(0, 2 * np.pi), rng.uniform(3, 11), rng.uniform(0, 6)
        heave += np.sin(rate * (x * np.cos(direction) + z * np.sin(direction)) + phase) / rate
    y = 1.56 + 0.07 * heave * (1.0 - (radius / 0.98) ** 4)
    points = np.stack([x, y, z], axis=-1)
    points[:, -1] = points[:, 0]
    points[0] = np.array([0.0, y[0, 0], 0.0])
    floor = points.copy()
    floor[..., 1] = 1.36
    floor[..., [0, 2]] *= 0.85
    shell = np.stack([points[-1], floor[-1]])
    uv = np.stack(np.broadcast_arrays(points[..., 0], points[..., 2]), axis=-1)
    return join(sheet(points, uv), sheet(shell), sheet(floor).flipped())


def molten_streams() -> Soup:
    """Four streams that run over the bowl's rim into a glowing ring on the lower step."""
    inner = np.array(
        [[0.90, 1.55], [1.06, 1.63], [1.20, 1.62], [1.25, 1.50], [1.31, 1.0], [1.38, 0.2]]
    )
    outer = inner + np.array(
        [[0.0, 0.05], [0.0, 0.05], [0.03, 0.05], [0.06, 0.02], [0.06, 0.0], [0.09, 0.02]]
    )
    stream = thick_strip(inner, outer, 0.10)
    profile = [(1.42, 0.15), (1.70, 0.15), (1.70, 0.21), (1.56, 0.235), (1.42, 0.21), (1.42, 0.15)]
    return join(*(stream.turned_y((k + 0.5) * np.pi / 2.0) for k in range(4)), revolve(profile, 40))


def crystal(height: float, radius: float, sides: int) -> Soup:
    """A double-pointed crystal about the origin."""
    return revolve(
        [
            (0.0, -0.5 * height),
            (radius, -0.14 * height),
            (radius * 0.9, 0.2 * height),
            (0.0, 0.5 * height),
        ],
        sides,
    )


def planter() -> Soup:
    """A terracotta pot with a rolled rim, 0.72 m tall, earth included."""
    return revolve(
        [
            (0.0, 0.0),
            (0.30, 0.0),
            (0.33, 0.05),
            (0.30, 0.09),
            (0.42, 0.34),
            (0.46, 0.58),
            (0.44, 0.62),
            (0.50, 0.65),
            (0.51, 0.70),
            (0.48, 0.72),
            (0.43, 0.70),
            (0.41, 0.62),
            (0.0, 0.64),
        ],
        28,
    )


def shrub_core(radius: float) -> Soup:
    """The dark inside of a shrub that closes the view between its leaves."""
    turn = np.linspace(-np.pi / 2.0, np.pi / 2.0, 8)
    profile = [(max(0.0, radius * float(np.cos(a))), radius * float(np.sin(a))) for a in turn]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    trunk = revolve([(0.0, -1.6 * radius), (0.05, -1.6 * radius), (0.04, 0.0), (0.0, 0.0)], 7)
    return join(revolve(profile, 12), trunk)


def leaves(radius: float, count: int, seed: int) -> Soup:
    """Loose leaves on a ball: `count` folded quads, thin and double-sided."""
    rng = np.random.default_rng(seed)
    outward = rng.normal(size=(count, 3))
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    facing = outward + 0.7 * rng.normal(size=(count, 3))
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    side = np.cross(facing, rng.normal(size=(count, 3)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    along = np.cross(facing, side)
    centre = outward * radius * rng.uniform(0.93, 1.22, size=(count, 1))
    size = radius * rng.uniform(0.16, 0.26, size=(count, 1))
    tip, root = centre + along * size, centre - along * size
    left = centre + side * size * 0.45 + facing * size * 0.2
    right = centre - side * size * 0.45 + facing * size * 0.2
    return triangles(
        np.concatenate([np.stack([root, left, tip], 1), np.stack([root, tip, right], 1)])
    )


def lantern_frame() -> Soup:
    """A hanging lantern's bronze: chain, cap and foot; the hook at y = 0."""
    return join(
        revolve([(0.0, -0.82), (0.012, -0.82), (0.012, 0.02), (0.0, 0.02)], 6),
        revolve(
            [
                (0.0, -0.94),
                (0.17, -0.94),
                (0.17, -0.91),
                (0.06, -0.82),
                (0.02, -0.76),
                (0.0, -0.76),
            ],
            8,
        ),
        revolve([(0.0, -1.34), (0.07, -1.32), (0.13, -1.27), (0.13, -1.24), (0.0, -1.24)], 8),
        *(
            box((0.016, 0.32, 0.016), (0.12 * np.cos(a), -1.09, 0.12 * np.sin(a)))
            for a in np.arange(4) * np.pi / 2.0
        ),
    )


def lantern_glow() -> Soup:
    """The lantern's glowing body."""
    return revolve([(0.0, -1.24), (0.075, -1.22), (0.095, -1.10), (0.075, -0.98), (0.0, -0.96)], 10)


def door_leaf(width: float, height: float) -> Soup:
    """A round-headed plank door in the plane z = 0, 0.12 m thick, its foot at y = 0."""
    radius = width / 2.0
    bend = arc(radius, 16) + np.array([0.0, height - radius])
    line = np.concatenate([[[-radius, 0.0]], bend, [[radius, 0.0]]])
    foot = np.stack([line[:, 0], np.zeros(len(line))], axis=1)[1:-1]
    panel = thick_strip(foot, line[1:-1], 0.12)
    straps = [
        box((width * 0.86, 0.09, 0.15), (0.0, height * y, 0.0), 0.01) for y in (0.18, 0.42, 0.66)
    ]
    return join(panel, *straps)


def door_surround(width: float, height: float) -> Soup:
    """The moulded stone frame round the door, 0.3 m wide and 0.3 m deep."""
    radius = width / 2.0
    rise = np.array([0.0, height - radius])

    def line(r: float) -> F64:
        return np.concatenate([[[-r, 0.0]], arc(r, 20) + rise, [[r, 0.0]]])

    return join(
        thick_strip(line(radius), line(radius + 0.2), 0.3),
        thick_strip(line(radius + 0.19), line(radius + 0.32), 0.42),
    )
