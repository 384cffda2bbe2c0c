"""A linked program and what the driver says about it, read once at link time."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import moderngl

from elemental.gpu import gl as c
from elemental.gpu.formats import IMAGE_QUALIFIERS
from elemental.gpu.shaders import (
    Compute,
    Declared,
    Raster,
    Shader,
    ShaderError,
    SnippetText,
    Source,
    declared_resources,
    flatten,
    rewrite_messages,
)

if TYPE_CHECKING:
    from elemental.gpu.device import Device

LINEAR_DISPATCH = "lib/dispatch.glsl"
"""Include that a shader needs to take more than 65,535 groups of a one-dimensional dispatch."""

_2D, _3D, _ARRAY = c.TEXTURE_2D, c.TEXTURE_3D, c.TEXTURE_2D_ARRAY
_CUBE, _CUBE_ARRAY = c.TEXTURE_CUBE_MAP, c.TEXTURE_CUBE_MAP_ARRAY
_TEXELS = c.TEXTURE_BUFFER
_SAMPLER_TARGETS = {
    0x8B5E: _2D, 0x8B5F: _3D, 0x8B60: _CUBE, 0x8B62: _2D, 0x8DC1: _ARRAY, 0x8DC4: _ARRAY,
    0x8DC5: _CUBE, 0x900C: _CUBE_ARRAY, 0x900D: _CUBE_ARRAY,
    0x8DCA: _2D, 0x8DCB: _3D, 0x8DCC: _CUBE, 0x8DCF: _ARRAY, 0x900E: _CUBE_ARRAY,
    0x8DC2: _TEXELS, 0x8DD0: _TEXELS, 0x8DD8: _TEXELS,
    0x8DD2: _2D, 0x8DD3: _3D, 0x8DD4: _CUBE, 0x8DD7: _ARRAY, 0x900F: _CUBE_ARRAY,
}  # fmt: skip
_SHADOW_SAMPLERS = {0x8B62, 0x8DC4, 0x8DC5, 0x900D}
_IMAGE_TARGETS = {
    0x904D: _2D, 0x904E: _3D, 0x9050: _CUBE, 0x9053: _ARRAY, 0x9054: _CUBE_ARRAY,
    0x9058: _2D, 0x9059: _3D, 0x905B: _CUBE, 0x905E: _ARRAY, 0x905F: _CUBE_ARRAY,
    0x9063: _2D, 0x9064: _3D, 0x9066: _CUBE, 0x9069: _ARRAY, 0x906A: _CUBE_ARRAY,
}  # fmt: skip

SAMPLER, IMAGE, UNIFORM_BLOCK, STORAGE_BLOCK = "sampler", "image", "uniform", "buffer"


@dataclass(slots=True, eq=False)
class Slot:
    """Where one GLSL name of a program is bound."""

    name: str
    kind: str
    """sampler, image, uniform (block) or buffer (block)."""
    unit: int = -1
    """First texture unit, image unit or block binding; -1 where the compiler dropped the name."""
    target: int = 0
    """GL texture target of a sampler or an image."""
    count: int = 1
    """Elements of a sampler or image array."""
    size: int = 0
    """Bytes of a uniform block."""
    image_format: int = 0
    """GL format by which an image is bound; 0: the texture's own."""
    access: int = c.READ_WRITE
    """How an image is accessed."""
    shadow: bool = False
    """True for a depth-compare sampler."""
    looks: dict[Any, Any] = field(default_factory=dict)
    """How references were found to be bound here; see gpu/binding.py."""

    @property
    def active(self) -> bool:
        """False where the compiler dropped the name."""
        return self.unit >= 0


@dataclass(eq=False)
class Program:
    """A linked program. Units and bindings are set once here; passes bind by name."""

    shader: Shader
    mgl: Any
    """The moderngl object (Program or ComputeShader)."""
    slots: dict[str, Slot]
    local_size: tuple[int, int, int]
    files: tuple[Path, ...]
    linear_dispatch: bool
    """Whether it includes lib/dispatch.glsl and so may fold a long dispatch."""
    storage_limit: int
    """Bytes of the largest storage block of the driver."""
    texel_limit: int
    """Texels of the driver's largest buffer texture."""
    plans: dict[Any, Any] = field(default_factory=dict)
    """Binding plans of the frame graph by the names given; cleared with the program."""
    vertex_arrays: dict[int, moderngl.VertexArray] = field(default_factory=dict)
    """Vertex arrays by VertexInput id."""

    @property
    def name(self) -> str:
        """Short name of the shader."""
        return self.shader.name

    def release(self) -> None:
        """Free the GL program and its vertex arrays."""
        for vertex_array in self.vertex_arrays.values():
            vertex_array.release()
        self.vertex_arrays.clear()
        self.plans.clear()
        self.mgl.release()


