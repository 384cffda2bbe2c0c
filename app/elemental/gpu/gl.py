"""Raw OpenGL entry points, for what moderngl does not reach. Nothing else touches raw GL.

The functions are built by ctypes from the loader that made the context (glcontext's object, or any
object with ``load_opengl_function(name) -> address``), so no second GL library is opened.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from ctypes import c_char_p, c_float, c_int, c_int64, c_ssize_t, c_ubyte, c_uint, c_uint64, c_void_p
from typing import Any, Protocol

# Texture targets.
TEXTURE_2D = 0x0DE1
TEXTURE_3D = 0x806F
TEXTURE_2D_ARRAY = 0x8C1A
TEXTURE_CUBE_MAP = 0x8513
TEXTURE_CUBE_MAP_ARRAY = 0x9009
TEXTURE_BUFFER = 0x8C2A
TEXTURE_CUBE_MAP_POSITIVE_X = 0x8515
TEXTURE0 = 0x84C0

# Texture and sampler parameters.
TEXTURE_MAG_FILTER = 0x2800
TEXTURE_MIN_FILTER = 0x2801
TEXTURE_WRAP_S = 0x2802
TEXTURE_WRAP_T = 0x2803
TEXTURE_WRAP_R = 0x8072
TEXTURE_BORDER_COLOR = 0x1004
TEXTURE_COMPARE_MODE = 0x884C
TEXTURE_COMPARE_FUNC = 0x884D
TEXTURE_MAX_ANISOTROPY = 0x84FE
TEXTURE_CUBE_MAP_SEAMLESS = 0x884F
DEPTH_STENCIL_TEXTURE_MODE = 0x90EA
NEAREST = 0x2600
LINEAR = 0x2601
NEAREST_MIPMAP_NEAREST = 0x2700
LINEAR_MIPMAP_LINEAR = 0x2703
REPEAT = 0x2901
CLAMP_TO_EDGE = 0x812F
CLAMP_TO_BORDER = 0x812D
MIRRORED_REPEAT = 0x8370
COMPARE_REF_TO_TEXTURE = 0x884E

# Pixel transfer.
UNPACK_ALIGNMENT = 0x0CF5
PACK_ALIGNMENT = 0x0D05
STENCIL_INDEX = 0x1901
DEPTH_COMPONENT = 0x1902
DEPTH_STENCIL = 0x84F9

# Framebuffers.
FRAMEBUFFER = 0x8D40
READ_FRAMEBUFFER = 0x8CA8
DRAW_FRAMEBUFFER = 0x8CA9
COLOR_ATTACHMENT0 = 0x8CE0
DEPTH_ATTACHMENT = 0x8D00
DEPTH_STENCIL_ATTACHMENT = 0x821A
FRAMEBUFFER_COMPLETE = 0x8CD5
FRAMEBUFFER_DEFAULT_WIDTH = 0x9310
FRAMEBUFFER_DEFAULT_HEIGHT = 0x9311
COLOR = 0x1800
DEPTH = 0x1801
STENCIL = 0x1802
COLOR_BUFFER_BIT = 0x4000

# Buffers.
COPY_READ_BUFFER = 0x8F36
COPY_WRITE_BUFFER = 0x8F37
UNIFORM_BUFFER = 0x8A11
SHADER_STORAGE_BUFFER = 0x90D2
PIXEL_PACK_BUFFER = 0x88EB
PIXEL_UNPACK_BUFFER = 0x88EC
R32UI = 0x8236
RGBA32UI = 0x8D70
RED_INTEGER = 0x8D94
RGBA_INTEGER = 0x8D99
UNSIGNED_INT = 0x1405

# State.
CULL_FACE = 0x0B44
DEPTH_CLAMP = 0x864F
DEPTH_TEST = 0x0B71
STENCIL_TEST = 0x0B90
SCISSOR_TEST = 0x0C11
BLEND = 0x0BE2
DITHER = 0x0BD0
POLYGON_OFFSET_FILL = 0x8037
FRONT = 0x0404
BACK = 0x0405
FRONT_AND_BACK = 0x0408
ZERO = 0
ONE = 1
SRC_ALPHA = 0x0302
ONE_MINUS_SRC_ALPHA = 0x0303
NEVER = 0x0200
LESS = 0x0201
EQUAL = 0x0202
LEQUAL = 0x0203
GREATER = 0x0204
NOTEQUAL = 0x0205
GEQUAL = 0x0206
ALWAYS = 0x0207
KEEP = 0x1E00
REPLACE = 0x1E01
INCR = 0x1E02
DECR = 0x1E03
INVERT = 0x150A

# Image access.
READ_ONLY = 0x88B8
WRITE_ONLY = 0x88B9
READ_WRITE = 0x88BA

# Barrier bits (glMemoryBarrier).
VERTEX_ATTRIB_ARRAY_BARRIER = 0x0001
ELEMENT_ARRAY_BARRIER = 0x0002
UNIFORM_BARRIER = 0x0004
TEXTURE_FETCH_BARRIER = 0x0008
SHADER_IMAGE_ACCESS_BARRIER = 0x0020
COMMAND_BARRIER = 0x0040
PIXEL_BUFFER_BARRIER = 0x0080
TEXTURE_UPDATE_BARRIER = 0x0100
BUFFER_UPDATE_BARRIER = 0x0200
FRAMEBUFFER_BARRIER = 0x0400
SHADER_STORAGE_BARRIER = 0x2000
ALL_BARRIERS = 0xFFFFFFFF

# Queries, sync, limits, errors.
TIMESTAMP = 0x8E28
QUERY_RESULT = 0x8866
QUERY_RESULT_AVAILABLE = 0x8867
SYNC_GPU_COMMANDS_COMPLETE = 0x9117
ALREADY_SIGNALED = 0x911A
CONDITION_SATISFIED = 0x911C
OUT_OF_MEMORY = 0x0505
UNIFORM_BUFFER_OFFSET_ALIGNMENT = 0x8A34
MAX_TEXTURE_SIZE = 0x0D33
MAX_SHADER_STORAGE_BLOCK_SIZE = 0x90DE
MAX_TEXTURE_BUFFER_SIZE = 0x8C2B
MAX_COMBINED_SHADER_OUTPUT_RESOURCES = 0x8F39
MAX_COMBINED_TEXTURE_IMAGE_UNITS = 0x8B4D
COMPUTE_WORK_GROUP_SIZE = 0x8267
MAX_WORK_GROUPS = 65535
"""Groups a dimension that GL 4.3 guarantees; used on every driver, so that all behave alike."""

# Debug output.
DEBUG_OUTPUT = 0x92E0
DEBUG_OUTPUT_SYNCHRONOUS = 0x8242
DEBUG_SOURCE_SHADER_COMPILER = 0x8248
DEBUG_SOURCE_APPLICATION = 0x824A
DEBUG_TYPE_ERROR = 0x824C
DEBUG_TYPE_PERFORMANCE = 0x8250
DEBUG_TYPE_PUSH_GROUP = 0x8269
DEBUG_TYPE_POP_GROUP = 0x826A
DEBUG_SEVERITY_HIGH = 0x9146
DEBUG_SEVERITY_MEDIUM = 0x9147
DEBUG_SEVERITY_LOW = 0x9148
DEBUG_SEVERITY_NOTIFICATION = 0x826B
DONT_CARE = 0x1100
# Object kinds of glObjectLabel.
LABEL_BUFFER = 0x82E0
LABEL_PROGRAM = 0x82E2
LABEL_SAMPLER = 0x82E6
LABEL_TEXTURE = 0x1702
LABEL_FRAMEBUFFER = 0x8D40

# Program interfaces and properties.
UNIFORM = 0x92E1
UNIFORM_BLOCK = 0x92E2
BUFFER_VARIABLE = 0x92E5
PROGRAM_INPUT = 0x92E3
PROGRAM_OUTPUT = 0x92E4
SHADER_STORAGE_BLOCK = 0x92E6
ACTIVE_RESOURCES = 0x92F5
MAX_NAME_LENGTH = 0x92F6
PROP_TYPE = 0x92FA
PROP_ARRAY_SIZE = 0x92FB
PROP_OFFSET = 0x92FC
PROP_BLOCK_INDEX = 0x92FD
PROP_ARRAY_STRIDE = 0x92FE
PROP_MATRIX_STRIDE = 0x92FF
PROP_BUFFER_DATA_SIZE = 0x9303
PROP_TOP_LEVEL_ARRAY_STRIDE = 0x930D
PROP_LOCATION = 0x930E

_U, _I, _F, _P, _Z, _S = c_uint, c_int, c_float, c_void_p, c_ssize_t, c_char_p
DEBUG_CALLBACK = ctypes.CFUNCTYPE(None, _U, _U, _U, _U, _I, _P, _P)

_FUNCTIONS: dict[str, tuple[Any, ...]] = {
    # name: (result, arguments…)
    "glGetError": (_U,),
    "glGetIntegerv": (None, _U, _P),
    "glGetInteger64v": (None, _U, _P),
    "glFinish": (None,),
    "glFlush": (None,),
    "glEnable": (None, _U),
    "glDisable": (None, _U),
    "glPixelStorei": (None, _U, _I),
    "glGenTextures": (None, _I, _P),
    "glDeleteTextures": (None, _I, _P),
    "glActiveTexture": (None, _U),
    "glBindTexture": (None, _U, _U),
    "glTexParameteri": (None, _U, _U, _I),
    "glTexBuffer": (None, _U, _U, _U),
    "glTexStorage2D": (None, _U, _I, _U, _I, _I),
    "glTexStorage3D": (None, _U, _I, _U, _I, _I, _I),
    "glTexSubImage2D": (None, _U, _I, _I, _I, _I, _I, _U, _U, _P),
    "glTexSubImage3D": (None, _U, _I, _I, _I, _I, _I, _I, _I, _U, _U, _P),
    "glGetTexImage": (None, _U, _I, _U, _U, _P),
    "glTextureView": (None, _U, _U, _U, _U, _U, _U, _U, _U),
    "glGenerateMipmap": (None, _U),
    "glCopyImageSubData": (None, _U, _U, *(_I,) * 4, _U, _U, *(_I,) * 7),
    "glBindImageTexture": (None, _U, _U, _I, c_ubyte, _I, _U, _U),
    "glGenSamplers": (None, _I, _P),
    "glDeleteSamplers": (None, _I, _P),
    "glBindSampler": (None, _U, _U),
    "glSamplerParameteri": (None, _U, _U, _I),
    "glSamplerParameterf": (None, _U, _U, _F),
    "glSamplerParameterfv": (None, _U, _U, _P),
    "glGenFramebuffers": (None, _I, _P),
    "glDeleteFramebuffers": (None, _I, _P),
    "glBindFramebuffer": (None, _U, _U),
    "glFramebufferTexture": (None, _U, _U, _U, _I),
    "glFramebufferTexture2D": (None, _U, _U, _U, _U, _I),
    "glFramebufferTextureLayer": (None, _U, _U, _U, _I, _I),
    "glFramebufferParameteri": (None, _U, _U, _I),
    "glCheckFramebufferStatus": (_U, _U),
    "glDrawBuffers": (None, _I, _P),
    "glBlitFramebuffer": (None, *(_I,) * 8, _U, _U),
    "glClearBufferfv": (None, _U, _I, _P),
    "glClearBufferuiv": (None, _U, _I, _P),
    "glClearBufferiv": (None, _U, _I, _P),
    "glClearBufferfi": (None, _U, _I, _F, _I),
    "glScissor": (None, _I, _I, _I, _I),
    "glViewport": (None, _I, _I, _I, _I),
    "glCullFace": (None, _U),
    "glDepthFunc": (None, _U),
    "glDepthMask": (None, c_ubyte),
    "glColorMask": (None, c_ubyte, c_ubyte, c_ubyte, c_ubyte),
    "glColorMaski": (None, _U, c_ubyte, c_ubyte, c_ubyte, c_ubyte),
    "glBlendFuncSeparate": (None, _U, _U, _U, _U),
    "glBlendFuncSeparatei": (None, _U, _U, _U, _U, _U),  # GL 4.0
    "glEnablei": (None, _U, _U),
    "glDisablei": (None, _U, _U),
    "glPolygonOffset": (None, _F, _F),
    "glStencilFunc": (None, _U, _I, _U),
    "glStencilOp": (None, _U, _U, _U),
    "glStencilMask": (None, _U),
    "glBindBuffer": (None, _U, _U),
    "glBindBufferBase": (None, _U, _U, _U),
    "glBindBufferRange": (None, _U, _U, _U, _Z, _Z),
    "glClearBufferSubData": (None, _U, _U, _Z, _Z, _U, _U, _P),
    "glCopyBufferSubData": (None, _U, _U, _Z, _Z, _Z),
    "glMemoryBarrier": (None, _U),
    "glUseProgram": (None, _U),
    "glBindVertexArray": (None, _U),
    "glDispatchCompute": (None, _U, _U, _U),
    "glProgramUniform1i": (None, _U, _I, _I),
    "glUniformBlockBinding": (None, _U, _U, _U),
    "glShaderStorageBlockBinding": (None, _U, _U, _U),
    "glGetProgramiv": (None, _U, _U, _P),
    "glGetProgramInterfaceiv": (None, _U, _U, _U, _P),
    "glGetProgramResourceiv": (None, _U, _U, _U, _I, _P, _I, _P, _P),
    "glGetProgramResourceName": (None, _U, _U, _U, _I, _P, _P),
    "glGenQueries": (None, _I, _P),
    "glDeleteQueries": (None, _I, _P),
    "glQueryCounter": (None, _U, _U),
    "glGetQueryObjectiv": (None, _U, _U, _P),
    "glGetQueryObjectui64v": (None, _U, _U, _P),
    "glFenceSync": (_P, _U, _U),
    "glClientWaitSync": (_U, _P, _U, c_uint64),
    "glDeleteSync": (None, _P),
    "glPushDebugGroup": (None, _U, _U, _I, _S),
    "glPopDebugGroup": (None,),
    "glObjectLabel": (None, _U, _U, _I, _S),
    "glDebugMessageCallback": (None, DEBUG_CALLBACK, _P),
    "glDebugMessageControl": (None, _U, _U, _U, _I, _P, c_ubyte),
    "glDebugMessageInsert": (None, _U, _U, _U, _U, _I, _S),
}
_OPTIONAL: dict[str, tuple[Any, ...]] = {
    "glClearTexImage": (None, _U, _I, _U, _U, _P),  # GL 4.4
}


class Loader(Protocol):
    """What makes GL addresses: glcontext's context objects are such loaders."""

    def load_opengl_function(self, name: str) -> int:
        """Address of the GL function ``name``; 0 where there is none."""
        ...


