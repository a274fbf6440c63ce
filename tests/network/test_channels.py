"""Datagrams through real sockets and memory: whole, in order, lost and doubled as said; never waiting."""

import os
import subprocess
import sys
import time
import uuid
from itertools import pairwise

import pytest
from free_channels import free_ports
from network.tube import Tube

from zwidth.errors import InputError
from zwidth.links import Schedule
from zwidth.machine.network import UDP, Lossy, SharedMemory, Zenoh, open_channel
from zwidth.machine.network.channel import LARGEST


def udp_pair():
    here, there = (f"127.0.0.1:{port}" for port in free_ports(2))
    return UDP(here, there), UDP(there, here)


def memory_pair():
    name = uuid.uuid4().hex
    return SharedMemory(name, True), SharedMemory(name, False)


def zenoh_pair():
    pytest.importorskip("zenoh", reason="Eclipse Zenoh is not installed")
    name, (port,) = f"test/{uuid.uuid4().hex}", free_ports(1)
    first = Zenoh(name, True, listen=[f"udp/127.0.0.1:{port}"])
    return first, Zenoh(name, False, connect=[f"udp/127.0.0.1:{port}"])


def arrived(channel, wanted, tries=60_000):
    """What comes until the wanted number is there; the wait is a bound, not a measure."""
    found = []
    for _ in range(tries):
        found += channel.receive()
        if len(found) >= wanted:
            break
        time.sleep(0.001)
    return found


def sent_until_it_came(a, b, datagram):
    """What comes besides is older: a datagram that was sent twice, since it was slow to come."""
    for _ in range(400):
        a.send(datagram)
        if datagram in arrived(b, 1, 50):
            return [datagram]
    return []


@pytest.mark.parametrize("pair", [udp_pair, memory_pair, zenoh_pair])
def test_datagrams_come_whole_and_in_order_both_ways(pair):
    first, second = pair()
    with first, second:
        for a, b in ((first, second), (second, first)):
            assert b.receive() == []
            while not arrived(b, 1, 5):  # until both sides know of each other
                a.send(b"hello")
            arrived(b, 10**6, 20)
            given = [bytes([k]) * (1 + 7 * k) for k in range(100)]
            if pair is zenoh_pair:  # which drops what a busy machine cannot take at once
                came = [one for datagram in given for one in sent_until_it_came(a, b, datagram)]
                assert came == given
                continue
            for datagram in given:
                a.send(datagram)
            assert arrived(b, 100) == given
        assert sent_until_it_came(first, second, b"x" * LARGEST) == [b"x" * LARGEST]


@pytest.mark.parametrize("pair", [udp_pair, memory_pair, zenoh_pair])
def test_a_side_that_is_gone_costs_nothing_but_its_datagrams(pair):
    first, second = pair()
    second.close()
    second.close()
    for _ in range(600):
        first.send(b"nobody")
        assert first.receive() == []
    first.close()


def test_udp_reads_nothing_of_a_stranger():
    here, there, other = (f"127.0.0.1:{port}" for port in free_ports(3))
    with UDP(here, there) as a, UDP(there, here) as b, UDP(other, here) as stranger:
        stranger.send(b"not for you")
        b.send(b"for you")
        assert arrived(a, 1) == [b"for you"]


def test_memory_of_one_that_was_killed_is_taken_over_and_one_in_use_is_not():
    name = uuid.uuid4().hex
    code = f"""
import os
from zwidth.machine.network import SharedMemory
memory = SharedMemory({name!r}, True)
memory.send(b"last words")
os._exit(9)
"""
    subprocess.run([sys.executable, "-c", code], check=False)
    with SharedMemory(name, True) as first, SharedMemory(name, False) as second:
        assert second.receive() == []
        with pytest.raises(InputError, match="another process may use it"):
            SharedMemory(name, True)
        first.send(b"new")
        assert second.receive() == [b"new"]


