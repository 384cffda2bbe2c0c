"""Shader files for one test: small texts written beside each other in a folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from elemental.gpu.shaders import Compute, Raster

FULL_SCREEN = """
out vec2 v_uv;
void main() {
    v_uv = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(v_uv * 2.0 - 1.0, 0.0, 1.0);
}
"""


class Sources:
    """Writes GLSL into ``folder`` and describes programs of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._count = 0

    def file(self, text: str, suffix: str) -> Path:
        """A new file ``N.suffix.glsl``."""
        self._count += 1
        path = self.folder / f"{self._count}.{suffix}.glsl"
        path.write_text(text)
        return path

    def compute(
        self,
        body: str,
        head: str = "",
        local: tuple[int, int, int] = (64, 1, 1),
        defines: Mapping[str, int] | None = None,
    ) -> Compute:
        """A compute program with ``head`` at file scope and ``body`` as main."""
        size = "layout(local_size_x = {}, local_size_y = {}, local_size_z = {}) in;".format(*local)
        return Compute(self.file(f"{size}\n{head}\nvoid main() {{\n{body}\n}}\n", "comp"), defines)

    def full_screen(self, body: str, head: str = "out vec4 o_color;") -> Raster:
        """A full-screen fragment program; ``v_uv`` runs from 0 to 1."""
        fragment = f"in vec2 v_uv;\n{head}\nvoid main() {{\n{body}\n}}\n"
        return Raster(self.file(FULL_SCREEN, "vert"), self.file(fragment, "frag"))

    def mesh(self, vertex: str, fragment: str, geometry: str | None = None) -> Raster:
        """A program of whole texts."""
        geom = self.file(geometry, "geom") if geometry else None
        return Raster(self.file(vertex, "vert"), self.file(fragment, "frag"), geom)
