# PP-11
"""What waits between the server and the frame: bounded, and the newest values all arrive."""

from __future__ import annotations

import threading
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from elemental.remote.mailbox import Mailbox
from elemental.remote.rate_limit import RateLimit
from elemental.scene.volumes import Volume
from elemental.settings import Settings

NAMES = ("a", "b", "c")


def test_every_newest_value_arrives_whatever_the_threads_do() -> None:
    mailbox, volumes = Mailbox(), [Volume(name) for name in NAMES]
    frames: Sequence[Volume] = mailbox.exchange(volumes, Settings())
    steps = 400

    def fader(name: str) -> None:
        for step in range(steps + 1):
            mailbox.put(name, "weight", step / steps)
            mailbox.put(name, "exposure", step / steps)

    threads = [threading.Thread(target=fader, args=(name,)) for name in NAMES]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        frames = mailbox.exchange(frames, Settings())
    frames = mailbox.exchange(frames, Settings())
    assert [(v.name, v.blend_weight, v.overrides) for v in frames] == [
        (name, 1.0, {"exposure": 1.0}) for name in NAMES
    ]


@given(st.lists(st.tuples(st.sampled_from(NAMES), st.floats(0, 1), st.booleans()), max_size=50))
def test_any_order_of_changes_and_frames_equals_changes_at_once(
    steps: list[tuple[str, float, bool]],
) -> None:
    mailbox, model = Mailbox(), dict.fromkeys(NAMES, 1.0)
    volumes: Sequence[Volume] = [Volume(name) for name in NAMES]
    mailbox.exchange(volumes, Settings())
    for name, weight, frame in steps:
        mailbox.put(name, "weight", weight)
        model[name] = weight
        assert {v.name: v.blend_weight for v in mailbox.volumes()} == model
        if frame:
            volumes = mailbox.exchange(volumes, Settings())
            assert {v.name: v.blend_weight for v in volumes} == model
    assert len(mailbox._pending) <= len(NAMES)


def test_a_change_of_a_volume_that_is_gone_is_forgotten() -> None:
    mailbox = Mailbox()
    mailbox.exchange([Volume("a"), Volume("b")], Settings())
    mailbox.put("b", "weight", 0.5)
    (left,) = mailbox.exchange([Volume("a")], Settings())
    assert left == Volume("a")


def test_a_frame_without_changes_gets_its_own_volumes_back() -> None:
    volumes = [Volume("a")]
    assert Mailbox().exchange(volumes, Settings()) is volumes


@given(st.lists(st.floats(0.0, 0.2), min_size=1, max_size=100))
def test_a_limit_never_lets_more_through_than_its_rate(gaps: list[float]) -> None:
    rate, burst, now = 10.0, 3.0, 0.0
    limit = RateLimit(rate, burst, lambda: now)
    passed = []
    for gap in gaps:
        now += gap
        passed.append(now + limit.delay())
    assert passed == sorted(passed)
    for first, began in enumerate(passed):
        for last in range(first, len(passed)):
            assert last - first + 1 <= burst + rate * (passed[last] - began) + 1e-6
