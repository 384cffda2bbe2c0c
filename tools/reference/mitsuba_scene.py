"""Our scene as a mitsuba scene, and its path-traced radiance.

Depth. `scene_color` with gi.bounces = n holds visible emission, direct analytic light, and n
gathers: surfaces reached by the eye's ray and then n more segments show their emission and their
direct analytic light. Mitsuba's `max_depth` counts path segments that end on a light: 1 shows
emitters alone, 2 adds one reflection. An emitter or the sky is itself the end of a gather, so it
is seen over n reflections: max_depth = n + 1. A sun, point or spot light is reached from a gathered
surface by one more segment: max_depth = n + 2. Light adds up, so the reference is the sum of two
renderings, one with each kind of light at its own depth. Our rays pass glass without a gather:
where there is any, GLASS_SEGMENTS are added.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from elemental.core import transforms
from elemental.scene.model import Camera, FloatArray, Light, Scene
from reference.bsdf import Entry, MaterialConverter, interior
from reference.emission import emitting_parts
from reference.ply import WorldMesh, two_sheets, world_meshes, write_ply

LEAST_SKY_ROWS = 1024
"""Of an environment's image for mitsuba."""

MASK_SAMPLES = 16
"""Samples that look for a light source in a pixel."""

GLASS_SEGMENTS = 4
"""Path segments in glass and between bodies of it: as many as our pictures of what is behind."""


@dataclass(frozen=True)
class Job:
    """What to path-trace: size (width, height) in pixels, samples a pixel, gathers, sky factor."""

    size: tuple[int, int]
    samples: int
    bounces: int
    sky_intensity: float = 1.0
    seed: int = 0


def path_trace(scene: Scene, camera: Camera, job: Job, folder: Path) -> FloatArray:
    """Linear radiance (H, W, 3) float32; meshes pass through PLY files in `folder`."""
    surfaces, area_lights = _surfaces(scene, folder)
    sky = _environment(scene, job.sky_intensity)
    punctual = {f"light{k}": _punctual(light) for k, light in enumerate(scene.lights)}
    parts = [np.zeros((job.size[1], job.size[0], 3), np.float32)]
    depth = job.bounces + GLASS_SEGMENTS * any(m.transmits for m in scene.materials)
    if area_lights or sky:
        parts.append(_render({**surfaces, **area_lights, **sky}, camera, job, depth + 1))
    if punctual:
        parts.append(_render({**surfaces, **punctual}, camera, job, depth + 2))
    return np.asarray(np.sum(parts, axis=0), dtype=np.float32)


def emission_mask(scene: Scene, camera: Camera, job: Job, folder: Path) -> FloatArray:
    """Where the eye meets no emission and no sky: (H, W, 3) float32, 1 or 0."""
    surfaces, area_lights = _surfaces(scene, folder)
    lights = {**area_lights, "sky": {"type": "constant"}}
    quick = Job(job.size, MASK_SAMPLES, 0)
    image = _render({**surfaces, **lights}, camera, quick, max_depth=1)
    dark = image.max(axis=2, keepdims=True) == 0.0
    return np.repeat(dark, 3, axis=2).astype(np.float32)


def glass_mask(scene: Scene, camera: Camera, job: Job, folder: Path) -> FloatArray:
    """Where the eye meets glass first: (H, W, 3) float32, 1 or 0; none at its rims."""
    surfaces, _ = _surfaces(scene, folder)
    glass = {f"surface{k}_0" for k, m in enumerate(scene.materials) if m.transmits}
    black = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
    shown: dict[str, Entry] = {}
    for name, entry in surfaces.items():
        plain = {key: entry[key] for key in ("type", "filename")}
        light = {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}
        bsdf = {"type": "twosided", "bsdf": black}
        shown[name] = {**plain, "bsdf": bsdf} | ({"emitter": light} if name in glass else {})
    quick = Job(job.size, MASK_SAMPLES, 0)
    return (_render(shown, camera, quick, max_depth=1) > 0.999).astype(np.float32)


def _render(entries: Entry, camera: Camera, job: Job, max_depth: int) -> FloatArray:
    media = any("interior" in entry for entry in entries.values())
    kind = "volpath" if media else "path"
    integrator = {"type": kind, "max_depth": max_depth, "rr_depth": 1000}
    whole = {
        "type": "scene",
        **entries,
        "integrator": integrator,
        "sensor": _sensor(camera, job),
    }
    image = np.array(mi.render(mi.load_dict(whole), seed=job.seed), dtype=np.float32)
    return np.asarray(image[..., :3])


