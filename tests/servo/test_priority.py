"""What a loop asks of the system: it is told what it was granted, and gives everything back."""

import ctypes
import mmap
import os
import pathlib
import sys
import threading

import pytest

from zwidth.errors import InputError
from zwidth.machine.servo import priority
from zwidth.machine.servo.priority import RealTime

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asked for on Linux only")


def _state():
    with open("/proc/self/status", encoding="utf-8") as told:
        locked = next(line for line in told if line.startswith("VmLck"))
    slack = ctypes.CDLL(None).prctl(30, 0, 0, 0, 0)
    policy = os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
    return policy, os.sched_getparam(0).sched_priority, os.sched_getaffinity(0), slack, locked


def _in_a_thread(work):
    """What work() gives in a thread of its own, whose state nobody else needs."""
    found = []
    thread = threading.Thread(target=lambda: found.append(work()))
    thread.start()
    thread.join()
    return found[0]


@linux
def test_all_is_as_it_was_afterwards():
    core = max(os.sched_getaffinity(0))

    def work():
        before = _state()
        with RealTime(priority=11, core=core) as granted:
            inside = _state()
        return before, granted, inside, _state()

    before, granted, inside, after = _in_a_thread(work)
    assert after == before
    assert ("priority" in granted) == (inside[:2] == (os.SCHED_FIFO, 11))
    assert ("one core" in granted) == (inside[2] == {core})
    assert ("timers" in granted) == (inside[3] in (0, 1))  # 0 of a real-time thread, in newer kernels
    assert ("memory" in granted) == (inside[4] != before[4])


@linux
def test_what_is_only_reserved_takes_no_memory():
    """Stacks and the buffers of linear algebra are; what is touched stays, and the code is there before."""

    def there(belongs):
        """How much of the one mapping that belongs is in memory, and of how much [KiB]; all of it locked."""
        told = {}
        for line in pathlib.Path("/proc/self/smaps").read_text(encoding="utf-8").splitlines():
            name, *words = line.split()
            if "-" in name:
                of = belongs(*(int(end, 16) for end in name.split("-")), line)
            elif of:
                told[name] = words
        assert "lo" in told["VmFlags:"]
        return int(told["Rss:"][0]), int(told["Size:"][0])

    def work():
        reserved = mmap.mmap(-1, 64 * 2**20)
        place = ctypes.addressof(ctypes.c_char.from_buffer(reserved))
        with RealTime(priority=0) as granted:
            if "memory" not in granted:
                return None
            before, _ = there(lambda start, end, line: start <= place < end)
            reserved[: 2**20] = b"x" * 2**20
            after, _ = there(lambda start, end, line: start <= place < end)
            return before, after, there(lambda start, end, line: "r-xp" in line and "/libc." in line)

    found = _in_a_thread(work)
    if found is None:
        pytest.skip("no memory is locked for this user")
    before, after, (code, whole) = found
    assert (before, after) == (0, 1024)
    assert code == whole


@linux
def test_a_refusal_says_what_would_help(monkeypatch):
    """A user without the limits is told which to ask for; the rest is granted all the same."""

    def refuse(*_):
        raise PermissionError(1, "not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(priority, "memory_limit", lambda: 8 * 2**20)
    granted = _in_a_thread(lambda: RealTime(priority=40).__enter__())
    assert [wish in granted for wish in ("priority", "memory", "timers")] == [False, False, True]
    assert '"rtprio 40"' in granted["priority"].told
    assert "8 MiB" in granted["memory"].told
    assert "memlock unlimited" in granted["memory"].told
    told = granted.to_dict()
    assert (told["priority"]["granted"], told["timers"]["granted"]) == (False, True)
    assert "priority: not granted: SCHED_FIFO 40" in repr(granted)


@linux
def test_memory_of_a_limited_user_is_never_locked(monkeypatch):
    """What came after the limit would be refused, in the middle of a touch."""
    import resource

    monkeypatch.setattr(priority, "_may", lambda capability: False)
    monkeypatch.setattr(resource, "getrlimit", lambda which: (64 * 2**20, 64 * 2**20))
    assert priority.memory_limit() == 64 * 2**20
    monkeypatch.setattr(resource, "getrlimit", lambda which: (resource.RLIM_INFINITY, 0))
    assert priority.memory_limit() is None


def test_an_ordinary_thread_asks_for_no_priority():
    with RealTime(priority=0, memory=False) as granted:
        assert {answer.wish for answer in granted.answers} == {"timers", "awake cores"}


def test_elsewhere_than_on_linux_nothing_is_granted(monkeypatch):
    monkeypatch.setattr(priority, "_LINUX", False)
    with RealTime() as granted:
        assert len(granted.answers) == 4
        assert not any(answer.granted for answer in granted.answers)
        assert all("Linux" in answer.told for answer in granted.answers)


@pytest.mark.parametrize("wrong", [100, -1, True, 2.5])
def test_a_priority_outside_its_range_is_refused(wrong):
    with pytest.raises(InputError, match="from 1 to 99"):
        RealTime(priority=wrong)


@linux
def test_a_core_that_is_not_there_is_refused():
    most = max(os.sched_getaffinity(0))
    with pytest.raises(InputError, match=f"core {most + 1} .*{most}"):
        RealTime(core=most + 1)
