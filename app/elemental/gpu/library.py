"""Compiled programs by description, and their reload when a file changes."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from elemental.gpu.program import Program, compile_program
from elemental.gpu.shaders import Shader, ShaderError

if TYPE_CHECKING:
    from elemental.gpu.device import Device

_log = logging.getLogger(__name__)


class ShaderLibrary:
    """Programs of a device. A failing edit keeps the last good program."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._programs: dict[Shader, Program] = {}
        self._stamps: dict[Path, int] = {}
        self._failures: dict[Shader, str] = {}

    def get(self, shader: Shader) -> Program:
        """The program of ``shader``, compiled on first use. Raises ShaderError."""
        program = self._programs.get(shader)
        if program is None:
            program = self._programs[shader] = compile_program(self._device, shader)
            for file in program.files:
                self._stamps.setdefault(file, _stamp(file))
        return program

    def files(self) -> set[Path]:
        """Every file that a compiled program came from."""
        return set(self._stamps)

    def reload_changed(self) -> list[str]:
        """Recompile the programs whose files changed; returns what went wrong, one text each."""
        changed = set()
        for file, stamp in self._stamps.items():
            now = _stamp(file)
            if now != stamp:
                self._stamps[file] = now
                changed.add(file)
        if not changed:
            return []
        errors = []
        for shader, old in list(self._programs.items()):
            if shader not in self._failures and changed.isdisjoint(old.files):
                continue
            try:
                new = compile_program(self._device, shader)
            except ShaderError as error:
                self._failures[shader] = str(error)
                errors.append(str(error))
                _log.error("%s keeps its last good program:\n%s", shader.name, error)
                continue
            self._failures.pop(shader, None)
            self._programs[shader] = new
            old.release()
            for file in new.files:
                self._stamps.setdefault(file, _stamp(file))
            _log.info("reloaded %s", shader.name)
        return errors

    def problems(self) -> list[str]:
        """The compilers' messages for the shaders that still run an older program."""
        return list(self._failures.values())

    def forget_vertex_input(self, serial: int) -> None:
        """Free the vertex arrays made for a vertex input."""
        for program in self._programs.values():
            vertex_array = program.vertex_arrays.pop(serial, None)
            if vertex_array is not None:
                vertex_array.release()

    def release(self) -> None:
        """Free every program."""
        for program in self._programs.values():
            program.release()
        self._programs.clear()


def _stamp(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return 0
