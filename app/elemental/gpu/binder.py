"""Texture units, image units and blocks of the context: what is bound, and binding the rest."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from elemental.gpu import gl as c
from elemental.gpu.binding import BlockLook, ImageLook, Look, SamplerLook
from elemental.gpu.refs import SamplerKey, sampler_parameters

if TYPE_CHECKING:
    from elemental.gpu.passes import Placed

Binding = tuple[int, Callable[..., None], tuple[Any, ...]]
"""(place, how to bind, with what): nothing is to be done where the place has the same already."""

_UNITS = 256
"""Room for each kind of unit: more than a program can use."""
_PLACES = 5 * _UNITS
_TEXTURES, _SAMPLERS, _IMAGES, _STORAGE, _UNIFORM = range(0, _PLACES, _UNITS)
"""First places of texture units, their samplers, image units and block bindings."""
_BLOCKS = {c.SHADER_STORAGE_BUFFER: _STORAGE, c.UNIFORM_BUFFER: _UNIFORM}


class Binder:
    """Remembers what is bound during a frame, so that nothing is bound twice; owns samplers."""

    def __init__(self, gl: c.GL, max_anisotropy: float) -> None:
        self.gl = gl
        self._max_anisotropy = max_anisotropy
        self._samplers: dict[SamplerKey, int] = {}
        self._held: list[tuple[Any, ...] | None] = [None] * _PLACES
        self._active_unit = -1

    def forget(self) -> None:
        """Assume nothing about the context: other code may have bound things."""
        self._held = [None] * _PLACES
        self._active_unit = -1

    def prepare(self, looks: Sequence[tuple[Look, Any]]) -> list[Binding]:
        """What ``bind`` takes, for physical resources as they are looked at."""
        bindings: list[Binding] = []
        for look, resource in looks:
            unit = look.unit
            if isinstance(look, SamplerLook):
                glo = resource.glo if look.view is None else resource.view(*look.view)
                sampler = self._samplers.get(look.sampler) or self._make_sampler(look.sampler)
                bindings.append((_TEXTURES + unit, self._texture, (unit, look.target, glo)))
                bindings.append((_SAMPLERS + unit, self._sampler, (unit, sampler)))
            elif isinstance(look, ImageLook):
                glo = resource.glo if look.view is None else resource.view(*look.view)
                part = (unit, glo, look.level, look.layered, look.layer, look.access, look.format)
                bindings.append((_IMAGES + unit, self._image, part))
            elif isinstance(look, BlockLook):
                place = _BLOCKS[look.target] + unit
                bindings.append((place, self._block, (look.target, unit, resource.glo)))
            else:
                texels = (unit, c.TEXTURE_BUFFER, resource.as_texels())
                bindings.append((_TEXTURES + unit, self._texture, texels))
        return bindings

    def bind(self, bindings: Sequence[Binding]) -> None:
        """Bind what is not bound already."""
        held = self._held
        for place, bind, arguments in bindings:
            if held[place] != arguments:
                held[place] = arguments
                bind(*arguments)

    def bind_params(self, params: Sequence[Placed], glo: int, base: int) -> None:
        """Bind uniform blocks that lie in buffer ``glo`` from byte ``base`` on."""
        held = self._held
        for unit, offset, size in params:
            place, arguments = _UNIFORM + unit, (c.UNIFORM_BUFFER, unit, glo, base + offset, size)
            if held[place] != arguments:
                held[place] = arguments
                self.gl.glBindBufferRange(*arguments)

    def _texture(self, unit: int, target: int, glo: int) -> None:
        if self._active_unit != unit:
            self._active_unit = unit
            self.gl.glActiveTexture(c.TEXTURE0 + unit)
        self.gl.glBindTexture(target, glo)

    def _sampler(self, unit: int, glo: int) -> None:
        self.gl.glBindSampler(unit, glo)

    def _image(self, *arguments: int) -> None:
        self.gl.glBindImageTexture(*arguments)

    def _block(self, target: int, unit: int, glo: int) -> None:
        self.gl.glBindBufferBase(target, unit, glo)

    def texture_unit_changed(self) -> None:
        """The active texture unit was changed by an upload or an allocation."""
        self._active_unit = -1

    def _make_sampler(self, key: SamplerKey) -> int:
        gl = self.gl
        (minify, magnify), (wrap_u, wrap_v) = sampler_parameters(key)
        _, _, compare, border, anisotropy = key
        glo = self._samplers[key] = gl.generate("Samplers")
        gl.glSamplerParameteri(glo, c.TEXTURE_MIN_FILTER, minify)
        gl.glSamplerParameteri(glo, c.TEXTURE_MAG_FILTER, magnify)
        gl.glSamplerParameteri(glo, c.TEXTURE_WRAP_S, wrap_u)
        gl.glSamplerParameteri(glo, c.TEXTURE_WRAP_T, wrap_v)
        gl.glSamplerParameteri(glo, c.TEXTURE_WRAP_R, wrap_v)
        gl.glSamplerParameterfv(glo, c.TEXTURE_BORDER_COLOR, (ctypes.c_float * 4)(*[border] * 4))
        if compare:
            gl.glSamplerParameteri(glo, c.TEXTURE_COMPARE_MODE, c.COMPARE_REF_TO_TEXTURE)
            gl.glSamplerParameteri(glo, c.TEXTURE_COMPARE_FUNC, c.LEQUAL)
        limit = min(anisotropy, self._max_anisotropy)
        if limit > 1:
            gl.glSamplerParameterf(glo, c.TEXTURE_MAX_ANISOTROPY, limit)
        return glo

    def release(self) -> None:
        """Free the samplers."""
        for sampler in self._samplers.values():
            self.gl.delete("Samplers", sampler)
        self._samplers.clear()
