"""Square tiles of the layers of the shadow maps' texture array, halved as often as asked for."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


class Tile(NamedTuple):
    """A square of a layer: its lower left corner and its side in texels."""

    layer: int
    x: int
    y: int
    side: int


@dataclass
class TilePool:
    """`layers` squares of `side` texels from the layer `first` on, cut into tiles of half, a
    quarter, … the side.

    Tiles are kept by the key that asked for them, so that what was drawn into them stays.
    """

    layers: int
    side: int
    first: int = 0
    held: dict[Hashable, Tile] = field(default_factory=dict)
    _free: dict[int, set[Tile]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._clear()

    def _clear(self) -> None:
        self.held.clear()
        layers = range(self.first, self.first + self.layers)
        self._free = {self.side: {Tile(layer, 0, 0, self.side) for layer in layers}}

    def assign(self, sides: Mapping[Hashable, int]) -> dict[Hashable, Tile]:
        """A tile of the wanted side for each key; together they must not exceed the pool's area.

        Keys that had a tile of that side keep it, unless the free area is too scattered for the
        others: then all are placed anew, which always succeeds from the largest down.
        """
        for key, tile in list(self.held.items()):
            if sides.get(key) != tile.side:
                self._give(self.held.pop(key))
        if not self._place({key: side for key, side in sides.items() if key not in self.held}):
            self._clear()
            if not self._place(sides):
                raise ValueError("the tiles are larger than the pool")
        return self.held

    def _place(self, sides: Mapping[Hashable, int]) -> bool:
        for key in sorted(sides, key=lambda key: -sides[key]):
            tile = self._take(sides[key])
            if tile is None:
                return False
            self.held[key] = tile
        return True

    def _take(self, side: int) -> Tile | None:
        free = self._free.setdefault(side, set())
        if not free:
            larger = self._take(2 * side) if side < self.side else None
            if larger is None:
                return None
            free.update(_quarters(larger))
        tile = min(free)
        free.remove(tile)
        return tile

    def _give(self, tile: Tile) -> None:
        """Free a tile, and with the last of four the one that they were cut from."""
        free = self._free.setdefault(tile.side, set())
        free.add(tile)
        side = 2 * tile.side
        if side > self.side:
            return
        whole = Tile(tile.layer, tile.x // side * side, tile.y // side * side, side)
        if free.issuperset(_quarters(whole)):
            free.difference_update(_quarters(whole))
            self._give(whole)


def _quarters(tile: Tile) -> list[Tile]:
    half = tile.side // 2
    return [
        Tile(tile.layer, tile.x + dx, tile.y + dy, half) for dy in (0, half) for dx in (0, half)
    ]