class GL:
    """The raw functions as attributes (``gl.glBindTexture(...)``), plus one-value helpers."""

    def __init__(self, loader: Loader, version_code: int) -> None:
        for name, signature in _FUNCTIONS.items():
            setattr(self, name, _bind(loader, name, signature))
        self.has_clear_tex_image = version_code >= 440
        if self.has_clear_tex_image:
            for name, signature in _OPTIONAL.items():
                setattr(self, name, _bind(loader, name, signature))

    def __getattr__(self, name: str) -> Callable[..., Any]:
        raise AttributeError(f"{name} is not in the table of gpu/gl.py")

    def generate(self, kind: str) -> int:
        """One new object name; ``kind`` in Textures, Framebuffers, Samplers, Queries."""
        name = c_uint()
        getattr(self, f"glGen{kind}")(1, ctypes.byref(name))
        return name.value

    def delete(self, kind: str, glo: int) -> None:
        """Delete one object that ``generate`` made."""
        getattr(self, f"glDelete{kind}")(1, ctypes.byref(c_uint(glo)))

    def integer(self, parameter: int) -> int:
        """glGetInteger64v of one value."""
        value = c_int64()
        self.glGetInteger64v(parameter, ctypes.byref(value))
        return value.value

    def label(self, kind: int, glo: int, text: str) -> None:
        """Name an object for debuggers and driver messages."""
        encoded = text.encode()[:200]
        self.glObjectLabel(kind, glo, len(encoded), encoded)


def _bind(loader: Loader, name: str, signature: tuple[Any, ...]) -> Callable[..., Any]:
    address = loader.load_opengl_function(name)
    if not address:
        raise RuntimeError(f"this OpenGL driver has no {name}; OpenGL 4.3 core is needed")
    return ctypes.CFUNCTYPE(*signature)(address)
