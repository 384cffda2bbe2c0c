"""The draws of a scene as one viewer sees them."""

from __future__ import annotations

from dataclasses import dataclass

from elemental.gpu.resources import Buffer, VertexInput


@dataclass(frozen=True)
class Placed:
    """Draw commands, the instance numbers that they index, and the vertex inputs over both."""

    commands: Buffer
    order: Buffer
    vertices: VertexInput
    positions_only: VertexInput

    def release(self) -> None:
        """Free them."""
        self.vertices.release()
        self.positions_only.release()
        self.commands.release()
        self.order.release()