@pytest.mark.skipif(os.name != "posix", reason="there are no such modes")
def test_memory_that_others_may_have_laid_there_is_not_used(tmp_path, monkeypatch):
    """By either side: open to others, of two names, a link, a folder, of another user; it stays as it was."""
    monkeypatch.setattr("zwidth.machine.network.carriers._place", tmp_path.joinpath)

    for name, mode in {"640": 0o640, "604": 0o604, "602": 0o602, "two": 0o600, "mine": 0o600}.items():
        (tmp_path / name).touch()
        (tmp_path / name).chmod(mode)
    os.link(tmp_path / "two", tmp_path / "names")
    os.symlink(tmp_path / "nothing", tmp_path / "astray")
    os.symlink(tmp_path / "mine", tmp_path / "link")
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe", 0o600)
    before = sorted((each.name, each.lstat().st_size) for each in tmp_path.iterdir())
    for name in ("640", "604", "602", "two", "names", "astray", "link", "folder", "pipe"):
        for first in (True, False):
            with pytest.raises(InputError, match="shared memory"):
                SharedMemory(name, first)
    with monkeypatch.context() as patch:
        patch.setattr("os.getuid", lambda: os.stat(tmp_path).st_uid + 1)
        for first in (True, False):
            with pytest.raises(InputError, match="belongs to another user"):
                SharedMemory("mine", first)
    assert sorted((each.name, each.lstat().st_size) for each in tmp_path.iterdir()) == before
    SharedMemory("mine", True).close()


def test_a_reader_a_ring_behind_loses_the_oldest():
    first, second = memory_pair()
    with first, second:
        for k in range(1000):
            first.send(str(k).encode())
        assert second.receive() == [str(k).encode() for k in range(744, 1000)]


def test_what_memory_tears_is_dropped():
    """A writer as fast as it can against a reader: what comes out is what went in."""
    name = uuid.uuid4().hex
    code = f"""
import sys
from zwidth.machine.network import SharedMemory
with SharedMemory({name!r}, False) as memory:
    for k in range(20000):
        memory.send(str(k).encode() * 100)
"""
    with SharedMemory(name, True) as memory:
        writer = subprocess.Popen([sys.executable, "-c", code])
        last, torn = -1, 0
        while writer.poll() is None or last < 0:
            for datagram in memory.receive():
                size = len(datagram) // 100
                if datagram[:size] * 100 != datagram:
                    torn += 1
                    continue
                number = int(datagram[:size])
                assert number > last
                last = number
        assert writer.returncode == 0
        assert torn == 0


def test_a_lossy_channel_does_what_it_says():
    now = [0.0]
    bad = Schedule(delay=0.01, jitter=0.005, loss=0.3, burst=3, duplicates=0.1)
    waiting = []  # what is sent comes back
    channel = Lossy(Tube(waiting, waiting), bad, clock=lambda: now[0])
    came, order = {}, []
    for k in range(20_000):
        now[0] = 0.001 * k
        channel.send(k.to_bytes(4, "big"))
        for datagram in channel.receive():
            order.append(int.from_bytes(datagram, "big"))
            came.setdefault(order[-1], []).append(now[0])
    ages = [t - 0.001 * k for k, times in came.items() for t in times]
    assert len(came) / 20_000 == pytest.approx(0.7, abs=0.02)
    assert sum(len(t) > 1 for t in came.values()) / len(came) == pytest.approx(0.1, abs=0.01)
    assert 0.01 <= min(ages) <= max(ages) <= 0.016 + 1e-9
    assert order != sorted(order)
    gaps = [b - a - 1 for a, b in pairwise(sorted(came)) if b - a > 1]
    assert sum(gaps) / len(gaps) == pytest.approx(3, abs=0.2)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: UDP("nowhere", "127.0.0.1:1"), "must be host:port"),
        (lambda: UDP("127.0.0.1:70000", "127.0.0.1:1"), "port from 0 to 65535"),
        (lambda: UDP("192.0.2.1:0", "127.0.0.1:1"), "give an address of this machine"),
        (lambda: SharedMemory("../etc", True), "letters, digits"),
        (lambda: SharedMemory(uuid.uuid4().hex, False), "start the first side"),
        (lambda: open_channel("tcp:1", True), "no channel is called"),
        (lambda: open_channel("udp:127.0.0.1:1", True), "no channel is called"),
        (lambda: open_channel("zenoh:a,", True), "no channel is called"),
    ],
)
def test_what_is_no_channel_is_refused(make, said):
    with pytest.raises(InputError, match=said):
        make()


def test_a_line_of_text_opens_both_ends():
    here, there = (f"127.0.0.1:{port}" for port in free_ports(2))
    for text in (f"udp:{here},{there}", f"memory:{uuid.uuid4().hex}"):
        with open_channel(text, True) as first, open_channel(text, False) as second:
            first.send(b"to the second")
            second.send(b"to the first")
            assert arrived(second, 1) == [b"to the second"]
            assert arrived(first, 1) == [b"to the first"]
