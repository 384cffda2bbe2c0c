"""Fixtures of the whole suite: the device, whose every complaint fails the test that caused it."""

from __future__ import annotations

import os
from collections.abc import Iterator

import hypothesis
import pytest

from elemental.gpu.device import Device

hypothesis.settings.register_profile("no deadline", deadline=None)
"""An example may take long on a machine that others use; pytest bounds the whole test."""
hypothesis.settings.load_profile("no deadline")

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
"""Hundreds of processes start the program: they share what is compiled of it."""

_devices: list[Device] = []


@pytest.fixture(scope="session")
def device() -> Iterator[Device]:
    """A headless debug device, shared by the session."""
    made = Device.headless(debug=True)
    _devices.append(made)
    yield made
    _devices.remove(made)
    made.release()


@pytest.fixture(autouse=True)
def no_driver_messages() -> Iterator[None]:
    """Fail the test on GL errors and on messages of high or medium severity.

    Advice about speed counts on software drivers only: elsewhere it depends on the machine.
    """
    for made in _devices:
        made.log.messages.clear()
    yield
    for made in _devices:
        made.check()
        warnings = [
            str(message)
            for message in made.log.messages
            if message.severity in ("high", "medium")
            and (made.info.software or not message.is_performance)
        ]
        assert not warnings, warnings
