# PP-11
"""Broken and hostile clients neither crash nor stall anything, nor write what they may not."""

from __future__ import annotations

import json
import socket
import threading
import time
from typing import Any
from urllib.parse import quote

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from elemental.core.errors import InputError
from elemental.remote import http
from elemental.remote.rate_limit import HostLimits
from elemental.remote.server import LOOPBACK, MAX_CONNECTIONS, Remote
from elemental.scene.volumes import Volume
from unit.remote.client import TIMEOUT_S, Rig


@pytest.mark.parametrize(
    ("raw", "status"),
    [
        (b"GET /volumes HTTP/1.1\r\nX: " + b"y" * 9000 + b"\r\n\r\n", 431),
        (b"PUT /volumes/cellar/weight HTTP/1.1\r\nContent-Length: 5000\r\n\r\n" + b"1" * 5000, 413),
        (b"PUT /a HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n", 400),
        (b"PUT /a HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400),
        (b"PUT /a HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400),
        (b"PUT /a HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n1\r\n1\r\n0\r\n\r\n", 411),
        (b"GET /volumes\r\n\r\n", 400),
        (b"GET http://x/ HTTP/1.1\r\n\r\n", 400),
        (b"\x16\x03\x01\x02\x00\r\n\r\n", 400),
        (b"\r\n\r\n", 400),
        (b"GET /volumes HTTP/1.1\r\na:" + b" " * 8000 + b"\n\r\n\r\n", 400),  # no slow match
    ],
)
def test_requests_that_are_none_are_told_so_and_cut(shared: Rig, raw: bytes, status: int) -> None:
    answer = shared.send(raw)
    assert answer.startswith(f"HTTP/1.1 {status} ".encode())
    assert answer.count(b"Cache-Control") == 1


METHODS = st.one_of(st.sampled_from(["GET", "PUT", "POST", "get", ""]), st.text(max_size=4))
PATHS = st.one_of(
    st.sampled_from(["", "/cellar", "/cellar/weight", "/cellar/exposure"]).map("/volumes".__add__),
    st.text(max_size=30).map(lambda text: f"/volumes/{quote(text, safe='')}/weight"),
    st.text(max_size=40),
)
JSON = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=20)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=8,
)


def unrelated(volumes: list[Volume]) -> list[Volume]:
    """What no request may change, whatever it says."""
    return [Volume(v.name, v.shape, v.center, v.rotation_deg, v.size, v.radius) for v in volumes]


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(METHODS, PATHS, st.one_of(JSON.map(json.dumps), st.text(max_size=50)), st.booleans())
def test_any_request_is_answered_and_writes_only_checked_values(
    shared: Rig, method: str, path: str, body: str, knows: bool
) -> None:
    shared.reset()
    before = list(shared.frame())
    token = shared.remote.token if knows else "guess"
    content = body.encode("utf-8", "surrogatepass")
    headers = f"Authorization: Bearer {token}\r\nContent-Length: {len(content)}\r\n\r\n"
    head = f"{method} {path} HTTP/1.1\r\n{headers}".encode("utf-8", "surrogatepass")
    answer = shared.send(head + content)
    after = shared.frame()
    accepted = answer.startswith(b"HTTP/1.1 200 ")
    assert accepted or answer.startswith((b"HTTP/1.1 4", b"")), answer
    assert unrelated(after) == unrelated(before)
    if not (accepted and knows and method == "PUT"):
        assert after == before
    for volume in after:
        assert 0.0 <= volume.blend_weight <= 1.0
        assert -16.0 <= volume.overrides.get("exposure", 0.0) <= 16.0
    assert shared.remote.faults == 0


@settings(max_examples=300, deadline=None)
@given(st.one_of(st.binary(max_size=300), st.lists(st.binary(max_size=20)).map(b"\r\n".join)))
def test_any_bytes_leave_the_server_at_work(shared: Rig, raw: bytes) -> None:
    before = list(shared.frame())
    answer = shared.send(raw + b"\r\n\r\n")
    assert answer == b"" or answer.startswith(b"HTTP/1.1 4")
    assert shared.frame() == before
    assert shared.remote.faults == 0


def test_the_server_serves_again_after_all_that(shared: Rig) -> None:
    assert shared.put("/volumes/cellar/weight", 0.125)[0] == 200
    assert shared.frame()[0].blend_weight == 0.125


def test_idle_clients_do_not_keep_others_out(monkeypatch: pytest.MonkeyPatch, rig: Rig) -> None:
    monkeypatch.setattr(http, "REQUEST_S", 0.3)
    idle = [socket.create_connection(rig.address, TIMEOUT_S) for _ in range(2 * MAX_CONNECTIONS)]
    for number, connection in enumerate(idle):
        connection.sendall(b"PUT /volumes/cellar/weight HTTP/1.1\r\n"[: number % 30])
    assert rig.put("/volumes/cellar/weight", 0.5)[0] == 200
    for connection in idle:
        connection.close()
    assert rig.frame()[0].blend_weight == 0.5


