"""What frames share: handles by declaration, and forgetting. PP-01"""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from elemental.gpu.recall import GENERATION, Recall, Recent
from elemental.gpu.refs import BufferHandle


def declared(recall: Recall, names: str) -> list[BufferHandle]:
    """The handles of a frame that declares a buffer for each letter."""
    recall.begin_frame()
    return [recall.handle(BufferHandle, name, 16) for name in names]


def test_frames_that_declare_alike_are_given_the_same_handles() -> None:
    recall = Recall()
    first = declared(recall, "abab")
    assert len({id(handle) for handle in first}) == 4
    assert [handle.name for handle in first] == ["a", "b", "a", "b"]
    again = declared(recall, "abab")
    assert all(one is other for one, other in zip(first, again, strict=True))


@given(st.lists(st.text("abc", max_size=6), max_size=6))
def test_a_frame_is_given_no_handle_twice_and_its_namesakes_in_order(frames: list[str]) -> None:
    recall = Recall()
    known: dict[tuple[str, int], BufferHandle] = {}
    for names in frames:
        handles = declared(recall, names)
        assert len({id(handle) for handle in handles}) == len(names)
        for position, (name, handle) in enumerate(zip(names, handles, strict=True)):
            assert known.setdefault((name, names[:position].count(name)), handle) is handle


def test_what_is_not_asked_for_during_two_generations_is_forgotten() -> None:
    recall = Recall()
    (kept, left) = declared(recall, "kl")
    for _ in range(2 * GENERATION):
        assert declared(recall, "k")[0] is kept
    assert declared(recall, "l")[0] is not left
    assert declared(recall, "k")[0] is kept


def test_asking_makes_young() -> None:
    recent: Recent[int] = Recent()
    recent["a"], recent["b"] = 1, 2
    recent.grow_old()
    assert recent.get("a") == 1
    recent.grow_old()
    assert (recent.get("a"), recent.get("b"), len(recent)) == (1, None, 1)
    recent.clear()
    assert recent.get("a") is None
