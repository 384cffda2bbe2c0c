"""Servers that tests of remote control talk to."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from unit.remote.client import Rig


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    yield made
    made.remote.release()
    assert made.remote.faults == 0


@pytest.fixture(scope="module")
def shared() -> Iterator[Rig]:
    """One server for many fuzzed requests."""
    made = Rig()
    yield made
    made.remote.release()
    assert made.remote.faults == 0
