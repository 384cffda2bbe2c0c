"""Compiled programs by description, and their reload when a file changes."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from elemental.gpu.program import Program, compile_program
from elemental.gpu.shaders import Shader, ShaderError, Snippet, SnippetText

if TYPE_CHECKING:
    from elemental.gpu.device import Device

_log = logging.getLogger(__name__)

Snippets = tuple[tuple[str, str], ...]


class ShaderLibrary:
    """Programs of a device. A failing edit keeps the last good program.

    Programs that share a snippet are taken over together or not at all, so that all passes see the
    same edit of it. One that never compiled for its snippet's sake runs the snippet's fallback.
    """

    def __init__(self, device: Device) -> None:
        self._device = device
        self._programs: dict[Shader, Program] = {}
        self._stamps: dict[Path, int] = {}
        self._failures: dict[Shader, str] = {}
        self._snippets: dict[str, Snippet] = {}
        self._texts: dict[str, SnippetText] = {}
        self.version = 0
        """Counts the programs that replaced others."""

    def add_snippet(self, key: str, snippet: Snippet) -> None:
        """Say what ``snippets={...: key}`` of a description stands for. The first one stays."""
        if key not in self._snippets:
            self._snippets[key] = snippet
            self._device.watch_folder(snippet.file.parent)

    def snippet(self, key: str) -> Snippet | None:
        """What is registered by a key."""
        return self._snippets.get(key)

    def get(self, shader: Shader) -> Program:
        """The program of ``shader``, compiled on first use.

        Raises ShaderError, but not for a snippet's fault: that is among the ``problems``.
        """
        program = self._programs.get(shader)
        if program is None:
            program = self._programs[shader] = self._first(shader)
            for file in program.files:
                self._stamps.setdefault(file, _stamp(file))
        return program

    def _first(self, shader: Shader) -> Program:
        if not shader.snippets:
            return compile_program(self._device, shader)
        loaded = True
        try:
            texts = self._texts_of(shader.snippets)
        except ShaderError as error:
            loaded, problem = False, str(error)
        else:
            try:
                return compile_program(self._device, shader, texts)
            except ShaderError as error:
                problem = str(error)
        fallbacks = {n: self._snippets[key].fallback(not loaded) for n, key in shader.snippets}
        program = compile_program(self._device, shader, fallbacks)
        self._failures[shader] = problem
        return program

    def _texts_of(self, snippets: Snippets) -> dict[str, SnippetText]:
        """The texts in use, loaded where they are new."""
        for _, key in snippets:
            if key not in self._texts:
                self._texts[key] = self._load(key)
                self._snippets[key].settle(True)
        return {name: self._texts[key] for name, key in snippets}

    def _load(self, key: str) -> SnippetText:
        snippet = self._snippets[key]
        self._stamps.setdefault(snippet.file, _stamp(snippet.file))
        return snippet.load()

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
        stale: dict[Snippets, list[Shader]] = {}
        for shader, old in self._programs.items():
            touched = not changed.isdisjoint(self._files_of(shader, old))
            if shader in self._failures or touched:
                stale.setdefault(shader.snippets, []).append(shader)
        errors = []
        for snippets, shaders in stale.items():
            if snippets:
                errors += self._replace_together(snippets, shaders)
            else:
                for shader in shaders:
                    errors += self._replace([shader], {})
        return errors

    def _files_of(self, shader: Shader, program: Program) -> set[Path]:
        return {*program.files, *(self._snippets[key].file for _, key in shader.snippets)}

    def _replace_together(self, snippets: Snippets, shaders: list[Shader]) -> list[str]:
        """Take over new texts of snippets, with every program that uses them."""
        everyone = [shader for shader in self._programs if shader.snippets == snippets]
        texts: dict[str, SnippetText] = {}
        loaded = []
        try:
            for name, key in snippets:
                texts[name] = self._load(key)
                loaded.append(key)
        except ShaderError as error:
            for shader in everyone:
                self._failures[shader] = str(error)
            _log.error("%s", error)
            errors = [str(error)]
        else:
            errors = self._replace(everyone, texts)
        for key in loaded:
            self._snippets[key].settle(not errors)
        if not errors:
            self._texts |= {key: texts[name] for name, key in snippets}
        return errors

    def _replace(self, shaders: list[Shader], texts: Mapping[str, SnippetText]) -> list[str]:
        """Compile programs anew; only if all of them compile do they replace the old ones."""
        fresh: dict[Shader, Program] = {}
        errors: dict[str, None] = {}
        for shader in shaders:
            try:
                fresh[shader] = compile_program(self._device, shader, texts)
            except ShaderError as error:
                self._failures[shader] = str(error)
                errors[str(error)] = None
                _log.error("%s keeps its last good program:\n%s", shader.name, error)
                break
        if errors:
            for program in fresh.values():
                program.release()
            return list(errors)
        for shader, program in fresh.items():
            self._failures.pop(shader, None)
            self._programs[shader].release()
            self._programs[shader] = program
            self.version += 1
            self._device.executor.recall.clear()  # what is known of the old program's slots
            for file in program.files:
                self._stamps.setdefault(file, _stamp(file))
            _log.info("reloaded %s", shader.name)
        return []

    def problems(self) -> list[str]:
        """The compilers' messages for the shaders that still run an older program."""
        return list(dict.fromkeys(self._failures.values()))

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
