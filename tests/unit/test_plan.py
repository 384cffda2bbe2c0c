"""The planning of a frame, without GL: culling, order, lifetimes, barriers. PP-01"""

from __future__ import annotations

import random
from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elemental.gpu import gl as c
from elemental.gpu.plan import UNORDERED, Hazards, PlanError, Schedule, schedule


@dataclass
class P:
    """A pass; resources are single letters."""

    name: str
    r: str = ""
    m: str = ""
    o: str = ""
    has_side_effect: bool = False
    table: str = field(default="", repr=False)

    @property
    def reads(self) -> list[int]:
        return [self.table.index(x) for x in self.r]

    @property
    def modifies(self) -> list[int]:
        return [self.table.index(x) for x in self.m]

    @property
    def overwrites(self) -> list[int]:
        return [self.table.index(x) for x in self.o]


def plan(passes: list[P], kept: str = "", persistent: str = "") -> tuple[Schedule, str]:
    table = "".join(sorted({x for p in passes for x in p.r + p.m + p.o} | set(kept + persistent)))
    for p in passes:
        p.table = table
    outlives, outputs = ([table.index(x) for x in names] for names in (persistent, kept))
    result = schedule(passes, table.__getitem__, outlives, outputs)
    return result, " ".join(passes[i].name for i in result.order)


def test_a_pass_nobody_reads_is_culled_with_all_that_fed_it() -> None:
    passes = [P("a", m="a"), P("b", r="a", m="b"), P("c", r="a", m="c"), P("d", r="c", m="d")]
    result, order = plan(passes, kept="b")
    assert order == "a b"
    assert result.culled == [2, 3]


def test_a_pass_between_is_kept_only_if_it_is_on_the_way() -> None:
    passes = [P("clear", o="x"), P("add", m="x"), P("other", m="y"), P("show", r="x", m="z")]
    assert plan(passes, kept="z")[1] == "clear add show"


def test_an_overwrite_frees_the_earlier_writer() -> None:
    passes = [P("lost", m="x"), P("clear", o="x"), P("add", m="x")]
    assert plan(passes, kept="x")[1] == "clear add"


def test_an_overwrite_does_not_free_a_writer_that_was_read_before() -> None:
    passes = [
        P("first", m="x"),
        P("use", r="x", m="y"),
        P("clear", o="x"),
        P("show", r="xy", m="z"),
    ]
    assert plan(passes, kept="z")[1] == "first use clear show"


def test_writers_of_persistent_resources_and_side_effects_always_run() -> None:
    passes = [P("store", m="p"), P("idle", m="x"), P("send", r="p", has_side_effect=True)]
    assert plan(passes, persistent="p")[1] == "store send"


def test_an_earlier_version_is_not_an_output() -> None:
    passes = [P("a", m="x"), P("b", o="x"), P("c", m="x", r="q"), P("q", m="q")]
    assert plan(passes, kept="x")[1] == "b q c"


def test_a_consumer_declared_before_its_producer_runs_after_it() -> None:
    passes = [P("show", r="x", m="z"), P("make", m="x"), P("more", m="x")]
    assert plan(passes, kept="z")[1] == "make more show"


def test_a_late_writer_waits_for_the_readers_of_the_version_before() -> None:
    # "use" must wait for "late", and "clear" must not destroy what "use" still has to read.
    passes = [P("make", m="x"), P("use", r="xl", m="y"), P("clear", o="x"), P("late", m="l"),
              P("show", r="xy", m="z")]  # fmt: skip
    assert plan(passes, kept="z")[1] == "make late use clear show"


def test_a_pass_that_writes_a_resource_twice_does_not_wait_for_itself() -> None:
    passes = [P("show", r="x", m="z"), P("two mips", m="xx")]
    assert plan(passes, kept="z")[1] == "two mips show"


def test_a_cycle_is_an_error_that_names_the_passes() -> None:
    passes = [P("a", r="y", m="x"), P("b", r="x", m="y")]
    with pytest.raises(PlanError, match="wait for each other: a, b"):
        plan(passes, kept="y")


