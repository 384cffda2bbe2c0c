"""Contexts without a window (EGL, OSMesa) and the adoption of a window's context."""

from __future__ import annotations

import ctypes
import ctypes.util
from collections.abc import Callable
from typing import Any

import glcontext  # type: ignore[import-untyped]
import moderngl

from elemental.gpu import gl as c

GL_VERSION = 430
_OSMESA_ATTRIBUTES = (
    0x22, 0x1908,  # OSMESA_FORMAT: RGBA
    0x30, 24,  # OSMESA_DEPTH_BITS
    0x33, 0x34,  # OSMESA_PROFILE: OSMESA_CORE_PROFILE
    0x36, 4, 0x37, 3,  # OSMESA_CONTEXT_MAJOR_VERSION, MINOR
    0,
)  # fmt: skip


def create() -> tuple[moderngl.Context, c.Loader]:
    """(context, loader) by EGL, else by OSMesa. Raises RuntimeError with both reasons."""
    reasons = []
    for name, make in (("EGL", _egl), ("OSMesa", OsMesaContext)):
        try:
            loader = make()
            return _wrap(loader), loader
        except Exception as error:
            reasons.append(f"{name}: {' '.join(str(error).split())}")
    raise RuntimeError("no OpenGL 4.3 context without a window; " + "; ".join(reasons))


def adopt(loader: Callable[[str], Any] | c.Loader) -> tuple[moderngl.Context, c.Loader]:
    """(context, loader) of the context that is current, as a window's is."""
    wrapped: Any = loader
    if not hasattr(loader, "load_opengl_function"):
        wrapped = _CallableLoader(wrapped)
    return _wrap(wrapped), wrapped


def _wrap(loader: Any) -> moderngl.Context:
    """moderngl's stubs know ``context`` as settings of a context, not as the context."""
    return moderngl.create_context(require=GL_VERSION, context=loader)


def _egl() -> Any:
    return glcontext.get_backend_by_name("egl")(glversion=GL_VERSION, mode="standalone")


class _CallableLoader:
    """glfw.get_proc_address and the like as a loader."""

    def __init__(self, get_address: Callable[[str], Any]) -> None:
        self._get_address = get_address

    def load_opengl_function(self, name: str) -> int:
        """Address of ``name``, 0 where there is none."""
        address = self._get_address(name)
        if isinstance(address, ctypes.c_void_p):
            address = address.value
        return int(address or 0)

    load = load_opengl_function

    def release(self) -> None:
        """The window owns its context."""


class OsMesaContext:
    """An off-screen software context, where EGL is missing."""

    def __init__(self) -> None:
        library = ctypes.util.find_library("OSMesa")
        if library is None:
            raise RuntimeError("libOSMesa is not installed")
        self._mesa = ctypes.CDLL(library)
        self._mesa.OSMesaCreateContextAttribs.restype = ctypes.c_void_p
        self._mesa.OSMesaGetProcAddress.restype = ctypes.c_void_p
        attributes = (ctypes.c_int * len(_OSMESA_ATTRIBUTES))(*_OSMESA_ATTRIBUTES)
        self._context = self._mesa.OSMesaCreateContextAttribs(attributes, None)
        if not self._context:
            raise RuntimeError("OSMesa has no OpenGL 4.3 core")
        self._pixels = (ctypes.c_ubyte * 64)()
        made = self._mesa.OSMesaMakeCurrent(
            ctypes.c_void_p(self._context), self._pixels, 0x1401, 4, 4
        )
        if not made:
            raise RuntimeError("OSMesa can't make its context current")

    def load_opengl_function(self, name: str) -> int:
        """Address of ``name``, 0 where there is none."""
        return int(self._mesa.OSMesaGetProcAddress(name.encode()) or 0)

    load = load_opengl_function

    def release(self) -> None:
        """Destroy the context."""
        if self._context:
            self._mesa.OSMesaDestroyContext(ctypes.c_void_p(self._context))
            self._context = None
