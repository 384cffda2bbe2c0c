"""Which emitters are parallelograms and balls. GI-15"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from elemental.scene.area_lights import FACES_MAX, area_lights, followed, parallelograms
from elemental.scene.evaluate import evaluate
from elemental.scene.model import Scene, TextureSlot
from gpu.rig import UNLIT, at, mesh, scene, sun, vector
from gpu.voxel.scenes import colored, glowing, part, turned
from shapes import Shape, box, inward, quad, sphere, torus


def of(shape: Shape, **fields: object) -> Scene:
    """A wall and an emitter of this shape."""
    wall = part(quad(8.0), 0, at(0, -2, 0))
    materials = [colored(1, 1, 1), glowing(10.0, **fields)]
    return scene(wall, part(shape, 1, at(0, 0, 0)), materials=materials)


def test_a_square_is_one_face_that_points_to_its_front() -> None:
    (light,) = area_lights(of(quad(0.5)))
    assert light.instance == 1
    front = np.cross(light.edge_u, light.edge_v)
    np.testing.assert_allclose(front, [0, 0.25, 0], atol=1e-6)
    middle = light.corner + 0.5 * (light.edge_u + light.edge_v)
    np.testing.assert_allclose(middle, 0, atol=1e-6)
    assert light.flux == pytest.approx(3 * np.pi * 10.0 * 0.25)


def test_a_box_has_six_faces_that_point_away_from_it() -> None:
    lights = area_lights(of(box((1, 2, 3))))
    assert len(lights) == 6
    for light in lights:
        middle = light.corner + 0.5 * (light.edge_u + light.edge_v)
        front = np.cross(light.edge_u, light.edge_v)
        assert np.dot(front, middle) > 0.0
        np.testing.assert_allclose(np.linalg.norm(np.cross(front, middle)), 0, atol=1e-5)
    assert sum(np.linalg.norm(np.cross(x.edge_u, x.edge_v)) for x in lights) == pytest.approx(22.0)


def test_any_order_of_the_triangles_corners_gives_the_same_square() -> None:
    positions, indices = quad()
    for turn in range(3):
        for other in range(3):
            triangles = indices.reshape(2, 3)
            rolled = np.concatenate([np.roll(triangles[0], turn), np.roll(triangles[1], other)])
            faces = parallelograms(mesh((positions, rolled.astype(np.uint32)), 0))
            assert faces is not None
            np.testing.assert_allclose(np.cross(faces[0, 1], faces[0, 2]), [0, 1, 0], atol=1e-6)


def test_a_placed_face_moves_turns_and_stretches() -> None:
    matrix = turned(vector(1, 0, 0), np.pi / 2, to=(1, 2, 3)) @ np.diag([2, 1, 3, 1])
    base = of(quad())
    base.instances[1] = replace(base.instances[1], world_from_local=matrix.astype(np.float32))
    (light,) = area_lights(base)
    front = np.cross(light.edge_u, light.edge_v)
    np.testing.assert_allclose(front, [0, 0, 6], atol=1e-5)
    middle = light.corner + 0.5 * (light.edge_u + light.edge_v)
    np.testing.assert_allclose(middle, [1, 2, 3], atol=1e-5)


def _kite() -> Shape:
    positions, indices = quad()
    positions[0] *= 1.5
    return positions, indices


def _dented() -> Shape:
    positions, indices = sphere(0.5)
    positions[100] *= 0.9
    return positions, indices


def _ellipsoid() -> Shape:
    positions, indices = sphere(0.5)
    return positions * np.array([1.0, 1.05, 1.0]), indices


def _half() -> Shape:
    positions, indices = sphere(0.5)
    return positions, indices[: len(indices) // 2]


OTHERS = {
    "torus": torus(0.4, 0.1),
    "kite": _kite(),
    "coarse ball": sphere(0.5, 4),
    "dented ball": _dented(),
    "ellipsoid": _ellipsoid(),
    "half a ball": _half(),
    "hollow": inward(sphere(0.5)),
}


@pytest.mark.parametrize("shape", OTHERS.values(), ids=OTHERS)
def test_other_shapes_are_left_to_the_voxels(shape: Shape) -> None:
    assert area_lights(of(shape)) == []


def test_a_ball_is_one_light_with_the_power_of_its_mesh() -> None:
    """Wherever it is, turned and scaled; not where it is stretched, nor a dome around the scene."""
    matrix = turned(vector(1, 0, 0.3), 0.7, to=(1, 2, 3)) @ np.diag([2, 2, 2, 1])
    shape = sphere(0.25, 8)
    base = of(shape, double_sided=True)
    base.instances[1] = replace(base.instances[1], world_from_local=matrix.astype(np.float32))
    (light,) = area_lights(base)
    triangles = shape[0][shape[1].reshape(-1, 3)].astype(float)
    edges = np.diff(triangles, axis=1)
    area = 4.0 * 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum()
    assert light.flux == pytest.approx(3 * np.pi * 10.0 * area, rel=1e-5)
    assert light.ball_radius == pytest.approx(np.sqrt(area / (4 * np.pi)), rel=1e-5)
    np.testing.assert_allclose(light.corner, [1, 2, 3], atol=1e-6)
    stretched = (matrix @ np.diag([1, 1.1, 1, 1])).astype(np.float32)
    base.instances[1] = replace(base.instances[1], world_from_local=stretched)
    assert area_lights(base) == []
    assert area_lights(of(sphere(9.0), double_sided=True)) == []
    assert len(area_lights(of(sphere(9.0)))) == 1


def test_a_ball_goes_where_its_pose_is() -> None:
    base = of(sphere(0.25))
    base.instances[1].dynamic = True
    pose = evaluate(base, 0.0)
    world = pose.world_from_local.copy()
    world[0] = at(3, 0, 1)
    (light,) = followed(base, area_lights(base), replace(pose, world_from_local=world))
    np.testing.assert_allclose(light.corner, [3, 0, 1], atol=1e-6)
    assert light.ball_radius == pytest.approx(0.25, rel=0.01)


@pytest.mark.parametrize(("dynamic", "lights"), [(False, 0), (True, 1)])
def test_a_weak_lamp_counts_where_it_can_move(dynamic: bool, lights: int) -> None:
    base = of(sphere(0.25))
    (light,) = area_lights(base)
    base.lights.append(sun(vector(0, -1, 0)))
    strength = float(base.lights[0].strength.sum())
    low, high = base.bounds()
    disc = np.pi * 0.25 * float(((high - low) ** 2).sum())
    base.lights[0] = sun(vector(0, -1, 0), light.flux / (0.003 * disc * strength))
    base.instances[1].dynamic = dynamic
    assert len(area_lights(base)) == lights


def test_textured_masked_and_unlit_emitters_are_left_to_the_voxels() -> None:
    assert area_lights(of(quad(), emissive_texture=TextureSlot(0))) == []
    assert area_lights(of(quad(), alpha_mode="mask")) == []
    assert area_lights(of(quad(), definition=UNLIT)) == []


def test_an_emitter_that_the_sun_outshines_is_left_to_the_voxels() -> None:
    dim = of(quad(0.5))
    dim.lights.append(sun(vector(0, -1, 0), 1000.0))
    assert area_lights(dim) == []


def test_the_strongest_are_chosen_whole() -> None:
    boxes = [part(box((k, k, k)), 0, at(5 * k, 0, 0)) for k in (1, 2, 3, 4)]
    lights = area_lights(scene(*boxes, materials=[glowing(5.0)]))
    assert sorted({x.instance for x in lights}) == [2, 3]
    assert len(lights) == 12 <= FACES_MAX