def test_reading_what_nobody_writes_is_an_error() -> None:
    with pytest.raises(PlanError, match="pass a reads x, which no pass writes"):
        plan([P("a", r="x", m="y")], kept="y")
    with pytest.raises(PlanError, match="pass a reads x"):
        plan([P("a", r="x", m="x")], kept="x")


def test_keeping_what_nobody_writes_is_an_error() -> None:
    with pytest.raises(PlanError, match="x is kept, but no pass writes it"):
        plan([P("a", m="y")], kept="x")
    assert plan([P("a", m="y")], kept="xy", persistent="x")[1] == "a"


def test_lifetimes_span_first_to_last_use_among_live_passes() -> None:
    passes = [P("a", m="x"), P("dead", r="x", m="d"), P("b", r="x", m="y"), P("c", r="y", m="z"),
              P("late", r="x", m="w")]  # fmt: skip
    result, order = plan(passes, kept="z")
    table = passes[0].table
    assert order == "a b c"
    assert [[table[i] for i in born] for born in result.births] == [["x"], ["y"], ["z"]]
    assert [[table[i] for i in dead] for dead in result.deaths] == [[], ["x"], ["y"]]


@st.composite
def single_writer_graphs(draw: st.DrawFn) -> list[P]:
    """Pass i makes resource i from some of the earlier ones."""
    count = draw(st.integers(1, 12))
    letters = "abcdefghijkl"
    return [
        P(letters[i], r="".join(draw(st.sets(st.sampled_from(letters[:i])))) if i else "",
          m=letters[i])
        for i in range(count)
    ]  # fmt: skip


@given(single_writer_graphs(), st.randoms(use_true_random=False), st.data())
def test_order_comes_from_dependencies_alone(
    passes: list[P], shuffler: random.Random, data: st.DataObject
) -> None:
    """However the passes are declared, producers precede consumers and the same ones run."""
    kept = data.draw(st.sampled_from([p.name for p in passes]))
    wanted, todo = set(), [kept]
    while todo:
        name = todo.pop()
        if name not in wanted:
            wanted.add(name)
            todo += next(p.r for p in passes if p.name == name)
    shuffled = list(passes)
    shuffler.shuffle(shuffled)
    result, order = plan(shuffled, kept=kept)
    names = order.split()
    assert set(names) == wanted
    for i, index in enumerate(result.order):
        assert set(shuffled[index].r) <= set(names[:i])
    for resource in wanted:
        index = shuffled[0].table.index(resource)
        born = next(i for i, b in enumerate(result.births) if index in b)
        dead = next((i for i, d in enumerate(result.deaths) if index in d), len(names))
        users = [i for i, n in enumerate(names) if n == resource or
                 resource in next(p.r for p in passes if p.name == n)]  # fmt: skip
        assert born == min(users)
        assert dead == (len(names) if resource == kept else max(users))


class Resource:
    """Hazard state of a physical resource."""

    def __init__(self) -> None:
        self.written_at = self.unordered_at = self.ordered_at = 0


FETCH, IMAGE, STORAGE = (
    c.TEXTURE_FETCH_BARRIER,
    c.SHADER_IMAGE_ACCESS_BARRIER,
    c.SHADER_STORAGE_BARRIER,
)


@pytest.mark.parametrize(
    "bit",
    [FETCH, IMAGE, STORAGE, c.UNIFORM_BARRIER, c.COMMAND_BARRIER, c.VERTEX_ATTRIB_ARRAY_BARRIER,
     c.ELEMENT_ARRAY_BARRIER, c.FRAMEBUFFER_BARRIER, c.BUFFER_UPDATE_BARRIER],
)  # fmt: skip
def test_read_after_shader_write_needs_the_bit_of_the_read_once(bit: int) -> None:
    hazards, x = Hazards(), Resource()
    assert hazards.barrier_before([(x, STORAGE, True)]) == 0
    assert hazards.barrier_before([(x, bit, False)]) == bit
    assert hazards.barrier_before([(x, bit, False)]) == 0


