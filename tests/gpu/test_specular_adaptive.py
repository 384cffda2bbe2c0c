# GI-13
"""Adaptive specular light: what is traced, what is interpolated, and how far that is from tracing
every pixel.

The floors are seen straight from above. Pixels are counted from the left; every second one along
each axis is traced first.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from flip_evaluator import evaluate

from elemental.core import transforms
from elemental.core.layout import layouts
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.gpu.graph import Graph
from elemental.passes.cone_trace.specular import NOTHING_LISTED
from elemental.scene.model import Camera, Environment, Material, Scene
from elemental.settings import Settings
from gpu.rig import IDENTITY, material, mesh, scene, vector
from gpu.sources import Sources
from image.golden_scenes import camera, sunlit_plaza

Array = npt.NDArray[Any]

SIZE = (64, 48)
HEIGHT_M, FOV_Y = 4.0, 0.5
PIXEL_M = 2.0 * HEIGHT_M * np.tan(FOV_Y / 2) / SIZE[1]
STRIPE = 8
"""Pixels a stripe is wide, an even number: its first column holds no pixel that is traced first."""
COARSE = SIZE[0] // 2 * (SIZE[1] // 2)
BORDERS = SIZE[0] // STRIPE - 1
MIRROR = material(metallic=1.0, roughness=0.1)
BLURRED = material(metallic=1.0, roughness=0.3)

ABOVE = Camera(
    "above",
    transforms.inverse(transforms.look_at((0, HEIGHT_M, 0), (0, 0, 0), (0, 0, -1))),
    FOV_Y,
    0.1,
)


ROW, COLUMN = np.mgrid[: SIZE[1], : SIZE[0]]
STRIPED = COLUMN // STRIPE % 2
"""(H, W): 1 in every second stripe."""
NONE = np.zeros_like(STRIPED)


def floor(slope: Array = NONE, lift_m: Array = NONE, blurred: Array = NONE) -> Scene:
    """A mirror of one quad a pixel under an even sky, from (H, W) arrays: how much its normal leans
    towards +x, how high it lies, and where it mirrors less sharply.
    """
    left, top = (COLUMN - SIZE[0] / 2) * PIXEL_M, (ROW - SIZE[1] / 2) * PIXEL_M
    corners = np.array([[0, 1], [1, 1], [1, 0], [0, 0]]) * PIXEL_M
    x, z = (start[..., None] + corners[:, k] for k, start in enumerate((left, top)))
    y = np.broadcast_to(lift_m[..., None], x.shape)
    nearer = 1.0 - y / HEIGHT_M  # what is nearer to the eye looks as wide
    points = np.stack([x * nearer, y, z * nearer], axis=-1)
    normals = np.stack([slope, np.ones(slope.shape), np.zeros(slope.shape)], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    parts = []
    for index in range(2):
        chosen = blurred == index
        count = int(chosen.sum())
        if count == 0:
            continue
        faces = np.arange(count)[:, None] * 4 + np.array([0, 1, 2, 0, 2, 3])
        shape = points[chosen].reshape(-1, 3).astype(np.float32), faces.ravel().astype(np.uint32)
        flat = mesh(shape, index)
        facing = np.repeat(normals[chosen], 6, axis=0).astype(np.float32)
        parts.append((replace(flat, normals=facing), IDENTITY))
    made = scene(*parts, materials=[MIRROR, BLURRED])
    made.environment = Environment(None, vector(0.2, 0.5, 0.9), 1.0)
    return made


def draw(
    device: Device, world: Scene, eye: Camera = ABOVE, size: tuple[int, int] = SIZE, **changes: Any
) -> tuple[dict[str, int], dict[str, Array]]:
    """(counters, pictures (H, W, 3) float32 by view: specular_gi, specular_traced, final, …)."""
    # The blur would even out normals that differ from pixel to pixel.
    settings = {"gi.resolution": 64, "gi.diffuse_cones": 9, "gbuffer.blur": False, **changes}
    renderer = Renderer(device, world, Settings(settings), size)
    pictures = {}
    for view in ("specular_gi", "specular_traced", "scene_color", "final"):
        frame = renderer.render(eye, 0.0, 0, view)
        pictures[view] = renderer.read(frame)[..., :3].astype(np.float32)
    device.finish()
    counters = dict(frame.counters)
    renderer.release()
    return counters, pictures


ALWAYS_TRACED = {"gi.specular_adaptive": False}


def listed(pictures: dict[str, Array]) -> Array:
    """(H, W) where the view shows a pixel that was traced because its neighbours would not do."""
    shown = pictures["specular_traced"]
    return np.asarray((shown == shown.max(axis=(0, 1))).all(axis=-1))


def test_an_even_floor_is_interpolated_between_the_pixels_traced_first(device: Device) -> None:
    counters, pictures = draw(device, floor())
    assert counters["specular_pixels"] == SIZE[0] * SIZE[1]
    assert counters["specular_traced"] == COARSE
    counters, traced = draw(device, floor(), **ALWAYS_TRACED)
    assert counters["specular_traced"] == counters["specular_pixels"] == SIZE[0] * SIZE[1]
    np.testing.assert_allclose(pictures["specular_gi"], traced["specular_gi"], rtol=2e-3)


@pytest.mark.parametrize("what", ["normal", "depth", "lobe"])
def test_a_border_between_unlike_surfaces_is_traced(device: Device, what: str) -> None:
    """Of the two columns beside each border only one has neighbours on both sides of it.

    The exposure hides what the surfaces mirror: only their difference counts.
    """
    world = {
        "normal": lambda: floor(slope=0.1 * STRIPED),
        "depth": lambda: floor(lift_m=0.2 * STRIPED),
        "lobe": lambda: floor(blurred=STRIPED),
    }[what]()
    counters, pictures = draw(device, world, exposure=-12.0)
    assert counters["specular_traced"] == COARSE + BORDERS * SIZE[1]
    expected = (COLUMN % STRIPE == 0) & (COLUMN > 0)
    np.testing.assert_array_equal(listed(pictures), expected)


def test_a_floor_that_is_bumpy_in_every_pixel_is_traced_whole(device: Device) -> None:
    """The pixels traced first lean one way, the others the other way."""
    first = (COLUMN % 2 == 1) & (ROW % 2 == 0)  # rows count from the bottom there
    counters, _ = draw(device, floor(slope=np.where(first, 0.1, -0.1)), exposure=-12.0)
    assert counters["specular_pixels"] == counters["specular_traced"] == SIZE[0] * SIZE[1]


def test_an_edge_in_the_mirrored_light_is_traced_and_nothing_else(device: Device) -> None:
    """A sky that is dark on one side: its edge runs down the middle of the picture."""
    world = floor()
    radiance = np.full((64, 128, 3), 1.0, np.float32)
    radiance[:, :64] = 0.01
    world.environment = Environment(radiance, vector(1, 1, 1), 1.0)
    counters, pictures = draw(device, world)
    assert COARSE < counters["specular_traced"] < COARSE + SIZE[1] * SIZE[0] // 4
    shown = pictures["specular_gi"][..., 0]
    edge = np.abs(np.gradient(shown, axis=1)) + np.abs(np.gradient(shown, axis=0))
    traced = listed(pictures)
    assert edge[traced].mean() > 10 * edge[~traced].mean()


def test_dull_surfaces_are_not_counted(device: Device) -> None:
    dull: Material = material(roughness=1.0)
    world = floor()
    world.materials[:] = [dull, dull]
    counters, pictures = draw(device, world)
    assert counters["specular_pixels"] == counters["specular_traced"] == 0
    assert not pictures["specular_traced"].any()


def test_the_picture_stays_near_that_of_tracing_every_pixel(device: Device) -> None:
    size = (160, 90)
    adaptive, ours = draw(device, sunlit_plaza(), camera(), size)
    full, reference = draw(device, sunlit_plaza(), camera(), size, **ALWAYS_TRACED)
    assert adaptive["specular_pixels"] == full["specular_traced"] == full["specular_pixels"]
    assert adaptive["specular_traced"] < 0.6 * full["specular_traced"]
    low = evaluate(reference["final"] / 255.0, ours["final"] / 255.0, "LDR")[1]
    high = evaluate(reference["scene_color"], ours["scene_color"], "HDR")[1]
    share = adaptive["specular_traced"] / full["specular_traced"]
    print(f"traced {share:.2f}; LDR-FLIP {low:.4f}, HDR-FLIP {high:.4f}")
    assert 0.0 < low <= 0.02
    assert 0.0 < high <= 0.02


HEAD = '#include "lib/specular_append.glsl"\n'


@pytest.mark.parametrize("count", [0, 1, 63, 64, 65, 128, 129])
def test_the_append_reaches_every_item_and_launches_no_group_too_many(
    device: Device, sources: Sources, count: int
) -> None:
    append = sources.compute(
        f"int i = int(gl_GlobalInvocationID.x); if (i < {count}) append_pixel(ivec2(i, 3 * i));",
        HEAD,
    )
    follow = sources.compute(
        "uint i = linear_thread_id(); if (gl_LocalInvocationIndex == 0u) atomicAdd(marks[0], 1u);"
        " if (i >= specular.listed) return;"
        " uint code = specular_pixels[i]; marks[1u + (code & 0xffffu)] += code >> 16;",
        HEAD + "layout(std430) buffer Marks { uint marks[]; };",
        (int(layouts().constant("SPECULAR_GROUP")), 1, 1),
    )
    marks = device.buffer("marks", np.zeros(1 + 192, np.uint32))
    g: Graph = device.begin_frame()
    counts = g.buffer("counts", int(layouts().struct("SpecularCounts").itemsize))
    pixels = g.buffer("pixels", 4 * 192)
    g.clear_buffer(counts, NOTHING_LISTED)
    lists = {"SpecularState": counts, "SpecularPixels": pixels}
    g.compute(append, writes=lists, threads=192)
    g.compute(follow, reads=lists, writes={"Marks": marks}, indirect=(counts, 0))
    g.execute()
    groups, *marked = marks.read(np.uint32).tolist()
    assert groups == -(-count // 64)
    assert marked == [3 * i if i < count else 0 for i in range(192)]
    marks.release()