def compile_program(
    device: Device, shader: Shader, snippets: Mapping[str, SnippetText] | None = None
) -> Program:
    """Flatten, compile, link and reflect. Raises ShaderError with ``file:line`` messages.

    ``snippets``: by the names that the shader includes them by.
    """
    sources = {
        stage: flatten(path, shader.defines, device.shader_root, snippets)
        for stage, path in shader.stages
    }
    try:
        mgl = _link(device.ctx, shader, sources)
    except ShaderError as error:
        raise _blamed(error, snippets or {}) from None
    device.gl.label(c.LABEL_PROGRAM, mgl.glo, repr(shader))
    declared: dict[str, Declared] = {}
    try:
        for stage, source in sources.items():
            in_stage = declared_resources(source.text)
            _check_stage(stage, in_stage, shader)
            declared.update(in_stage)
        slots = _reflect(device, mgl.glo, declared, shader)
    except ShaderError:
        mgl.release()
        raise
    local_size = (1, 1, 1)
    if isinstance(shader, Compute):
        values = (ctypes.c_int * 3)()
        device.gl.glGetProgramiv(mgl.glo, c.COMPUTE_WORK_GROUP_SIZE, values)
        local_size = (values[0], values[1], values[2])
    files = tuple(dict.fromkeys(file for source in sources.values() for file in source.files))
    linear = any(file.as_posix().endswith(LINEAR_DISPATCH) for file in files)
    limits = (device.storage_limit, device.texel_limit)
    return Program(shader, mgl, slots, local_size, files, linear, *limits)


def _check_stage(stage: str, declared: Mapping[str, Declared], shader: Shader) -> None:
    """Refuse what drivers of GL 4.3 may lack before the fragment shader: their least numbers of
    storage blocks and images there are 0 [GL 4.3, tables 23.57 and 23.59]."""
    if stage in ("fragment", "compute"):
        return
    lacking = [name for name, item in declared.items() if item.kind in (STORAGE_BLOCK, IMAGE)]
    if lacking:
        names = ", ".join(sorted(lacking))
        raise ShaderError(
            f"{shader!r}: {names}: not every driver has storage blocks or images in a {stage} "
            "shader; a usamplerBuffer or a uniform block can take the same buffer"
        )


def _link(ctx: moderngl.Context, shader: Shader, sources: dict[str, Source]) -> Any:
    try:
        if isinstance(shader, Raster):
            geometry = sources.get("geometry")
            return ctx.program(
                vertex_shader=sources["vertex"].text,
                fragment_shader=sources["fragment"].text,
                geometry_shader=geometry.text if geometry else None,
            )
        return ctx.compute_shader(sources["compute"].text)
    except moderngl.Error as error:
        raise ShaderError(_located(str(error), sources, shader)) from None


def _blamed(error: ShaderError, snippets: Mapping[str, SnippetText]) -> ShaderError:
    """The error with the files of the snippets in front, unless it names one of them."""
    labels = [snippet.label for snippet in snippets.values()]
    if not labels or any(label in str(error) for label in labels):
        return error
    return ShaderError(f"{', '.join(labels)}: {error}")


_HEADINGS = {"Program", "GLSL Compiler failed", "GLSL Linker failed"}


def _located(log: str, sources: dict[str, Source], shader: Shader) -> str:
    """moderngl heads each log with ``vertex_shader`` and so on; link errors have no stage."""
    stage = next((name for name in sources if f"{name}_shader" in log.lower()), None)
    headings = _HEADINGS | {f"{name}_shader" for name in sources}
    body = "\n".join(
        line
        for line in log.splitlines()
        if line.strip() and line.strip().strip("=") and line.strip() not in headings
    )
    return f"{shader!r}: {body}" if stage is None else rewrite_messages(body, sources[stage])


