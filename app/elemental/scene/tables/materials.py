"""What a scene file makes of its models' materials."""

from __future__ import annotations

from typing import Any

from elemental.scene.materials import AlphaMode
from elemental.scene.tables.base import Name, Table


class MaterialTable(Table):
    name: Name
    shader: Name | None = None
    double_sided: bool | None = None
    alpha_mode: AlphaMode | None = None
    parameters: dict[str, Any] = {}