def test_clients_without_pause_are_slowed_and_frames_are_not(rig: Rig) -> None:
    ends, served = threading.Event(), [0] * 8

    def flood(number: int) -> None:
        connection = rig.connection()
        headers = {"Authorization": f"Bearer {rig.remote.token}"}
        while not ends.is_set():
            connection.request("GET", "/volumes", headers=headers)
            connection.getresponse().read()
            served[number] += 1
        connection.close()

    threads = [threading.Thread(target=flood, args=(number,)) for number in range(len(served))]
    for thread in threads:
        thread.start()
    began, longest = time.monotonic(), 0.0
    while time.monotonic() - began < 1.5:
        before = time.monotonic()
        rig.frame()
        longest = max(longest, time.monotonic() - before)
        time.sleep(0.005)
    ends.set()
    for thread in threads:
        thread.join()
    elapsed = time.monotonic() - began
    assert 0 < sum(served) <= 50 + 200 * elapsed + len(served)
    assert longest < 0.25  # generous: other work shares the machine


def test_a_flood_without_the_token_does_not_keep_its_owner_out(rig: Rig) -> None:
    """Many connections, each with more requests than are answered in a while."""
    crowd = [socket.create_connection(rig.address, TIMEOUT_S) for _ in range(3 * MAX_CONNECTIONS)]
    for connection in crowd:
        connection.sendall(b"GET /volumes HTTP/1.1\r\n\r\n" * 60)
    began = time.monotonic()
    for number in range(5):
        assert rig.put("/volumes/cellar/weight", number / 8)[0] == 200
    assert time.monotonic() - began < 2.0  # generous: 1/200 s would do
    assert rig.frame()[0].blend_weight == 0.5
    for connection in crowd:
        connection.close()


def test_strangers_are_refused_in_so_many_words_only_now_and_then(rig: Rig) -> None:
    refused = [rig.send(b"GET /volumes HTTP/1.1\r\n\r\n") for _ in range(100)]
    told = sum(answer.startswith(b"HTTP/1.1 401 ") for answer in refused)
    assert 1 <= told < 60
    assert set(refused[-20:]) & {b""}
    assert rig.put("/volumes/cellar/weight", 0.5)[0] == 200


def test_those_who_arrive_at_once_are_no_more_than_the_limit(rig: Rig) -> None:
    """Accepting them waits for nothing but those who make room."""
    remote, counts = rig.remote, []
    stands, goes_on = threading.Event(), threading.Event()

    class Watched(dict[Any, Any]):
        def __setitem__(self, key: Any, value: Any) -> None:
            super().__setitem__(key, value)
            counts.append(len(self))

    def stand_still() -> None:
        remote._peers = Watched(remote._peers)
        stands.set()
        goes_on.wait(TIMEOUT_S)

    remote._loop.call_soon_threadsafe(stand_still)
    assert stands.wait(TIMEOUT_S)
    crowd = [socket.create_connection(rig.address, TIMEOUT_S) for _ in range(3 * MAX_CONNECTIONS)]
    goes_on.set()
    assert rig.put("/volumes/cellar/weight", 0.5)[0] == 200
    assert len(counts) > len(crowd)
    assert max(counts) == MAX_CONNECTIONS
    for connection in crowd:
        connection.close()


def test_who_knows_the_token_is_not_cut_for_newer_ones(rig: Rig) -> None:
    connection = rig.connection()
    headers = {"Authorization": f"Bearer {rig.remote.token}"}
    connection.request("GET", "/volumes", headers=headers)
    connection.getresponse().read()
    crowd = [socket.create_connection(rig.address, TIMEOUT_S) for _ in range(3 * MAX_CONNECTIONS)]
    assert rig.put("/volumes/cellar/weight", 0.5)[0] == 200
    connection.request("GET", "/volumes", headers=headers)
    assert connection.getresponse().status == 200
    connection.close()
    for other in crowd:
        other.close()


def test_each_client_has_its_own_limit_and_few_are_kept() -> None:
    limits = HostLimits(rate=1.0, burst=2.0, most=8)
    assert [limits.of("a").take() for _ in range(4)] == [True, True, False, False]
    assert limits.of("b").take()
    for number in range(100):
        assert limits.of(f"c{number}").take()
    assert len(limits) == 8


def test_only_loopback_is_listened_on(rig: Rig) -> None:
    assert rig.address[0] == "127.0.0.1"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends nothing; finds the address of another interface
        except OSError:
            pytest.skip("no other interface")
        other = probe.getsockname()[0]
    if other.startswith("127."):
        pytest.skip("no other interface")
    with pytest.raises(OSError, match="refused"):
        socket.create_connection((other, rig.address[1]), 5.0)


def test_what_can_t_be_listened_on_is_told(rig: Rig) -> None:
    with pytest.raises(InputError, match=r"--remote: .* can't be listened on"):
        Remote(LOOPBACK, rig.address[1], None)
    with pytest.raises(InputError, match=r"--remote-host: example\.org: is not an IP address"):
        Remote("example.org", 0, None)


def test_a_release_ends_the_thread_with_clients_connected() -> None:
    rig = Rig()
    address = rig.address
    connection = socket.create_connection(address, TIMEOUT_S)
    before = threading.active_count()
    rig.remote.release()
    assert threading.active_count() == before - 1
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(address, 5.0)
    connection.close()
