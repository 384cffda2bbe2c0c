"""The G-buffer blur in frames: what it averages, where it stops, and how far shine crawls. SH-08"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.core import transforms
from elemental.passes.gbuffer_blur import blur_gbuffer
from elemental.passes.shade import shade
from elemental.scene.model import Scene, Texture, TextureSlot
from gpu.rig import IDENTITY, MakeRig, Rig, at, camera, material, mesh, read, scene, sun, vector
from shapes import box, quad, sphere

Array = npt.NDArray[Any]
ABOVE = camera(vector(0, 3, 0.01), vector(0, 0, 0), fov_y=0.6)


def normals(codes: Array) -> Array:
    """(H, W, 3) of RGB10_A2 texels."""
    n = (np.stack([codes >> shift & 1023 for shift in (0, 10, 20)], axis=-1) - 512.0) / 511.0
    return n / np.maximum(np.linalg.norm(n, axis=-1, keepdims=True), 1e-9)


def powers(codes: Array) -> Array:
    return np.exp2(codes[..., 0] / 255.0 * 19 - 1)


def targets(view: Rig, blur: bool) -> dict[str, Array]:
    """G-buffer targets by name, row 0 on top."""
    made = {}
    for name in ("a", "b", "d"):
        g, block, gb = view.begin()
        made[name] = read(g, getattr(blur_gbuffer(g, block, gb) if blur else gb, name))
    return made


def bumpy(rng_seed: int = 1, texels: int = 64, tilt: float = 0.5) -> Texture:
    """A tangent-space normal map of independent texels."""
    rng = np.random.default_rng(rng_seed)
    xy = rng.normal(size=(texels, texels, 2)) * tilt
    n = np.concatenate([xy, np.ones((texels, texels, 1))], axis=-1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    pixels = np.full((texels, texels, 4), 255, np.uint8)
    pixels[..., :3] = np.round(n * 127 + 128)
    return Texture("bumps", pixels)


def shiny_plane() -> Scene:
    uv = (quad(2.0)[0][quad(2.0)[1]][:, [0, 2]] + 1.0) / 2
    shiny = material(normal_texture=TextureSlot(0), roughness=0.25)
    return scene((mesh(quad(2.0), uv=uv), IDENTITY), materials=[shiny], textures=[bumpy()])


def test_five_normals_are_averaged_and_the_power_follows(rig: MakeRig) -> None:
    """A numpy model of the pass on the very texels that it reads. The camera looks straight down on
    a plane, so that every neighbour is within a pixel of every tangent plane or counts by it."""
    view = rig(shiny_plane(), ABOVE)
    plain, blurred = targets(view, False), targets(view, True)
    n, p = normals(plain["a"]), powers(plain["d"])
    points = view.positions()
    centre = np.s_[20:44, 30:66]
    total, weights = n.copy(), np.ones(n.shape[:2])
    pixel_m = np.linalg.norm(points[32, 49] - points[32, 48])
    for shift in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        other, other_p = (np.roll(v, shift, axis=(0, 1)) for v in (n, points))
        off = np.abs(np.sum((other_p - points) * n, axis=-1)) / pixel_m
        cosine = np.clip(np.sum(n * other, axis=-1), 0, 1)
        weight = cosine**2 * np.clip(1 - off / 4, 0, 1)
        total += weight[..., None] * other
        weights += weight
    length = np.clip(np.linalg.norm(total, axis=-1) / weights * 1.002, 0, 1)
    want_n = total / np.linalg.norm(total, axis=-1, keepdims=True)
    want_p = p * length / (length + p * (1 - length))
    np.testing.assert_allclose(normals(blurred["a"])[centre], want_n[centre], atol=5e-3)
    code = (np.log2(np.maximum(want_p, 0.5)) + 1) / 19 * 255
    assert np.abs(blurred["d"][centre][..., 0] - code[centre]).max() < 1.1
    assert np.median(powers(blurred["d"])[centre]) < 0.3 * p[32, 48]
    np.testing.assert_array_equal(blurred["a"] >> 30, plain["a"] >> 30)  # lighting models
    np.testing.assert_array_equal(blurred["b"][..., :3], plain["b"][..., :3])
    np.testing.assert_array_equal(blurred["d"][..., 1:], plain["d"][..., 1:])


def test_a_smooth_surface_stays_as_it_is(rig: MakeRig) -> None:
    """Flat at any slant, and round where it spans many pixels: normals and powers stay, but for
    what a turn of three degrees a pixel takes off: 3 codes are 0.16 stops."""
    low = camera(vector(0, 0.4, 3), vector(0, 0, 0), fov_y=0.6)
    for shape, eye, smooth in ((quad(2.0), low, False), (sphere(rings=48), ABOVE, True)):
        surface = material(roughness=0.4)
        view = rig(scene((mesh(shape, smooth=smooth), IDENTITY), materials=[surface]), eye)
        plain, blurred = targets(view, False), targets(view, True)
        hit = np.isfinite(view.positions()[..., 0])
        facing = hit & (np.sum(normals(plain["a"]) * eye.world_from_view[:3, 2], axis=-1) > 0.5)
        facing |= hit & (not smooth)
        assert facing.sum() > 500
        apart = np.abs(normals(plain["a"]) - normals(blurred["a"]))[facing]
        assert apart.max() < 0.02
        assert (plain["d"][facing][:, 0].astype(int) - blurred["d"][facing][:, 0]).max() <= 3


def test_edges_and_steps_are_not_blurred_over(rig: MakeRig) -> None:
    """A box high above a floor of the same normal but another AO, and its own sides."""
    surfaces = [material(occlusion_texture=TextureSlot(0)), material()]
    world = scene(
        (mesh(quad(6.0), 0), at(0, -2, 0)),
        (mesh(box((1, 0.5, 1)), 1), IDENTITY),
        materials=surfaces,
        textures=[Texture("ao", np.full((1, 1, 4), 64, np.uint8))],
    )
    view = rig(world, camera(vector(2, 3, 2), vector(0, 0, 0), fov_y=0.6))
    plain, blurred = targets(view, False), targets(view, True)
    np.testing.assert_array_equal(plain["b"], blurred["b"])
    assert set(np.unique(plain["b"][..., 3])) == {0, 64, 255}  # 0: nothing is there
    np.testing.assert_allclose(normals(plain["a"]), normals(blurred["a"]), atol=3e-3)


def test_ambient_occlusion_loses_its_dither(rig: MakeRig) -> None:
    """The mean of five independent values has 0.45 of their deviation."""
    rng = np.random.default_rng(5)
    noise = np.full((96, 96, 4), 255, np.uint8)
    noise[..., 0] = rng.integers(0, 2, size=(96, 96)) * 128 + 64
    uv = (quad(2.0)[0][quad(2.0)[1]][:, [0, 2]] + 1.0) / 2
    surface = material(occlusion_texture=TextureSlot(0))
    view = rig(
        scene((mesh(quad(2.0), uv=uv), IDENTITY), materials=[surface],
              textures=[Texture("noise", noise, nearest=True)]),
        ABOVE,
    )  # fmt: skip
    plain, blurred = (targets(view, blur)["b"][16:48, 24:72, 3] for blur in (False, True))
    assert blurred.std() < 0.5 * plain.std()
    assert abs(blurred.mean() - plain.mean()) < 2.0


def test_shine_on_a_turning_bumpy_sphere_crawls_half_as_much(rig: MakeRig) -> None:
    """Variance of the specular light from frame to frame, as displayed."""
    ball = mesh(sphere(rings=32), smooth=True)
    p = ball.positions
    ball.uv0 = np.stack([np.arctan2(p[:, 0], p[:, 2]), np.arccos(np.clip(p[:, 1], -1, 1))], axis=1)
    ball.uv0 = (ball.uv0 / np.pi).astype(np.float32)
    surface = material(
        base_color=vector(1, 1, 1, 1), metallic=1.0, roughness=0.3, normal_texture=TextureSlot(0)
    )
    steps = 10
    seen: dict[bool, list[Array]] = {False: [], True: []}
    for step in range(steps):
        half = 0.5 * 0.01 * step
        turned = transforms.rotation([0.0, np.sin(half), 0.0, np.cos(half)])
        world = scene((ball, turned), materials=[surface], textures=[bumpy(2, 48, 0.3)],
                      lights=[sun(vector(-0.5, -1, -0.6), 3.0, casts_shadow=False)])  # fmt: skip
        view = rig(world, camera(vector(0.2, 1.0, 4.0), vector(0, 0, 0), fov_y=0.6))
        for blur, frames in seen.items():
            g, block, gb = view.begin()
            radiance = shade(g, block, blur_gbuffer(g, block, gb) if blur else gb, view.shadows)
            light = read(g, radiance)[..., 0].astype(np.float64)
            frames.append(light / (1.0 + light))
    change = {blur: np.diff(np.stack(frames), axis=0) for blur, frames in seen.items()}
    variance = {blur: float(np.mean(difference**2)) for blur, difference in change.items()}
    assert variance[False] > 1e-5
    assert variance[True] < 0.5 * variance[False]
