"""The glTF files that a scene file places."""

from __future__ import annotations

from elemental.scene.tables.base import Name, Positive, Table, Vec3


class ModelTable(Table):
    file: Name
    name: Name | None = None
    translation: Vec3 = [0.0, 0.0, 0.0]
    rotation_deg: Vec3 = [0.0, 0.0, 0.0]
    scale: Positive = 1.0
    receives_decals: bool = True
