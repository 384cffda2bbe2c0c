"""Buffers as vertex shaders read them: by texels and as uniform blocks."""

from __future__ import annotations

import numpy as np
import pytest

from elemental.core.layout import layouts
from elemental.gpu.binding import GraphError
from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA32F
from elemental.gpu.program import buffer_variables
from elemental.gpu.shaders import Raster, ShaderError
from elemental.passes.post.bloom import THRESHOLD
from elemental.passes.post.lens_flare import GHOSTS
from gpu.sources import Sources

FLAT = """
uniform usamplerBuffer u_rows;
flat out vec4 v_row;
void main() {
    v_row = uintBitsToFloat(texelFetch(u_rows, 1));
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
"""
SHOW = "flat in vec4 v_row; out vec4 o_color; void main() { o_color = v_row; }"
ROWS = "layout(std430) writeonly buffer Rows { vec4 rows[]; };"


def test_a_vertex_shader_reads_what_a_pass_wrote(device: Device, sources: Sources) -> None:
    """Floats by their bits: those that are no normal numbers, too."""
    row = np.array([1.5, -2.25, 1e-40, 7.0], np.float32)
    values = ", ".join(f"uintBitsToFloat({bits}u)" for bits in row.view(np.uint32))
    fill = sources.compute(f"rows[1] = vec4({values});", ROWS, (1, 1, 1))
    graph = device.begin_frame()
    rows, color = graph.buffer("rows", 64), graph.texture("color", (2, 2), RGBA32F)
    graph.compute(fill, writes={"Rows": rows}, groups=1)
    graph.raster(sources.mesh(FLAT, SHOW), color=color, reads={"u_rows": rows})
    graph.keep(color)
    graph.execute()
    assert color.physical is not None
    got = color.physical.read()[0, 0]
    np.testing.assert_array_equal(got[[0, 1, 3]], row[[0, 1, 3]])


def test_what_does_not_fit_is_told(device: Device, sources: Sources) -> None:
    shader = sources.mesh(FLAT, SHOW)
    graph = device.begin_frame()
    color = graph.texture("color", (2, 2), RGBA32F)
    with pytest.raises(GraphError, match="u_rows: color is no buffer"):
        graph.raster(shader, color=graph.texture("c", (2, 2), RGBA32F), reads={"u_rows": color})
    image = sources.full_screen(
        "o_color = texture(u_image, v_uv);", "uniform sampler2D u_image; out vec4 o_color;"
    )
    rows = graph.buffer("rows", 64)
    with pytest.raises(GraphError, match="u_image needs a texture"):
        graph.raster(image, color=color, reads={"u_image": rows})
    device.program(shader).texel_limit = 3
    with pytest.raises(GraphError, match="buffer textures at most 48"):
        graph.raster(shader, color=color, reads={"u_rows": rows})


@pytest.mark.parametrize(
    "declaration",
    [
        "layout(std430) readonly buffer Rows { vec4 rows[]; };",
        "layout(rgba32f) readonly uniform image2D u_image;",
    ],
)
def test_what_drivers_may_lack_before_the_fragment_shader_is_refused(
    device: Device, sources: Sources, declaration: str
) -> None:
    vertex = declaration + "void main() { gl_Position = vec4(0.0); }"
    shader = sources.mesh(vertex, "out vec4 o_color; void main() { o_color = vec4(1.0); }")
    with pytest.raises(ShaderError, match=r"(Rows|u_image): not every driver has storage blocks"):
        device.program(shader)


@pytest.mark.parametrize(
    ("struct", "members"),
    [
        ("Instance", {"NORMAL": "normal_from_local", "WORDS": "material",
                      "PREV": "prev_world_from_local"}),
        ("Decal", {"WORLD": "world_from_decal"}),
    ],
)  # fmt: skip
def test_texels_are_counted_as_the_structs_are_laid_out(
    struct: str, members: dict[str, str]
) -> None:
    dtype = layouts().struct(struct)
    assert 16 * layouts().constant(f"{struct.upper()}_TEXELS") == dtype.itemsize
    for word, member in members.items():
        assert dtype.fields is not None
        texel = layouts().constant(f"{struct.upper()}_{word}_TEXEL")
        assert 16 * texel == dtype.fields[member][1]


@pytest.mark.parametrize(
    ("shader", "block", "member", "struct"),
    [(THRESHOLD, "EyeState", "eye", "Eye"), (GHOSTS, "Sprites", "counts", "SpriteCounts")],
)
def test_a_uniform_block_sees_a_storage_block_as_it_was_written(
    device: Device, shader: Raster, block: str, member: str, struct: str
) -> None:
    program, dtype = device.program(shader), layouts().struct(struct)
    assert program.slots[block].size == dtype.itemsize
    found = buffer_variables(device, program, uniform=True)
    laid = {name.rpartition(".")[2].removesuffix("[0]"): at for name, at in found.items()
            if name.startswith(f"{member}.")}  # fmt: skip
    assert laid
    for name, place in laid.items():
        assert dtype.fields is not None
        assert place["offset"] == dtype.fields[name][1]
        assert place["array_stride"] in (0, 16)