def _reflect(
    device: Device, glo: int, declared: dict[str, Declared], shader: Shader
) -> dict[str, Slot]:
    slots = {name: _declared_slot(name, decl) for name, decl in declared.items()}
    units = {SAMPLER: 0, IMAGE: 0}
    wanted = (c.PROP_TYPE, c.PROP_ARRAY_SIZE, c.PROP_LOCATION, c.PROP_BLOCK_INDEX)
    for name, (kind, count, location, block) in resources(device, glo, c.UNIFORM, wanted):
        if block != -1:
            continue
        base = name.removesuffix("[0]")
        if kind not in _SAMPLER_TARGETS and kind not in _IMAGE_TARGETS:
            raise ShaderError(
                f"{shader!r}: uniform {base} stands alone; values belong in a uniform block"
            )
        slot = slots.setdefault(base, Slot(base, SAMPLER if kind in _SAMPLER_TARGETS else IMAGE))
        slot.target = _SAMPLER_TARGETS.get(kind) or _IMAGE_TARGETS[kind]
        slot.shadow = kind in _SHADOW_SAMPLERS
        slot.count = count
        slot.unit = units[slot.kind]
        units[slot.kind] += count
        for element in range(count):
            device.gl.glProgramUniform1i(glo, location + element, slot.unit + element)
    blocks = resources(device, glo, c.UNIFORM_BLOCK, (c.PROP_BUFFER_DATA_SIZE,))
    for index, (name, (size,)) in enumerate(blocks):
        slot = slots.setdefault(name, Slot(name, UNIFORM_BLOCK))
        slot.unit, slot.size = index, size
        device.gl.glUniformBlockBinding(glo, index, index)
    storage = resources(device, glo, c.SHADER_STORAGE_BLOCK, (c.PROP_BUFFER_DATA_SIZE,))
    for index, (name, _) in enumerate(storage):
        slot = slots.setdefault(name, Slot(name, STORAGE_BLOCK))
        slot.unit = index
        device.gl.glShaderStorageBlockBinding(glo, index, index)
    return slots


def _declared_slot(name: str, declared: Declared) -> Slot:
    slot = Slot(name, declared.kind)
    if declared.image_format:
        slot.image_format = IMAGE_QUALIFIERS[declared.image_format]
    access = {"readonly": c.READ_ONLY, "writeonly": c.WRITE_ONLY}
    slot.access = access.get(declared.access, c.READ_WRITE)
    return slot


def resources(
    device: Device, glo: int, interface: int, properties: Iterable[int]
) -> list[tuple[str, tuple[int, ...]]]:
    """(name, property values) of each active resource of a program interface."""
    gl = device.gl
    number = ctypes.c_int()
    gl.glGetProgramInterfaceiv(glo, interface, c.ACTIVE_RESOURCES, ctypes.byref(number))
    wanted = tuple(properties)
    query = (ctypes.c_uint * len(wanted))(*wanted)
    values = (ctypes.c_int * len(wanted))()
    name = ctypes.create_string_buffer(1024)
    found = []
    for index in range(number.value):
        gl.glGetProgramResourceName(glo, interface, index, 1024, None, name)
        gl.glGetProgramResourceiv(
            glo, interface, index, len(wanted), query, len(wanted), None, values
        )
        found.append((name.value.decode(), tuple(values)))
    return found


def buffer_variables(device: Device, program: Program, uniform: bool) -> dict[str, dict[str, int]]:
    """Layout of every block member as the driver has it, for the layout test.

    Keys are GLSL names such as ``Lights.lights[0].color``; values hold offset, array_stride,
    matrix_stride and top_level_array_stride in bytes (-1 or 0 where they do not apply).
    """
    keys = ["offset", "array_stride", "matrix_stride", "array_size"]
    properties = [c.PROP_OFFSET, c.PROP_ARRAY_STRIDE, c.PROP_MATRIX_STRIDE, c.PROP_ARRAY_SIZE]
    if not uniform:
        keys.append("top_level_array_stride")
        properties.append(c.PROP_TOP_LEVEL_ARRAY_STRIDE)
    interface = c.UNIFORM if uniform else c.BUFFER_VARIABLE
    rows = resources(device, program.mgl.glo, interface, properties)
    return {name: dict(zip(keys, values, strict=True)) for name, values in rows}
