"""What the draw callback of a raster pass draws with."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import moderngl

from elemental.gpu import gl as c
from elemental.gpu.binding import GraphError, looks, require_all
from elemental.gpu.program import Slot
from elemental.gpu.refs import AnyBuffer, AnyHandle, BufferHandle, Ref
from elemental.gpu.resources import VertexInput
from elemental.gpu.state import RasterState

if TYPE_CHECKING:
    from elemental.gpu.execute import Executor
    from elemental.gpu.passes import RasterPass
    from elemental.gpu.recall import Drawn

_MODES = {
    "points": moderngl.POINTS,
    "lines": moderngl.LINES,
    "line_strip": moderngl.LINE_STRIP,
    "triangles": moderngl.TRIANGLES,
    "triangle_strip": moderngl.TRIANGLE_STRIP,
}
_changed_states: dict[tuple[RasterState, tuple[tuple[str, Any], ...]], RasterState] = {}


class Encoder:
    """Draws of one raster pass. Program, targets and declared names are bound already."""

    __slots__ = ("_executor", "_missing", "_node", "_seen")

    def __init__(self, executor: Executor, node: RasterPass) -> None:
        self._executor, self._node = executor, node
        self._missing = set(node.uses.missing)
        self._seen: set[int] = set()
        """Serial numbers of the commands and vertex inputs whose barriers were issued."""

    def bind(self, name: str, ref: Ref) -> None:
        """Bind a texture or buffer that changes between draws. Raises GraphError.

        A name that the program does not use is ignored if the source declares it.
        """
        program = self._node.uses.program
        slot = program.slots.get(name)
        if slot is None:
            raise GraphError(f"{program.shader!r}: no {name}")
        self._missing.discard(name)
        if not slot.active:
            return
        known = self._executor.recall.draws.get((slot, ref))
        if known is None:
            known = self._looked_up(slot, ref)
        accesses, bindings = known
        self._executor.barrier(accesses)
        self._executor.binder.bind(bindings)

    def _looked_up(self, slot: Slot, ref: Ref) -> Drawn:
        bound = looks(slot, ref, self._node.uses.program)
        lasting = not any(isinstance(resource, AnyHandle) for _, resource in bound)
        physical = [(look, r.physical if isinstance(r, AnyHandle) else r) for look, r in bound]
        bindings = self._executor.binder.prepare(physical)
        found = [(resource, look.barrier, 0) for look, resource in physical], bindings
        if lasting:
            self._executor.recall.draws[slot, ref] = found
        return found

    def set(self, **changes: Any) -> None:
        """Change fields of the pass's RasterState for the draws that follow."""
        key = (self._node.state, tuple(sorted(changes.items())))
        state = _changed_states.get(key)
        if state is None:
            state = _changed_states[key] = dataclasses.replace(self._node.state, **changes)
        self._executor.set_state(state)

    def draw(
        self,
        vertex_input: VertexInput | None,
        count: int,
        first: int = 0,
        instances: int = 1,
        mode: str = "triangles",
    ) -> None:
        """Draw ``count`` indices (or vertices, without an index buffer) from ``first``."""
        if count and instances:
            self._vertex_array(vertex_input).render(_MODES[mode], count, first, instances)

    def draw_indirect(
        self,
        vertex_input: VertexInput,
        commands: AnyBuffer,
        count: int = 1,
        first: int = 0,
        mode: str = "triangles",
    ) -> None:
        """``count`` DrawElementsIndirectCommand (5 uint each) from number ``first``."""
        physical = commands.physical if isinstance(commands, BufferHandle) else commands
        if physical is None:
            raise GraphError(f"{self._node.name}: name {commands.name} in uses=")
        if physical.serial not in self._seen:
            self._seen.add(physical.serial)
            self._executor.barrier([(physical, c.COMMAND_BARRIER, 0)])
        vertex_array = self._vertex_array(vertex_input)
        vertex_array.render_indirect(physical.mgl, _MODES[mode], count, first)

    def _vertex_array(self, vertex_input: VertexInput | None) -> moderngl.VertexArray:
        program = self._node.uses.program
        if self._missing:
            require_all(program, self._missing)
        serial = 0
        if vertex_input is not None:
            serial = vertex_input.serial
            if serial not in self._seen:
                self._seen.add(serial)
                self._executor.barrier(vertex_input.accesses)
        vertex_array = program.vertex_arrays.get(serial)
        if vertex_array is None:
            vertex_array = self._make(program.mgl, vertex_input)
            program.vertex_arrays[serial] = vertex_array
        return vertex_array

    def _make(self, program: Any, vertex_input: VertexInput | None) -> moderngl.VertexArray:
        ctx = self._executor.device.ctx
        if vertex_input is None:
            return ctx.vertex_array(program, [])
        content = [(buffer.mgl, layout, *names) for buffer, layout, names in vertex_input.content]
        index = vertex_input.index.mgl if vertex_input.index else None
        given = {name for _, _, names in vertex_input.content for name in names}
        attributes = {name for name in program if isinstance(program[name], moderngl.Attribute)}
        wanted = {name for name in attributes if not name.startswith("gl_")}
        if wanted - given:
            missing = ", ".join(sorted(wanted - given))
            raise GraphError(f"{self._node.uses.program.shader!r}: attribute {missing} not given")
        return ctx.vertex_array(program, content, index, skip_errors=True)
