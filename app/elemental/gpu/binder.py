"""Texture units, image units and blocks of the context: what is bound, and binding the rest."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

from elemental.gpu import gl as c
from elemental.gpu.binding import BlockLook, ImageLook, Look, SamplerLook, TexelsLook
from elemental.gpu.refs import SamplerKey, sampler_parameters
from elemental.gpu.resources import Texture


class Binder:
    """Remembers what is bound during a frame, so that nothing is bound twice; owns samplers."""

    def __init__(self, gl: c.GL, max_anisotropy: float) -> None:
        self.gl = gl
        self._max_anisotropy = max_anisotropy
        self._samplers: dict[SamplerKey, int] = {}
        self._units: dict[int, int] = {}
        self._unit_samplers: dict[int, int] = {}
        self._images: dict[int, tuple[int, ...]] = {}
        self._blocks: dict[tuple[int, int], int] = {}
        self._active_unit = -1

    def forget(self) -> None:
        """Assume nothing about the context: other code may have bound things."""
        self._units.clear()
        self._unit_samplers.clear()
        self._images.clear()
        self._blocks.clear()
        self._active_unit = -1

    def bind(self, bindings: Sequence[tuple[Look, int]], physical: Sequence[Any]) -> None:
        """Bind textures, images and blocks, skipping what is bound already."""
        gl = self.gl
        for look, resource in bindings:
            if look.__class__ is SamplerLook:
                self._bind_sampler(look, physical[resource])
            elif look.__class__ is BlockLook:
                glo = physical[resource].glo
                place = (look.target, look.unit)
                if self._blocks.get(place) != glo:
                    self._blocks[place] = glo
                    gl.glBindBufferBase(look.target, look.unit, glo)
            elif look.__class__ is TexelsLook:
                self._bind_texture(look.unit, c.TEXTURE_BUFFER, physical[resource].as_texels())
            elif look.__class__ is ImageLook:
                self._bind_image(look, physical[resource])

    def _bind_sampler(self, look: SamplerLook, texture: Texture) -> None:
        unit = look.unit
        glo = texture.glo if look.view is None else texture.view(*look.view)
        self._bind_texture(unit, look.target, glo)
        sampler = self._samplers.get(look.sampler) or self._make_sampler(look.sampler)
        if self._unit_samplers.get(unit) != sampler:
            self._unit_samplers[unit] = sampler
            self.gl.glBindSampler(unit, sampler)

    def _bind_texture(self, unit: int, target: int, glo: int) -> None:
        if self._units.get(unit) != glo:
            self._units[unit] = glo
            if self._active_unit != unit:
                self._active_unit = unit
                self.gl.glActiveTexture(c.TEXTURE0 + unit)
            self.gl.glBindTexture(target, glo)

    def _bind_image(self, look: ImageLook, texture: Texture) -> None:
        glo = texture.glo if look.view is None else texture.view(*look.view)
        wanted = (glo, look.level, look.layered, look.layer, look.access, look.format)
        if self._images.get(look.unit) != wanted:
            self._images[look.unit] = wanted
            self.gl.glBindImageTexture(look.unit, *wanted)

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

    def bind_params(self, unit: int, glo: int, offset: int, size: int) -> None:
        """Bind a range of the parameter ring to a uniform block."""
        self._blocks.pop((c.UNIFORM_BUFFER, unit), None)
        self.gl.glBindBufferRange(c.UNIFORM_BUFFER, unit, glo, offset, size)

    def release(self) -> None:
        """Free the samplers."""
        for sampler in self._samplers.values():
            self.gl.delete("Samplers", sampler)
        self._samplers.clear()
