"""The target pool, without GL. PP-02"""

from __future__ import annotations

import itertools
from collections.abc import Hashable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.gpu.pool import TargetPool

_serial = itertools.count()


class Target:
    """A resource that counts its bytes as its description says."""

    def __init__(self, description: Hashable) -> None:
        assert isinstance(description, int)
        self.serial, self.nbytes, self.released = next(_serial), description, False

    def release(self) -> None:
        assert not self.released
        self.released = True


def test_a_released_target_is_reused_by_the_next_request_of_its_description() -> None:
    pool = TargetPool(Target)
    first = pool.acquire(64)
    pool.give_back(64, first)
    assert pool.acquire(32) is not first
    assert pool.acquire(64) is first
    assert (pool.stats.allocations, pool.stats.reuses, pool.stats.bytes) == (2, 1, 96)


def test_a_target_is_freed_after_exactly_n_unused_frames() -> None:
    pool = TargetPool(Target, idle_frames=3)
    target = pool.acquire(64)
    pool.end_frame()
    pool.give_back(64, target)
    for _ in range(3):
        pool.end_frame()
        assert not target.released
    pool.end_frame()
    assert target.released
    assert (pool.stats.bytes, pool.stats.freed, pool.stats.high_water) == (0, 1, 64)


def test_use_resets_the_wait() -> None:
    pool = TargetPool(Target, idle_frames=2)
    target = pool.acquire(1)
    for _ in range(10):
        pool.give_back(1, target)
        pool.end_frame()
        pool.end_frame()
        assert pool.acquire(1) is target


def test_a_failed_allocation_is_not_counted() -> None:
    def fail(_: Hashable) -> Target:
        raise MemoryError

    pool = TargetPool(fail)
    with pytest.raises(MemoryError):
        pool.acquire(1)
    assert (pool.stats.in_use, pool.stats.allocations) == (0, 0)


@given(st.lists(st.tuples(st.booleans(), st.integers(1, 3)), max_size=60))
def test_nothing_is_handed_out_twice_and_a_repeated_frame_allocates_nothing(
    steps: list[tuple[bool, int]],
) -> None:
    pool = TargetPool(Target)

    def frame() -> list[Target]:
        held: list[tuple[int, Target]] = []
        seen = []
        for acquire, key in steps:
            if acquire or not held:
                target = pool.acquire(key)
                assert all(target is not other for _, other in held)
                assert target.nbytes == key
                held.append((key, target))
                seen.append(target)
            else:
                pool.give_back(*held.pop(0))
        for item in held:
            pool.give_back(*item)
        pool.end_frame()
        return seen

    frame()
    allocated = pool.stats.allocations
    second, third = frame(), frame()
    assert pool.stats.allocations == allocated
    assert [t.serial for t in second] == [t.serial for t in third]
    assert pool.stats.in_use == 0
