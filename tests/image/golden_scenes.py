"""The small scenes of the golden pictures, drawn through the whole frame at 64^3 voxels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.frame import Renderer
from elemental.gpu.device import Device
from elemental.scene.ies import LightProfile
from elemental.scene.model import Camera, Decal, Environment, Instance, Light, Scene
from elemental.scene.scene_decals import box_matrix
from elemental.scene.volumes import Volume
from elemental.settings import Settings
from gpu.rig import IDENTITY, at, material, scene, sun, vector
from gpu.voxel.scenes import colored, glowing, part, turned
from shapes import box, quad, sphere, torus

SIZE = (128, 72)
SETTINGS = {
    "gi.resolution": 64,
    "shadow.resolution": 512,
    "eye_adaptation.min_brightness": 1.0,
    "eye_adaptation.max_brightness": 1.0,
    "vignette.intensity": 0.0,
    "bloom.intensity": 0.0,
    "lens_flare.intensity": 0.0,
}
"""The light and the film alone: the lens and the eye have goldens of their own."""


def colored_room() -> Scene:
    """A white room with a red and a green wall, lit by a lamp in its ceiling alone."""
    wall = 0.1
    return scene(
        part(box((2, wall, 2)), 0, at(0, -1, 0)),
        part(box((2, wall, 2)), 0, at(0, 1, 0)),
        part(box((2, 2, wall)), 0, at(0, 0, -1)),
        part(box((wall, 2, 2)), 1, at(-1, 0, 0)),
        part(box((wall, 2, 2)), 2, at(1, 0, 0)),
        part(box((0.7, 0.02, 0.7)), 3, at(0, 0.93, 0)),
        part(box((0.5, 1.0, 0.5)), 0, at(-0.35, -0.45, -0.3)),
        part(sphere(0.3), 0, at(0.4, -0.65, 0.2), smooth=True),
        materials=[
            colored(0.8, 0.8, 0.8),
            colored(0.7, 0.05, 0.05),
            colored(0.05, 0.6, 0.1),
            glowing(12, 11, 9),
        ],
    )


def sunlit_plaza() -> Scene:
    """Sun and sky on rough and glossy bodies."""
    made = scene(
        part(box((4, 0.2, 4)), 0, at(0, -0.6, 0)),
        part(sphere(0.5), 1, at(-0.6, 0, 0), smooth=True),
        part(torus(0.4, 0.15), 2, at(0.7, -0.3, 0.2), smooth=True),
        part(box((0.3, 1.4, 0.3)), 3, at(0.1, 0.2, -0.9)),
        materials=[
            material(base_color=vector(0.6, 0.55, 0.5, 1), roughness=0.4),
            material(base_color=vector(0.9, 0.7, 0.4, 1), metallic=1.0, roughness=0.25),
            colored(0.2, 0.3, 0.8),
            colored(0.7, 0.3, 0.2),
        ],
        lights=[sun(vector(0.5, -1.0, -0.4), 3.0)],
    )
    made.environment = Environment(None, vector(0.5, 0.7, 1.0), 0.4)
    return made


def spotlit_corner() -> Scene:
    """One spot light in a dark corner; all else is bounced light."""
    direction = vector(-0.6, -1.0, -0.6)
    lamp = Light(
        "spot",
        "spot",
        vector(1, 1, 1),
        intensity=30.0,
        position=vector(0.9, 1.2, 0.9),
        direction=direction / np.linalg.norm(direction),
        inner_angle=0.25,
        outer_angle=0.45,
    )
    return scene(
        part(box((3, 0.2, 3)), 0, at(0, -1, 0)),
        part(box((3, 3, 0.2)), 1, at(0, 0.4, -1.4)),
        part(box((0.2, 3, 3)), 2, at(-1.4, 0.4, 0)),
        materials=[colored(0.8, 0.8, 0.8), colored(0.8, 0.3, 0.1), colored(0.1, 0.4, 0.8)],
        lights=[lamp],
    )


def stained_room() -> Scene:
    """The coloured room with paint on its back wall and over a box's edge, a glossy patch on its
    floor, a ball of glass and a tinted, two-sided panel before it."""
    made = colored_room()
    made.materials += [
        material(base_color=vector(0.9, 0.6, 0.1, 0.8), alpha_mode="blend", roughness=0.8),
        material(base_color=vector(0.3, 0.3, 0.35, 1), alpha_mode="blend", roughness=0.05),
        material(roughness=0.0, alpha_mode="blend", transmission=1.0, thickness=0.4),
        material(base_color=vector(0.2, 0.5, 0.9, 0.4), alpha_mode="blend", double_sided=True),
    ]
    made.decals = [
        Decal("wall", 4, box_matrix([0.3, 0.2, -0.9], [0, 0, -1], [0, 1, 0], [0.8, 0.6, 0.3])),
        Decal("box", 4, box_matrix([-0.3, -0.1, 0.0], [-0.3, -0.8, -1], [0, 1, 0], [0.3, 0.6, 1])),
        Decal("floor", 5, box_matrix([0, -0.95, 0.5], [0, -1, 0], [0, 0, -1], [1.4, 0.6, 0.2])),
    ]
    glass = [
        part(sphere(0.2, rings=32), 6, at(0.1, -0.2, 0.5), smooth=True),
        part(quad(0.6), 7, turned(vector(1, 0, 0), 1.2, to=(0.5, 0.1, 0.6))),
    ]
    for shape, matrix in glass:
        made.instances.append(Instance("glass", len(made.meshes), matrix))
        made.meshes.append(shape)
    return made


def room_in_volumes() -> Scene:
    """The coloured room under two volumes: one everywhere, one that the eye is half out of."""
    made = colored_room()
    evening = {"color_grading.lut": "evening.cube", "vignette.intensity": 0.8}
    cold = {"exposure": 1.0, "scene_color.tint": (0.4, 0.8, 1.3), "bloom.intensity": 4.0}
    made.volumes = [
        Volume("evening", unbound=True, blend_weight=0.75, overrides=evening),
        Volume(
            "cold",
            "sphere",
            center=(0.3, 0.5, 0.4),
            radius=2.0,
            blend_radius=2.0,
            overrides=cold,
        ),
    ]
    return made


def lamplit_corner() -> Scene:
    """Nine lights, so that they are culled: small ones by their ranges, a warm bulb with penumbras,
    and a wall washer with a profile, in a budget that has them share layers of shadow maps."""
    made = spotlit_corner()
    made.instances.append(Instance("ball", len(made.meshes), at(-0.3, -0.6, -0.2)))
    made.meshes.append(part(sphere(0.3), 0, IDENTITY, smooth=True)[0])
    angles = np.radians([0.0, 20.0, 40.0, 90.0, 180.0])
    candela = np.array([[40.0, 20.0, 2.0, 0.0, 0.0]])
    white, down = vector(1, 1, 1), vector(0, -1, 0)
    bulb = Light("bulb", "point", white, 1.5, vector(0.3, 0.1, 0.4), down,
                 source_radius=0.12, temperature=2700.0)  # fmt: skip
    washer = Light("washer", "point", white, 4.0, vector(0.3, 0.95, -1.15), down,
                   profile=LightProfile("washer", angles, np.zeros(1), candela))  # fmt: skip
    colors = [vector(1, 0.2, 0.1), vector(0.1, 0.4, 1), vector(0.2, 1, 0.3)]
    small = [
        Light(f"small {k}", "point", colors[k % 3], 0.12,
              vector(-1.0 + 0.35 * k, -0.75, 0.9 - 0.1 * k), down, range=0.7)
        for k in range(7)
    ]  # fmt: skip
    made.lights = [bulb, washer, *small]
    return made


LENS: dict[str, Any] = {
    "eye_adaptation.min_brightness": 0.03,
    "eye_adaptation.max_brightness": 2.0,
    "vignette.intensity": 0.6,
    "bloom.intensity": 0.7,
    "bloom.dirt_mask": "dirt.png",
    "lens_flare.intensity": 3.0,
    "lens_flare.threshold": 6.0,
    "color_grading.lut": "evening.cube",
    "scene_color.fringe": 0.5,
    "dof.enabled": True,
    "dof.focal_distance": 320.0,
    "dof.far_transition": 60.0,
    "dof.near_transition": 60.0,
    "dof.f_stop": 6.0,
}
"""All that the lens, the eye and the film do."""

SCENES: dict[str, tuple[Callable[[], Scene], dict[str, Any]]] = {
    "colored_room": (colored_room, {"exposure": 0.0}),
    "colored_room_direct": (colored_room, {"gi.enabled": False}),
    "colored_room_bounces": (colored_room, {"gi.bounces": 3}),
    "sunlit_plaza": (sunlit_plaza, {}),
    "spotlit_corner": (spotlit_corner, {"exposure": 1.0}),
    "lamplit_corner": (lamplit_corner, {"exposure": 1.0, "shadow.budget": 8}),
    "stained_room": (stained_room, {"exposure": 0.5}),
    "room_in_volumes": (room_in_volumes, {}),
    "colored_room_lens": (colored_room, LENS),
    "sunlit_plaza_lens": (sunlit_plaza, LENS),
}


def camera() -> Camera:
    """In front of the scenes, a little above."""
    view_from_world = transforms.look_at((0.3, 0.5, 3.4), (0.0, -0.1, 0.0))
    return Camera("golden", transforms.inverse(view_from_world), fov_y=0.8, near=0.05)


def draw(device: Device, name: str) -> npt.NDArray[np.uint8]:
    """The finished picture (H, W, 3) of one of SCENES."""
    make, settings = SCENES[name]
    renderer = Renderer(device, make(), Settings({**SETTINGS, **settings}), SIZE)
    try:
        picture = renderer.read(renderer.render(camera(), 0.0, 0))
        device.finish()
        return np.ascontiguousarray(picture[..., :3], np.uint8)
    finally:
        renderer.release()
