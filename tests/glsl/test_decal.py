"""What decals do to a surface, against numpy. SH-07"""

from __future__ import annotations

import numpy as np

from elemental.gpu.device import Device
from glsl.harness import run_glsl


def test_a_decal_fades_out_between_two_angles(device: Device) -> None:
    angle = np.radians([0.0, 59.0, 60.0, 70.0, 80.0, 90.0, 180.0])
    normal = np.stack([np.sin(angle), np.zeros(7), np.cos(angle)], axis=1)
    begin, end = np.cos(np.radians([60.0, 80.0]))
    body = f"decal_fade(n, vec3(0, 0, 1), {end}, {1 / (begin - end)})"
    got = run_glsl(device, ["lib/decal.glsl"], body, {"n": normal})
    want = np.clip((np.cos(angle) - end) / (begin - end), 0, 1)
    np.testing.assert_allclose(got, want, atol=1e-5)
    assert got[0] == got[1] == 1.0
    assert got[5] == got[6] == 0.0


def test_a_step_in_a_plane_ends_where_the_next_ray_meets_it(device: Device) -> None:
    rng = np.random.default_rng(4)
    ray = rng.normal(size=(200, 3)) * 0.3 + [0, 0, -1]
    step = rng.normal(size=(200, 3)) * 0.01
    normal = rng.normal(size=(200, 3)) * 0.4 + [0, 0, 1]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    p = ray * rng.uniform(0.5, 20, size=(200, 1))
    inputs = {"p": p, "n": normal, "ray": ray, "more": step}
    got = run_glsl(device, ["lib/decal.glsl"], "step_in_plane(p, n, ray, more)", inputs, "vec3")
    along = np.sum(normal * p, axis=1) / np.sum(normal * (ray + step), axis=1)
    want = along[:, None] * (ray + step) - p
    slanted = np.abs(np.sum(normal * ray, axis=1)) > 0.3
    assert slanted.sum() > 150
    np.testing.assert_allclose(got[slanted], want[slanted], rtol=1e-2, atol=1e-4)
    np.testing.assert_allclose(np.sum(got * normal, axis=1)[slanted], 0.0, atol=1e-4)


def test_a_receiver_is_kept_as_exactly_as_the_gbuffer_holds_it(device: Device) -> None:
    rng = np.random.default_rng(7)
    depth = np.concatenate([[0, 1, 2**24 - 2, 2**24 - 1], rng.integers(0, 2**24, 500)])
    count = len(depth)
    normal, mask = rng.integers(0, 1024, (count, 3)), rng.integers(0, 256, count)
    inputs = {
        "depth": (depth / (2**24 - 1)).astype(np.float32),
        "normal": (normal / 1023).astype(np.float32),
        "mask": (mask / 255).astype(np.float32),
    }
    body = "codes(receiver_unpack(receiver_pack(Receiver(depth, normal, mask))))"
    functions = """uvec4 codes(Receiver r) {
        uvec3 n = uvec3(r.normal_code * 1023.0 + 0.5);
        return uvec4(uint(round(r.depth * 16777215.0)), n.x | n.y << 10 | n.z << 20,
                     uint(r.mask * 255.0 + 0.5), 0u);
    }"""
    got = run_glsl(device, ["lib/decal.glsl"], body, inputs, "uvec4", functions=functions)
    np.testing.assert_array_equal(got[:, 0], depth)
    np.testing.assert_array_equal(got[:, 1], normal @ [1, 1 << 10, 1 << 20])
    np.testing.assert_array_equal(got[:, 2], mask)
