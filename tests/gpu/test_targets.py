"""Render targets of every shape: mips, layers, slices, faces, depth-stencil, none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from elemental.gpu.binding import GraphError
from elemental.gpu.device import Device
from elemental.gpu.encode import Encoder
from elemental.gpu.formats import D16, D24S8, D32F, R8, R32F, R32UI, RGBA8, RGBA16F
from elemental.gpu.refs import Layer, Mip, Sampled
from elemental.gpu.state import RasterState, Stencil
from gpu.sources import FULL_SCREEN, Sources

CONSTANT = "o_color = vec4({});"


def test_each_mip_from_the_one_above(device: Device, sources: Sources) -> None:
    """A mip chain by hand: level i is read, level i + 1 of the same texture written."""
    first = sources.full_screen("o_color = vec4(1.0);")
    half = sources.full_screen(
        "o_color = 0.5 * texture(u_image, v_uv);", "uniform sampler2D u_image; out vec4 o_color;"
    )
    graph = device.begin_frame()
    image = graph.texture("image", (8, 4), RGBA16F, mips=4)
    graph.raster(first, color=Mip(image, 0))
    for level in range(3):
        graph.raster(half, color=Mip(image, level + 1), reads={"u_image": Mip(image, level)})
    graph.keep(image)
    graph.execute()
    assert image.physical
    for level in range(4):
        texels = image.physical.read(level)
        assert texels.shape == (max(1, 4 >> level), 8 >> level, 4)
        assert (texels == 0.5**level).all()


def test_clearing_one_mip_keeps_the_others(device: Device, sources: Sources) -> None:
    shader = sources.full_screen("o_color = vec4(1.0);")
    graph = device.begin_frame()
    image = graph.texture("image", (4, 4), RGBA16F, mips=2)
    graph.raster(shader, color=Mip(image, 0))
    graph.raster(shader, color=Mip(image, 1), clear_color=(0.5,) * 4, vertices=0)
    graph.keep(image)
    graph.execute()
    assert image.physical
    assert (image.physical.read(0) == 1).all()
    assert (image.physical.read(1) == 0.5).all()


def test_each_mip_by_image_stores(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "ivec3 p = ivec3(gl_GlobalInvocationID);"
        "imageStore(o_half, p, imageLoad(u_whole, p * 2) + 1.0);",
        "layout(r32f) readonly uniform image3D u_whole;"
        "layout(r32f) writeonly uniform image3D o_half;",
        (2, 2, 2),
    )
    graph = device.begin_frame()
    image = graph.texture("image", (8, 8, 8), R32F, mips=3)
    graph.clear_texture(image, (5,))
    for level in range(2):
        reads, writes = {"u_whole": Mip(image, level)}, {"o_half": Mip(image, level + 1)}
        graph.compute(shader, reads=reads, writes=writes, threads=[4 >> level] * 3)
    graph.keep(image)
    graph.execute()
    assert image.physical
    assert [image.physical.read(level).max() for level in range(3)] == [5, 6, 7]
    assert image.physical.read(2).min() == 7


@pytest.mark.parametrize(
    "shape",
    [{"size": (4, 4), "layers": 6}, {"size": (4, 4), "cube": True}, {"size": (4, 4, 6)},
     {"size": (4, 4), "cube": True, "layers": 1}],
)  # fmt: skip
def test_layers_faces_and_slices(
    device: Device, sources: Sources, shape: dict[str, object]
) -> None:
    graph = device.begin_frame()
    image = graph.texture("image", format=R8, mips=2, **shape)
    for layer in range(6):
        shader = sources.full_screen(CONSTANT.format(f"{(layer + 1) * 10.0} / 255.0"))
        graph.raster(shader, color=Layer(image, layer))
    graph.keep(image)
    graph.execute()
    assert image.physical
    texels = image.physical.read()
    assert texels.shape == (6, 4, 4)
    assert texels[:, 0, 0].tolist() == [10, 20, 30, 40, 50, 60]
    assert (texels == texels[:, :1, :1]).all()


def test_sampling_one_layer_and_an_array_of_faces(device: Device, sources: Sources) -> None:
    shader = sources.compute(
        "values[0] = texture(u_layer, vec2(0.5)).r;"
        "values[1] = texture(u_faces, vec3(0.5, 0.5, 3.0)).r;"
        "values[2] = texture(u_cube, vec3(0.0, -1.0, 0.0)).r;",
        "uniform sampler2D u_layer; uniform sampler2DArray u_faces; uniform samplerCube u_cube;"
        "layout(std430) buffer Values { float values[]; };",
        (1, 1, 1),
    )
    texels = np.repeat(np.arange(6, dtype=np.float32), 16)
    cube = device.texture("cube", (4, 4), R32F, cube=True, data=texels)
    values = device.buffer("values", 12)
    graph = device.begin_frame()
    reads = {"u_layer": Layer(cube, 4), "u_faces": cube, "u_cube": cube}
    graph.compute(shader, reads=reads, writes={"Values": values}, groups=1)
    graph.execute()
    assert values.read(np.float32).tolist() == [4, 3, 3]
    cube.release()
    values.release()


def test_a_geometry_shader_fills_all_layers(device: Device, sources: Sources) -> None:
    shader = sources.mesh(
        FULL_SCREEN,
        "flat in int v_layer; out uint o_id; void main() { o_id = uint(v_layer) + 5u; }",
        """
        layout(triangles) in; layout(triangle_strip, max_vertices = 9) out;
        flat out int v_layer; in vec2 v_uv[];
        void main() {
            for (int layer = 0; layer < 3; ++layer) {
                for (int i = 0; i < 3; ++i) {
                    gl_Layer = v_layer = layer;
                    gl_Position = gl_in[i].gl_Position;
                    EmitVertex();
                }
                EndPrimitive();
            }
        }
        """,
    )
    graph = device.begin_frame()
    image = graph.texture("image", (4, 4), R32UI, layers=3)
    graph.raster(shader, color=image, clear_color=(1, 0, 0, 0))
    graph.keep(image)
    graph.execute()
    assert image.physical
    assert image.physical.read()[:, 1, 1].tolist() == [5, 6, 7]


def test_several_targets_with_their_own_clears_and_blending(
    device: Device, sources: Sources
) -> None:
    shader = sources.full_screen(
        "a = vec4(0.25); b = vec4(0.25); c = 9u;",
        "layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;"
        "layout(location = 2) out uint c;",
    )
    graph = device.begin_frame()
    a, b = (graph.texture(name, (4, 4), RGBA16F) for name in "ab")
    ids = graph.texture("ids", (4, 4), R32UI)
    before = graph.texture("before", (4, 4), RGBA16F)
    plain = sources.full_screen("o_color = vec4(1);")
    graph.raster(plain, color=before, state=RasterState(blend="add"))
    state = RasterState(blend=("add", None, None))
    graph.raster(
        shader, color=[a, b, ids], state=state, viewport=(0, 0, 2, 4),
        clear_color=[(1, 1, 1, 1), (0.5, 0, 0, 0), (3, 0, 0, 0)],
    )  # fmt: skip
    for handle in (before, a, b, ids):
        graph.keep(handle)
    graph.execute()
    assert a.physical
    assert b.physical
    assert ids.physical
    assert a.physical.read()[0, :, 0].tolist() == [1.25, 1.25, 1, 1]
    assert b.physical.read()[0, :, 0].tolist() == [0.25, 0.25, 0.5, 0.5]
    assert ids.physical.read()[0].tolist() == [9, 9, 3, 3]


def test_no_target_at_all(device: Device, sources: Sources) -> None:
    shader = sources.full_screen(
        "atomicAdd(fragments, 1u);", "layout(std430) buffer Count { uint fragments; };"
    )
    count = device.buffer("count", np.zeros(1, np.uint32))
    graph = device.begin_frame()
    graph.raster(shader, size=(48, 20), writes={"Count": count})
    graph.raster(shader, size=(16, 16), writes={"Count": count}, vertices=0)
    graph.execute()
    assert count.read(np.uint32)[0] == 48 * 20
    with pytest.raises(GraphError, match="needs size="):
        device.begin_frame().raster(shader, writes={"Count": count})
    count.release()


def test_targets_of_different_sizes_are_refused(device: Device, sources: Sources) -> None:
    graph = device.begin_frame()
    color, depth = graph.texture("a", (8, 8), RGBA8), graph.texture("b", (8, 4), D32F)
    with pytest.raises(GraphError, match=r"b is 8x4, not \(8, 8\)"):
        graph.raster(sources.full_screen("o_color = vec4(1);"), color=color, depth=depth)


def test_reading_what_is_rendered_to_is_refused(device: Device, sources: Sources) -> None:
    shader = sources.full_screen(
        "o_color = texture(u_image, v_uv);", "uniform sampler2D u_image; out vec4 o_color;"
    )
    graph = device.begin_frame()
    image = graph.texture("image", (8, 8), RGBA16F, mips=2)
    graph.clear_texture(image)
    cube = graph.texture("cube", (8, 8), RGBA16F, cube=True)
    graph.clear_texture(cube)
    for target, read in (
        (image, image),
        (Mip(image, 1), image),
        (Mip(image, 1), Mip(image, 1)),
        (Layer(cube, 2), Layer(cube, 2)),
    ):
        with pytest.raises(GraphError, match="is rendered to and read in one pass"):
            graph.raster(shader, color=target, reads={"u_image": read})
    graph.raster(shader, color=Mip(image, 1), reads={"u_image": Mip(image, 0)})
    graph.raster(shader, color=Layer(cube, 2), reads={"u_image": Layer(cube, 3)})
    depth = graph.texture("depth", (8, 8), D32F)
    graph.clear_texture(depth, (1,))
    color = graph.texture("color", (8, 8), RGBA16F)
    for writes in (True, False):  # GL 4.3 knows no texture barriers
        state = RasterState(depth_test="less", depth_write=writes)
        with pytest.raises(GraphError, match="depth is rendered to and read"):
            graph.raster(shader, color=color, depth=depth, state=state, reads={"u_image": depth})
    for handle in (image, cube):
        graph.keep(handle)
    graph.execute()


@pytest.mark.parametrize("fmt", [D16, D24S8, D32F])
def test_depth_is_tested_written_and_sampled(device: Device, sources: Sources, fmt: Any) -> None:
    """The left half at depth 0.25, then everything at 0.5: the right half is drawn."""
    near, far = (
        sources.mesh(
            FULL_SCREEN.replace("0.0, 1.0);", f"{z * 2 - 1}, 1.0);"),
            f"out vec4 o_color; void main() {{ o_color = vec4({z}); }}",
        )
        for z in (0.25, 0.5)
    )
    show = sources.full_screen(
        "o_color = vec4(texture(u_depth, v_uv).r, texture(u_shadow, vec3(v_uv, 0.3)), 0, 1);",
        "uniform sampler2D u_depth; uniform sampler2DShadow u_shadow; out vec4 o_color;",
    )
    graph = device.begin_frame()
    color = graph.texture("color", (4, 4), R32F)
    depth = graph.texture("depth", (4, 4), fmt)
    with pytest.raises(GraphError, match="u_depth: depth is sampled with compare"):
        graph.raster(show, color=color, reads={"u_depth": Sampled(depth, compare=True)})
    with pytest.raises(GraphError, match="u_shadow: depth is sampled without compare"):
        graph.raster(show, color=color, reads={"u_shadow": Sampled(depth)})
    shown = graph.texture("shown", (4, 4), RGBA16F)
    state = RasterState(depth_test="less")
    left = (0, 0, 2, 4)
    graph.raster(near, color=color, depth=depth, state=state, clear_depth=1.0, viewport=left)
    graph.raster(far, color=color, depth=depth, state=state)
    graph.raster(show, color=shown, reads={"u_depth": depth, "u_shadow": depth})
    for handle in (color, shown, depth):
        graph.keep(handle)
    graph.execute()
    assert color.physical
    assert shown.physical
    assert depth.physical
    assert color.physical.read()[0].tolist() == [0.25, 0.25, 0.5, 0.5]
    texels = shown.physical.read()[0].astype(np.float32)
    np.testing.assert_allclose(texels[:, 0], [0.25, 0.25, 0.5, 0.5], atol=1e-3)
    np.testing.assert_array_equal(texels[:, 1], [0, 0, 1, 1])


def test_clears_keep_to_a_tile(device: Device, sources: Sources) -> None:
    """Passes before one that clears a tile stay: even those into the only layer of an array."""
    shader = sources.full_screen("o_color = vec4(0.25); gl_FragDepth = 0.25;")
    state = RasterState(depth_test="always")
    graph = device.begin_frame()
    color = graph.texture("color", (4, 4), R32F)
    depth = graph.texture("depth", (4, 4), D32F, layers=1)
    targets = {"color": color, "depth": Layer(depth, 0), "state": state}
    graph.raster(shader, **targets)
    graph.raster(
        shader, **targets, clear_color=(0.5,) * 4, clear_depth=1.0, tile=(1, 0, 2, 3), vertices=0
    )
    graph.raster(shader, **targets, tile=(3, 3, 1, 1))
    graph.keep(color)
    graph.keep(depth)
    graph.execute()
    assert color.physical
    assert depth.physical
    cleared = np.zeros((4, 4), bool)
    cleared[:3, 1:3] = True
    np.testing.assert_array_equal(color.physical.read(), np.where(cleared, 0.5, 0.25))
    np.testing.assert_array_equal(depth.physical.read()[0], np.where(cleared, 1.0, 0.25))


def test_stencil_masks_and_is_sampled_beside_depth(device: Device, sources: Sources) -> None:
    mark = sources.full_screen("o_color = vec4(1);")
    show = sources.full_screen(
        "o_color = vec4(float(texture(u_stencil, v_uv).r), texture(u_depth, v_uv).r, 0, 1);",
        "uniform usampler2D u_stencil; uniform sampler2D u_depth; out vec4 o_color;",
    )
    write = RasterState(
        stencil=Stencil(reference=7, on_pass="replace"), color_mask=(False,) * 4
    )  # fmt: skip
    masked = RasterState(stencil=Stencil(test="equal", reference=7))
    graph = device.begin_frame()
    color, shown = (graph.texture(name, (4, 4), RGBA16F) for name in ("color", "shown"))
    depth = graph.texture("depth", (4, 4), D24S8)
    graph.raster(
        mark, color=color, depth=depth, state=write, clear_color=(0, 0, 0, 0), clear_depth=0.5,
        clear_stencil=2, viewport=(0, 0, 2, 4),
    )  # fmt: skip
    graph.raster(mark, color=color, depth=depth, state=masked)
    reads = {"u_stencil": Sampled(depth, stencil=True), "u_depth": depth}
    graph.raster(show, color=shown, reads=reads)
    for handle in (color, shown):
        graph.keep(handle)
    graph.execute()
    assert color.physical
    assert shown.physical
    assert color.physical.read()[0, :, 0].tolist() == [1, 1, 0, 0]
    texels = shown.physical.read()[0].astype(np.float32)
    assert texels[:, 0].tolist() == [7, 7, 2, 2]
    np.testing.assert_allclose(texels[:, 1], 0.5, atol=1e-3)


def test_state_of_one_pass_does_not_leak_into_the_next(device: Device, sources: Sources) -> None:
    shader = sources.full_screen("o_color = vec4(0.25);")
    odd = RasterState(
        cull="front", depth_test="never", blend="add", color_mask=(True, False, True, False),
        stencil=Stencil(test="never"), polygon_offset=(1, 1),
    )  # fmt: skip
    graph = device.begin_frame()
    color, depth = graph.texture("color", (4, 4), RGBA16F), graph.texture("depth", (4, 4), D24S8)
    graph.raster(shader, color=color, depth=depth, state=odd, clear_color=(1,) * 4, clear_depth=1)
    graph.raster(shader, color=color, viewport=(0, 0, 2, 2))
    graph.keep(color)
    graph.execute()
    assert color.physical
    texels = color.physical.read()
    assert texels[0, :, 0].tolist() == [0.25, 0.25, 1, 1]
    assert (texels[3] == 1).all()


def test_a_draw_callback_binds_changes_state_and_draws(device: Device, sources: Sources) -> None:
    shader = sources.mesh(
        "in vec2 a_position; in uint a_shade; in vec4 a_unused; flat out uint v_shade;"
        "void main() { v_shade = a_shade; gl_Position = vec4(a_position, 0.0, 1.0); }",
        "flat in uint v_shade; uniform sampler2D u_tint; out vec4 o_color;"
        "void main() { o_color = vec4(v_shade) * texture(u_tint, vec2(0.5)); }",
    )
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32)
    position = device.buffer("position", corners, "meshes")
    shade = device.buffer("shade", np.array([3, 5], np.uint32), "meshes")
    index = device.buffer("index", np.array([0, 1, 2, 0, 2, 3], np.uint32), "meshes")
    content = [(position, "2f", ("a_position",)), (shade, "1u/i", ("a_shade",))]
    quad = device.vertex_input([*content, (position, "2f", ("a_other",))], index)
    tint = device.texture("tint", (1, 1), R32F, data=np.array([2], np.float32))
    image = device.texture("image", (4, 4), RGBA16F)

    def draw(encoder: Encoder) -> None:
        with pytest.raises(GraphError, match="u_tint not bound"):
            encoder.draw(quad, 6)
        encoder.bind("u_tint", Sampled(tint, "nearest"))
        encoder.draw(quad, 3)  # the lower right triangle
        encoder.set(cull="front")
        encoder.draw(quad, 3, first=3)

    graph = device.begin_frame()
    graph.raster(shader, color=image, clear_color=(1, 0, 0, 0), draw=draw)
    graph.execute()
    texels = image.read()[..., 0]
    assert (texels[0, 3], texels[3, 0]) == (6, 1)
    for resource in (quad, position, shade, index, tint, image):
        resource.release()
