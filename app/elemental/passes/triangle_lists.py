"""The triangles that the three voxelization views have to draw, listed on the GPU."""

from __future__ import annotations

import numpy as np

from elemental.core.layout import layouts, pack_array
from elemental.gpu.device import Device
from elemental.gpu.resources import Buffer
from elemental.passes.scene_pack import Array

VIEWS = 3
"""Along x, y and z."""
TRIANGLES_MAX = 1 << 21
"""Of placed meshes, that lists are kept for: 36 bytes each. Larger scenes are drawn whole."""


class TriangleLists:
    """What each view draws: see glsl/voxel/select_triangles.comp.glsl.

    From what `scene_pack.pack_draws` gives, commands (D,) DRAW_COMMAND and order (N,), and from the
    indices that the commands draw. Here each instance, in draw order, has a command of its own,
    whose base instance is the instance's number.

    ``dynamic`` (N,) bool by instance number: their chunks stand last, so that they can be listed
    alone. ``selects``: whether there are lists at all; without, `commands` draw every triangle.
    """

    def __init__(
        self, device: Device, commands: Array, order: Array, indices: Buffer, dynamic: Array
    ) -> None:
        self.instances = len(order)
        whole = np.repeat(commands, commands["instance_count"])
        whole["instance_count"] = 1
        whole["base_instance"] = order
        ends = np.cumsum(whole["count"], dtype=np.int64)
        self.selects = 0 < int(ends[-1]) // 3 <= TRIANGLES_MAX
        self._buffers: list[Buffer] = []

        def upload(name: str, values: Array | int) -> Buffer:
            made = device.buffer(f"scene.lists.{name}", values, category="meshes")
            self._buffers.append(made)
            return made

        if not self.selects:
            self.commands, self.indices = upload("commands", whole), indices
            return
        empty = np.tile(whole, (VIEWS, 1))
        empty["count"] = 0
        empty["first_index"] = np.arange(VIEWS)[:, None] * ends[-1] + ends - whole["count"]
        self.empty = upload("empty", empty)
        self.commands = upload("commands", empty.nbytes)
        self.indices = upload("indices", int(VIEWS * ends[-1]) * 4)
        chunks = _chunks(whole)
        moves = dynamic[chunks["instance"]]
        self._still_chunks, self._chunks = int((~moves).sum()), len(chunks)
        self.chunks = upload("chunks", chunks[np.argsort(moves, kind="stable")])

    def selection(self, dynamic: bool | None) -> tuple[int, int]:
        """(first, count) of the chunks of what can, or can't, move; None: of all."""
        if dynamic is None:
            return 0, self._chunks
        if dynamic:
            return self._still_chunks, self._chunks - self._still_chunks
        return 0, self._still_chunks

    def first_command(self, view: int) -> int:
        """Of a view's commands, one an instance."""
        return view * self.instances if self.selects else 0

    def release(self) -> None:
        """Free everything but the indices that were given."""
        for buffer in self._buffers:
            buffer.release()


def _chunks(draws: Array) -> Array:
    """TriangleChunks of the triangles of ``draws`` (N,) DRAW_COMMAND of an instance each."""
    size = int(layouts().constant("TRIANGLE_GROUP"))
    triangles = draws["count"].astype(np.int64) // 3
    of_draw = -(-triangles // size)
    draw = np.repeat(np.arange(len(draws)), of_draw)
    first = (np.arange(len(draw)) - np.repeat(np.cumsum(of_draw) - of_draw, of_draw)) * size
    return pack_array(
        layouts().struct("TriangleChunk"),
        len(draw),
        first_index=draws["first_index"][draw] + 3 * first,
        triangles=np.minimum(triangles[draw] - first, size),
        base_vertex=draws["base_vertex"][draw],
        instance=draws["base_instance"][draw],
        draw=draw,
    )
