"""What a loop asks of the system so that it is woken in time, and what it was granted.

Real-time priority: the thread runs before every ordinary one, as soon as it is awake (SCHED_FIFO).  Locked
memory: what the process has touched, and the code that a loop calls, stays in memory (mlockall, mlock); what
is reserved alone, as the stacks of threads are and tens of MiB for each core by a library of linear algebra,
takes none.  Exact timers: Linux lets
the timer of an ordinary thread come up to 50 µs late, to wake several at once; the thread asks for 1 ns.
Awake cores: a core that sleeps deeply takes up to some hundred µs to come back; whoever holds
/dev/cpu_dma_latency open with a zero in it forbids that.  What is refused makes the loop later, never wrong:
it runs all the same, and says so.  Sources: the manual pages sched(7), mlock(2), prctl(2); the kernel's
pm_qos_interface.rst.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown

PRIORITY = 40
"""Below 50, which is that of the threads that serve interrupts in a PREEMPT_RT kernel: a loop that waits
awake for the answer of a USB port must not keep the port's own thread from running."""

_LINUX = sys.platform.startswith("linux")
_MCL_CURRENT, _MCL_FUTURE, _MCL_ONFAULT = 1, 2, 4
_CALLED = ("steps.", "python", "libpython", "libc.", "libm.", "ld-")
"""How the files begin whose code a loop runs in: the step functions, Python, the C library."""

_PR_SET_TIMERSLACK, _PR_GET_TIMERSLACK = 29, 30
_CAP_IPC_LOCK = 14
_NO_IDLE = Path("/dev/cpu_dma_latency")

_NOT_HERE = "zwidth asks for it on Linux only"


@dataclass(frozen=True)
class Answer:
    """What became of one wish."""

    wish: str
    granted: bool
    told: str
    """What was granted, or why it was not and what would help."""


@dataclass(frozen=True, repr=False)
class Granted(Shown):
    """What became of all that was asked for."""

    answers: tuple[Answer, ...]

    def __getitem__(self, wish: str) -> Answer:
        """Of one wish: "priority", "memory", "timers", "awake cores", "one core"."""
        return next(answer for answer in self.answers if answer.wish == wish)

    def __contains__(self, wish: object) -> bool:
        """Whether it was asked for, and granted."""
        return any(answer.wish == wish and answer.granted for answer in self.answers)

    def to_dict(self) -> dict[str, Any]:
        """By wish: granted, and in words what or why not."""
        return {a.wish.replace(" ", "_"): {"granted": a.granted, "told": a.told} for a in self.answers}

    def report(self) -> Iterable[Part]:
        """A line for each."""
        for answer in self.answers:
            yield f"{answer.wish}: {'' if answer.granted else 'not granted: '}{answer.told}"


