"""Fixtures of the GPU tests."""

from __future__ import annotations

from pathlib import Path

import pytest

from gpu.sources import Sources


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """Writer of shader files that live as long as the test."""
    return Sources(tmp_path)
