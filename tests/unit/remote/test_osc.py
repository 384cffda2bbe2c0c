# PP-11
"""Volumes driven over OSC: the same checks, no answers."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder

from elemental.core.errors import InputError
from elemental.remote import osc
from elemental.remote.mailbox import Mailbox
from elemental.scene.volumes import Volume
from elemental.settings import Settings
from unit.remote.client import Rig

TOKEN = "secret"


def message(address: str, *values: Any) -> bytes:
    builder = OscMessageBuilder(address)
    for value in values:
        builder.add_arg(value)
    return bytes(builder.build().dgram)


@pytest.fixture
def mailbox() -> Mailbox:
    made = Mailbox()
    made.exchange([Volume("cellar"), Volume("the lamp/ü")], Settings())
    return made


@pytest.mark.parametrize(
    ("address", "values", "field", "value"),
    [
        ("cellar/weight", (0.25,), "blend_weight", 0.25),
        ("cellar/weight", (1,), "blend_weight", 1.0),
        ("cellar/enabled", (False,), "enabled", False),
        ("cellar/enabled", (0.0,), "enabled", False),
        ("cellar/unbound", (1,), "unbound", True),
        ("cellar/exposure", (-1.5,), "overrides", {"exposure": -1.5}),
        ("cellar/indirect.color", (1, 0.5, 0), "overrides", {"indirect.color": (1, 0.5, 0)}),
    ],
)
def test_a_message_changes_its_property(
    mailbox: Mailbox, address: str, values: tuple[Any, ...], field: str, value: Any
) -> None:
    assert osc.receive(message(f"/{TOKEN}/volumes/{address}", *values), mailbox, TOKEN) == 1
    assert getattr(mailbox.volumes()[0], field) == value


def test_a_bundle_changes_several_and_names_may_be_escaped(mailbox: Mailbox) -> None:
    bundle = OscBundleBuilder(IMMEDIATELY)
    for name in ("cellar", "the%20lamp%2F%C3%BC"):
        builder = OscMessageBuilder(f"/{TOKEN}/volumes/{name}/weight")
        builder.add_arg(0.5)
        bundle.add_content(builder.build())
    assert osc.receive(bytes(bundle.build().dgram), mailbox, TOKEN) == 2
    assert [volume.blend_weight for volume in mailbox.volumes()] == [0.5, 0.5]


@pytest.mark.parametrize(
    ("address", "values"),
    [
        ("/guess/volumes/cellar/weight", (0.5,)),
        ("/volumes/cellar/weight", (0.5,)),
        (f"/{TOKEN}/volumes/attic/weight", (0.5,)),
        (f"/{TOKEN}/volumes/cellar/weight/x", (0.5,)),
        (f"/{TOKEN}/volumes/cellar/weight", (1.5,)),
        (f"/{TOKEN}/volumes/cellar/weight", (float("nan"),)),
        (f"/{TOKEN}/volumes/cellar/weight", ()),
        (f"/{TOKEN}/volumes/cellar/weight", ("x",)),
        (f"/{TOKEN}/volumes/cellar/gi.resolution", (64,)),
        (f"/{TOKEN}/volumes/cellar/enabled", (0.5,)),
    ],
)
def test_other_messages_change_nothing(
    mailbox: Mailbox, address: str, values: tuple[Any, ...]
) -> None:
    before = mailbox.volumes()
    assert osc.receive(message(address, *values), mailbox, TOKEN) == 0
    assert mailbox.volumes() == before


PREFIX = message(f"/{TOKEN}/volumes/cellar/weight", 0.5)


@settings(max_examples=1000)
@given(
    st.one_of(
        st.binary(max_size=200),
        st.binary(max_size=60).map(b"#bundle\0".__add__),
        st.binary(max_size=60).map(b"/a\0\0,".__add__),
        st.tuples(st.integers(0, len(PREFIX)), st.binary(max_size=8)).map(
            lambda cut: PREFIX[: cut[0]] + cut[1] + PREFIX[cut[0] + len(cut[1]) :]
        ),
    )
)
def test_any_datagram_is_taken_or_dropped(datagram: bytes) -> None:
    mailbox = Mailbox()
    mailbox.exchange([Volume("cellar")], Settings())
    osc.receive(datagram, mailbox, TOKEN)
    (volume,) = mailbox.volumes()
    assert 0.0 <= volume.blend_weight <= 1.0


def test_a_long_datagram_is_dropped() -> None:
    assert list(osc.messages(message("/a", "x" * osc.MAX_DATAGRAM))) == []


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig(osc=True)
    yield made
    made.remote.release()
    assert made.remote.faults == 0


def waits_for(condition: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + 10.0
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()


def place(rig: Rig) -> tuple[str, int]:
    line = next(line for line in rig.remote.announcement if "OSC" in line)
    return "127.0.0.1", int(line.split("127.0.0.1:")[1].split(",")[0])


def test_datagrams_reach_the_frame(rig: Rig) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b"\xff" * 100, place(rig))
        address = f"/{rig.remote.token}/volumes/cellar/weight"
        sender.sendto(message(address, 0.5), place(rig))
    assert waits_for(lambda: rig.frame()[0].blend_weight == 0.5)


def test_datagrams_without_the_token_cost_its_owner_none(rig: Rig) -> None:
    stranger = message("/guess/volumes/cellar/weight", 0.25)
    own = f"/{rig.remote.token}/volumes/cellar/weight"
    arrived = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for number in range(20):  # a hundred of a stranger's for each of the owner's
            for _ in range(100):
                sender.sendto(stranger, place(rig))
            sender.sendto(message(own, number / 32), place(rig))
            time.sleep(0.02)
            arrived.append(rig.frame()[0].blend_weight)
    assert waits_for(lambda: rig.frame()[0].blend_weight == 19 / 32)
    assert len(set(arrived)) > 5


def test_the_missing_extra_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pythonosc", None)
    with pytest.raises(
        InputError, match=r"--osc: needs python-osc: pip install 'elemental\[osc\]'"
    ):
        Rig(osc=True)
