"""KHR_draco_mesh_compression, through the optional DracoPy."""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
import numpy.typing as npt

from elemental.scene.gltf.container import Document
from elemental.scene.gltf.fields import Field

EXTENSION = "KHR_draco_mesh_compression"


def is_installed() -> bool:
    """Whether the extra that decodes is there."""
    try:
        return importlib.util.find_spec("DracoPy") is not None
    except ValueError:  # it was taken out of Python's list by hand
        return False


class DracoPrimitive:
    """A decoded primitive: `indices` (M,) uint32 and `attribute` by glTF name."""

    def __init__(self, document: Document, extension: Field) -> None:
        """Raises InputError for broken data and where DracoPy is not installed."""
        try:
            import DracoPy  # noqa: PLC0415 (an extra)
        except ImportError as error:
            reason = "needs DracoPy; install elemental with the extra [draco]"
            raise extension.error(reason) from error
        self._ids = extension.need("attributes")
        view = extension.need("bufferView")
        window, _ = document.view(view.index(len(document.views), "bufferViews"))
        try:
            mesh = DracoPy.decode(bytes(window))
            self._attributes = {a["unique_id"]: np.asarray(a["data"]) for a in mesh.attributes}
            faces = np.asarray(mesh.faces, np.uint32)
        except Exception as error:  # the binding raises what Draco's C++ throws
            raise extension.error("broken Draco data") from error
        self.indices: npt.NDArray[np.uint32] = faces.reshape(-1)

    def attribute(self, name: str) -> npt.NDArray[Any] | None:
        """(N, width) values as compressed, or None where `name` is not compressed."""
        identifier = self._ids.find(name)
        if identifier is None:
            return None
        values = self._attributes.get(identifier.integer())
        if values is None:
            raise identifier.error("the Draco data has no such attribute")
        return values.reshape(len(values), -1)