class RealTime:
    """While it is entered, the thread that entered it is one for a loop with deadlines.

    ``with RealTime() as granted: …`` in the loop's own thread, before the first step.  On leaving, all is as
    it was before.

    Parameters
    ----------
    priority
        Of SCHED_FIFO, 1 to 99; 0 leaves the thread an ordinary one.
    memory
        Whether to lock the memory of the process; that is of the whole process.
    core
        Number of the core that the thread keeps to; None for any.

    Raises
    ------
    InputError
        If the priority is none, or this machine has no such core.
    """

    def __init__(self, *, priority: int = PRIORITY, memory: bool = True, core: int | None = None) -> None:
        if isinstance(priority, bool) or not isinstance(priority, int) or not 0 <= priority <= 99:
            raise InputError(f"priority is a whole number from 1 to 99, or 0 for none, got {priority!r}")
        if core is not None and _LINUX and core not in os.sched_getaffinity(0):
            known = ", ".join(map(str, sorted(os.sched_getaffinity(0))))
            raise InputError(f"there is no core {core!r} that this process may run on; there are: {known}")
        self._priority, self._memory, self._core = priority, memory, core
        self._undo: list[Callable[[], None]] = []

    def __enter__(self) -> Granted:
        """Ask for everything, and say what was granted."""
        wishes = {
            "timers": self._timers,
            "awake cores": self._awake_cores,
            **({"memory": self._lock} if self._memory else {}),
            **({"one core": self._keep_to_core} if self._core is not None else {}),
            **({"priority": self._first} if self._priority else {}),
        }
        if not _LINUX:
            return Granted(tuple(Answer(wish, False, _NOT_HERE) for wish in wishes))
        return Granted(tuple(Answer(wish, *ask()) for wish, ask in wishes.items()))

    def __exit__(
        self, kind: type[BaseException] | None, raised: BaseException | None, where: TracebackType | None
    ) -> None:
        """Give everything back, in the other order."""
        while self._undo:
            with suppress(OSError):
                self._undo.pop()()

    def _timers(self) -> tuple[bool, str]:
        library = _library()
        before = library.prctl(_PR_GET_TIMERSLACK, 0, 0, 0, 0)
        if before < 0 or library.prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0):
            return False, "the kernel does not take it"
        self._undo.append(lambda: library.prctl(_PR_SET_TIMERSLACK, before, 0, 0, 0))
        return True, f"come within 1 ns, before within {shown(1e-9 * before, 's', 6)}"

    def _awake_cores(self) -> tuple[bool, str]:
        try:
            held = os.open(_NO_IDLE, os.O_WRONLY)
        except OSError as error:
            return False, f"{_NO_IDLE}: {error.strerror}; who may write it can keep the cores awake"
        self._undo.append(lambda: os.close(held))
        try:
            os.write(held, struct.pack("i", 0))
        except OSError as error:
            return False, f"{_NO_IDLE}: {error.strerror}"
        return True, "no core sleeps deeply meanwhile"

    def _lock(self) -> tuple[bool, str]:
        most = memory_limit()
        if most is not None:
            return False, (
                f"this user may lock {most / 2**20:g} MiB, and what came after that would be refused; "
                '"memlock unlimited" in /etc/security/limits.conf'
            )
        library = _library()
        if library.mlockall(_MCL_CURRENT | _MCL_FUTURE | _MCL_ONFAULT):
            return False, os.strerror(ctypes.get_errno())
        self._undo.append(lambda: library.munlockall())
        for start, end in _code():
            library.mlock(ctypes.c_void_p(start), ctypes.c_size_t(end - start))
        return True, "what the process touches, and the code of the loop, stay in memory"

    def _keep_to_core(self) -> tuple[bool, str]:
        before = os.sched_getaffinity(0)
        assert self._core is not None
        try:
            os.sched_setaffinity(0, {self._core})
        except OSError as error:
            return False, f"core {self._core}: {error.strerror}"
        self._undo.append(lambda: os.sched_setaffinity(0, before))
        return True, f"the loop keeps to core {self._core}"

    def _first(self) -> tuple[bool, str]:
        before, was = os.sched_getscheduler(0), os.sched_getparam(0)
        try:
            # threads and processes that it starts are ordinary ones
            policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
            os.sched_setscheduler(0, policy, os.sched_param(self._priority))
        except OSError as error:
            return False, (
                f"SCHED_FIFO {self._priority}: {error.strerror}; "
                f'"rtprio {self._priority}" or more in /etc/security/limits.conf'
            )
        # whoever lacks the privilege may leave the priority, but not that flag
        self._undo.append(lambda: os.sched_setscheduler(0, before | os.SCHED_RESET_ON_FORK, was))
        return True, f"SCHED_FIFO {self._priority}: before every ordinary thread"


def memory_limit() -> int | None:
    """How much memory this process may lock [bytes]; None for as much as there is."""
    import resource

    most, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return None if most == resource.RLIM_INFINITY or _may(_CAP_IPC_LOCK) else most


def _code() -> Iterator[tuple[int, int]]:
    """From where to where the files of `_CALLED` are mapped."""
    for line in Path("/proc/self/maps").read_text(encoding="utf-8", errors="replace").splitlines():
        place, _, path = line.partition(" ")
        if path.rpartition("/")[2].startswith(_CALLED):
            start, end = place.split("-")
            yield int(start, 16), int(end, 16)


def _may(capability: int) -> bool:
    """Whether the process has a capability of Linux, by its number."""
    for line in Path("/proc/self/status").read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("CapEff:"):
            return bool(int(line.split()[1], 16) >> capability & 1)
    return False


def _library() -> Any:
    return ctypes.CDLL(None, use_errno=True)
