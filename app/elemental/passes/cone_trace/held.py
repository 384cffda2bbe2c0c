"""The light that a view has gathered, held while nothing that it depends on changes."""

from __future__ import annotations

from collections.abc import Hashable

from elemental.gpu.device import Device
from elemental.gpu.formats import RGBA16F
from elemental.gpu.graph import Graph
from elemental.gpu.resources import Texture


class HeldLight:
    """Targets of the cones that outlive their frame.

    diffuse, specular: (H, W) RGBA16F, as `combine_diffuse` and `trace_specular` leave them. Frames
    of a view that stands read them as they are: the cones would find what they found before.
    """

    diffuse: Texture
    specular: Texture

    def __init__(self, device: Device) -> None:
        self._device = device
        self._targets: list[Texture] = []
        self._size = (0, 0)
        self._key: Hashable = None
        self._gathered_by: Graph | None = None

    def stands(self, g: Graph, size: tuple[int, int], key: Hashable) -> bool:
        """Whether the light of a view (width, height) is held. If not, ``g`` is to gather it.

        ``key``: equal where all that the light depends on is.
        """
        by = self._gathered_by
        if by is not None and by.has_run and self._size == size and self._key == key:
            return True
        if self._size != size:
            self.release()
            for name in ("diffuse_gi", "specular_gi"):
                made = self._device.texture(name, size, RGBA16F, category="targets")
                self._targets.append(made)  # one by one: the other may not fit any more
            self.diffuse, self.specular = self._targets
            self._size = size
        self._key, self._gathered_by = key, g
        return False

    def forget(self) -> None:
        """Gather anew with the next frame."""
        self._gathered_by = None

    def release(self) -> None:
        """Free the targets."""
        while self._targets:
            self._targets.pop().release()
        self._size, self._gathered_by = (0, 0), None
