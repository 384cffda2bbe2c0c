"""What a viewer sees of a scene, and the draws of that. No GL here."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from elemental.passes.scene_pack import Array, Batch


class Culling:
    """Which instances a viewer sees, as draw commands with fewer instances each.

    commands (D,) DRAW_COMMAND, order (N,) instance numbers in draw order; low and high (N, 3) world
    boxes by instance number and visible (N,) bool, which their owner changes and then says so.
    """

    def __init__(
        self, commands: Array, order: Array, low: Array, high: Array, visible: Array
    ) -> None:
        self._commands, self._order = commands, order
        self._segment = np.repeat(np.arange(len(commands)), commands["instance_count"])
        self._low, self._high, self._visible = low, high, visible
        self._extents = _extents(low, high)
        self._revision = 0
        self._looked: dict[str, tuple[bytes, int]] = {}
        self._seen: dict[str, bytes] = {}

    @property
    def centers(self) -> Array:
        """(N, 3) of the boxes."""
        return self._extents[0]

    def moved(self) -> None:
        """Some boxes changed."""
        self._extents = _extents(self._low, self._high)
        self._revision += 1

    def look(
        self, viewers: Sequence[str], clip_from_world: Array
    ) -> Iterator[tuple[str, Array, Array]]:
        """(viewer, commands, order) of those viewers that see other instances than before.

        clip_from_world: (V, 4, 4), a matrix for each.
        """
        keys = [(matrix.tobytes(), self._revision) for matrix in clip_from_world]
        fresh = [k for k, name in enumerate(viewers) if self._looked.get(name) != keys[k]]
        if not fresh:
            return
        inside = _inside(clip_from_world[fresh], *self._extents) & self._visible
        for k, seen in zip(fresh, inside[:, self._order], strict=True):
            viewer = viewers[k]
            self._looked[viewer] = keys[k]
            if self._seen.get(viewer) == seen.tobytes():
                continue
            self._seen[viewer] = seen.tobytes()
            commands = self._commands.copy()
            counts = np.add.reduceat(seen, commands["base_instance"], dtype="<u4")
            commands["instance_count"] = counts
            yield viewer, commands, self._order[np.lexsort((~seen, self._segment))]

    def instances_of(self, batch: Batch) -> range:
        """Where the batch's instances stand in draw order."""
        drawn = self._commands[batch.first : batch.first + batch.count]
        first = int(drawn["base_instance"][0])
        return range(first, first + int(drawn["instance_count"].sum()))

    def visible(self, clip_from_world: Array) -> Array:
        """(N,) bool: visible instances whose box is not wholly outside a plane of the frustum."""
        return np.asarray(_inside(clip_from_world[None], *self._extents)[0] & self._visible)


def in_frustum(clip_from_world: Array, low: Array, high: Array) -> Array:
    """(N,) bool: which boxes low, high (N, 3) are not wholly outside one of the six planes."""
    return np.asarray(_inside(clip_from_world[None], *_extents(low, high))[0])


def views_with_any(clip_from_world: Array, low: Array, high: Array) -> Array:
    """(V,) bool: which of the matrices (V, 4, 4) have any of the boxes in their frustum."""
    return np.asarray(_inside(clip_from_world, *_extents(low, high)).any(axis=1))


def _extents(low: Array, high: Array) -> tuple[Array, Array]:
    """(centres, half diagonals), each (N, 3) float64, of boxes."""
    low = low.astype(np.float64)
    return (low + high) / 2, (high - low) / 2


def _inside(matrices: Array, center: Array, half: Array) -> Array:
    """(V, N) bool of `in_frustum`; center, half (N, 3) of the boxes."""
    m = matrices.astype(np.float64)
    planes = np.concatenate([m[:, 3:] + m[:, :3], m[:, 3:] - m[:, :3]], axis=1).reshape(-1, 4)
    normals = planes[:, :3]
    nearest = normals @ center.T  # (6 V, N)
    nearest += np.abs(normals) @ half.T
    nearest += planes[:, 3:]
    return np.asarray((nearest >= 0.0).reshape(len(m), 6, len(center)).all(axis=1))