def test_write_after_read_and_write_after_write() -> None:
    hazards, x = Hazards(), Resource()
    hazards.barrier_before([(x, FETCH, False)])
    assert hazards.barrier_before([(x, IMAGE, True)]) == IMAGE
    assert hazards.barrier_before([(x, IMAGE, True)]) == IMAGE


def test_a_shader_write_waits_for_earlier_rendering() -> None:
    hazards, x = Hazards(), Resource()
    hazards.barrier_before([(x, c.FRAMEBUFFER_BARRIER, False)])
    assert hazards.barrier_before([(x, IMAGE, True)]) == IMAGE


def test_rendering_then_sampling_needs_nothing() -> None:
    hazards, x = Hazards(), Resource()
    hazards.barrier_before([(x, c.FRAMEBUFFER_BARRIER, False)])
    assert hazards.barrier_before([(x, FETCH, False)]) == 0


def test_a_shader_write_waits_for_an_upload() -> None:
    hazards, x = Hazards(), Resource()
    hazards.barrier_before([(x, IMAGE, True)])
    assert hazards.barrier_before([(x, IMAGE, True)]) == IMAGE
    hazards.touched(x)
    assert hazards.barrier_before([(x, STORAGE, True)]) == STORAGE
    hazards.touched(x)
    assert hazards.barrier_before([(x, STORAGE, True)]) == STORAGE


def test_one_barrier_serves_all_resources_written_before_it() -> None:
    hazards, x, y = Hazards(), Resource(), Resource()
    hazards.barrier_before([(x, IMAGE, True), (y, STORAGE, True)])
    assert hazards.barrier_before([(x, FETCH, False)]) == FETCH
    assert hazards.barrier_before([(y, FETCH, False)]) == 0
    assert hazards.barrier_before([(y, STORAGE, False)]) == STORAGE


def test_a_write_after_the_barrier_needs_a_new_one() -> None:
    hazards, x = Hazards(), Resource()
    for _ in range(3):
        hazards.barrier_before([(x, STORAGE, True)])
        assert hazards.barrier_before([(x, c.COMMAND_BARRIER, False)]) == c.COMMAND_BARRIER


def test_unordered_writes_wait_for_readers_not_for_each_other() -> None:
    hazards, x = Hazards(), Resource()
    assert hazards.barrier_before([(x, STORAGE, UNORDERED)]) == 0
    assert hazards.barrier_before([(x, STORAGE, UNORDERED)]) == 0
    assert hazards.barrier_before([(x, STORAGE, False)]) == STORAGE
    assert hazards.barrier_before([(x, STORAGE, UNORDERED)]) == STORAGE
    assert hazards.barrier_before([(x, STORAGE, True)]) == STORAGE
    assert hazards.barrier_before([(x, STORAGE, UNORDERED)]) == STORAGE


accesses = st.tuples(
    st.integers(0, 2),
    st.sampled_from([FETCH, IMAGE, STORAGE, 0x400]),
    st.sampled_from([0, 1, UNORDERED]),
)


@given(st.lists(st.lists(accesses, min_size=1, max_size=3, unique_by=lambda a: a[0]), max_size=12))
def test_barriers_match_a_naive_model(passes: list[list[tuple[int, int, int]]]) -> None:
    """Between two conflicting accesses the later one's bit is issued, and only then."""
    hazards, resources = Hazards(), [Resource() for _ in range(3)]
    issued: list[int] = []
    done: list[list[tuple[int, int, int]]] = []
    for current in passes:
        current = [(r, b, w if b in (IMAGE, STORAGE) else 0) for r, b, w in current]  # noqa: PLW2901
        need = 0
        for resource, bit, write in current:
            for earlier in range(len(done)):
                for other, _, other_write in done[earlier]:
                    conflict = other == resource and (other_write or write)
                    conflict = bool(conflict) and not other_write == write == UNORDERED
                    if conflict and not any(bits & bit for bits in issued[earlier + 1 :]):
                        need |= bit
        got = hazards.barrier_before([(resources[r], b, w) for r, b, w in current])
        assert got == need
        issued.append(got)
        done.append(current)
