"""What the octree answers at points of the world: lookups, cones, gathered light."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.passes.area_lights import pack_area_lights
from elemental.scene.area_lights import AreaLight
from glsl.harness import run_glsl
from gpu.voxel.stage import Stage

Array = npt.NDArray[Any]


def _rows(points: Array, vectors: Array) -> tuple[Array, Array]:
    points = np.atleast_2d(np.asarray(points, np.float64))
    vectors = np.atleast_2d(np.asarray(vectors, np.float64))
    vectors = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    points, vectors = np.broadcast_arrays(points, vectors)
    return points.astype(np.float32), vectors.astype(np.float32)


def look_up(stage: Stage, points: Array, mip: Array | int, direction: Array) -> Array:
    """SVOLookupLevel: (N, 4) premultiplied radiance and opacity."""
    points, direction = _rows(points, direction)
    return run_glsl(
        stage.device,
        ["lib/svo_lookup.glsl"],
        "SVOLookupLevel(p, mip, d)",
        {"p": points, "d": direction, "mip": np.full(len(points), mip, np.int32)},
        "vec4",
        reads=stage.octree.tracing_reads(),
        params=stage.octree.params,
    )


def trace(
    stage: Stage, points: Array, direction: Array, half_angle: Array | float, start: float = 0.0
) -> Array:
    """SVOConeTrace: (N, 4) radiance and how much is hidden. ``start`` m: the start bias."""
    points, direction = _rows(points, direction)
    call = "SVOConeTrace(p, d, a)" if start == 0.0 else f"cone_trace_from(p, d, a, {start!r})"
    return run_glsl(
        stage.device,
        ["lib/cone.glsl"],
        call,
        {"p": points, "d": direction, "a": np.full(len(points), half_angle, np.float32)},
        "vec4",
        reads=stage.octree.tracing_reads(),
        params=stage.octree.params,
    )


def gather(
    stage: Stage, points: Array, normal: Array, area_lights: Sequence[AreaLight] = ()
) -> Array:
    """Irradiance / pi at surface points, (N, 3): all diffuse cones, octree, sky and area lights."""
    points, normal = _rows(points, normal)
    return run_glsl(
        stage.device,
        ["lib/voxel_gather.glsl"],
        "gathered_radiance(p, n, 0.0, 0u)",
        {"p": points, "n": normal},
        "vec3",
        reads={**stage.octree.tracing_reads(), **stage.sky.reads()},
        params={
            "AreaLights": pack_area_lights(area_lights),
            **stage.octree.params,
            **stage.sky.params(),
        },
        defines={"GATHER": 1},
    )