def _sensor(camera: Camera, job: Job) -> Entry:
    world = camera.world_from_view.astype(np.float64)
    eye, backward, up = world[:3, 3], world[:3, 2], world[:3, 1]
    return {
        "type": "perspective",
        "fov": math.degrees(camera.fov_y),
        "fov_axis": "y",
        "near_clip": camera.near,
        "far_clip": 1e7,
        "to_world": mi.ScalarTransform4f().look_at(
            origin=eye.tolist(), target=(eye - backward).tolist(), up=up.tolist()
        ),
        "film": {
            "type": "hdrfilm",
            "width": job.size[0],
            "height": job.size[1],
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent", "sample_count": job.samples},
    }


def _surfaces(scene: Scene, folder: Path) -> tuple[dict[str, Entry], dict[str, Entry]]:
    """All shapes as they reflect, and those that emit as they do both, by the same names."""
    converter = MaterialConverter(scene)
    uv_sets = {k: converter.uv_set(m) for k, m in enumerate(scene.materials)}
    shapes: dict[str, Entry] = {}
    emitting: dict[str, Entry] = {}
    for index, mesh in world_meshes(scene, uv_sets).items():
        material = scene.materials[index]
        color = mesh.colors.astype(np.float32).mean(axis=0) / np.float32(255.0)
        bsdf, inside = converter.bsdf(material, color), interior(material)
        parts: list[tuple[WorldMesh, Entry | None]] = [(mesh, None)]
        if material.emits or material.unlit:
            # mitsuba's area lights shine to the front: a back that shines too is a mesh of its own.
            sheets = two_sheets(mesh) if material.double_sided else (mesh,)
            glow = converter.radiance(material)
            parts = [part for sheet in sheets for part in emitting_parts(scene, sheet, *glow)]
        for number, (part, radiance) in enumerate(parts):
            name = f"surface{index}_{number}"
            path = folder / f"{name}.ply"
            write_ply(path, part)
            shapes[name] = {"type": "ply", "filename": str(path), "bsdf": bsdf}
            if inside is not None:
                shapes[name]["interior"] = inside
            if radiance is not None:
                light = {"type": "area", "radiance": radiance}
                emitting[name] = {**shapes[name], "emitter": light}
    return shapes, emitting


def _environment(scene: Scene, factor: float) -> dict[str, Entry]:
    environment = scene.environment
    if environment is None:
        return {}
    tint = environment.tint * np.float32(environment.intensity * factor)
    if environment.radiance is None:
        return {"sky": {"type": "constant", "radiance": {"type": "rgb", "value": tint.tolist()}}}
    # Ours has -z in the middle column, mitsuba's in the first: half a turn.
    image = np.roll(environment.radiance, environment.radiance.shape[1] // 2, axis=1) * tint
    image = _rows_from_pole_to_pole(image)
    return {"sky": {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(image))}}


def _rows_from_pole_to_pole(image: FloatArray) -> FloatArray:
    """The image (H, W, 3) as mitsuba takes it, whose first and last rows lie on the poles.

    Ours end there. Left as they are, the 64 rows of a sky with a sun 50 degrees high bring 1.5 %
    more light to the ground. Many more rows, interpolated as ours are drawn.
    """
    height = len(image)
    at = np.linspace(-0.5, height - 0.5, max(2 * height, LEAST_SKY_ROWS)).clip(0, height - 1)
    above = np.floor(at).astype(np.int64)
    below = np.minimum(above + 1, height - 1)
    part = (at - above).astype(np.float32)[:, None, None]
    return np.asarray(image[above] * (1 - part) + image[below] * part, np.float32)


def _punctual(light: Light) -> Entry:
    """A sun, a point or a spot light; `range` has no counterpart, sources are points."""
    power = {"type": "rgb", "value": light.strength.tolist()}
    if light.kind == "directional":
        direction = light.direction.tolist()
        return {"type": "directional", "direction": direction, "irradiance": power}
    if light.kind == "point":
        return {"type": "point", "position": light.position.tolist(), "intensity": power}
    return _spot(light, power)


def _spot(light: Light, power: Entry) -> Entry:
    """A spot light whose falloff is linear in the angle, where glTF's is squared in the cosine."""
    aim = transforms.look_at(np.zeros(3), light.direction)
    up = transforms.inverse(aim)[:3, 1]
    to_world: Any = mi.ScalarTransform4f().look_at(
        origin=light.position.tolist(),
        target=(light.position + light.direction).tolist(),
        up=up.tolist(),
    )
    outer = math.degrees(light.outer_angle)
    return {
        "type": "spot",
        "to_world": to_world,
        "intensity": power,
        "cutoff_angle": outer,
        "beam_width": min(math.degrees(light.inner_angle), outer * 0.999),
    }
