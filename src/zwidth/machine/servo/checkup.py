"""Is this machine fit to run the loop: how late it is, what that costs in stiffness, and what to change."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from zwidth.errors import InputError
from zwidth.machine.servo.lateness import Lateness, StiffnessCost, measure_lateness, stiffness_cost
from zwidth.machine.servo.priority import PRIORITY, Granted, memory_limit
from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import Environment
from zwidth.passivity.transmission import as_one_body
from zwidth.progress import progress_bar
from zwidth.quantity.answered import answered
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown
from zwidth.showing import Lines, Part, Table

_DEFAULT_PERIOD = Exact("0.001")
_LEAST_PERIOD = 20e-6
"""Below it the clock and the sleep alone take a good part of the period [s]."""

_FEWEST = 1000
"""Steps, so that one in a thousand is one at least."""

_SHARE = 0.999
"""Of the steps begin within the lateness whose cost is told."""


@dataclass(frozen=True, repr=False)
class Checkup(Documented):
    """How this machine does as the host of a periodic loop."""

    _FORMAT: ClassVar[str] = "zwidth doctor 1"
    _PICTURE: ClassVar[str] = "plot_lateness"

    sample_period: Exact = answered("T of the loop that was run", unit="s")
    ordinary: Lateness = answered("turns without real-time priority")
    real_time: Lateness | None = answered("turns with it; null where it was refused")
    asked: Granted = answered(
        "what a loop asks of the system here, and what became of it: by wish, such as `priority` and "
        "`memory`, whether it was `granted`, and `told`, in words what or why not"
    )
    findings: tuple[Finding, ...] = answered("what makes a loop late here, or does not")
    device: str | None = answered("its name; null without one", default=None)
    cost: StiffnessCost | None = answered(
        "what lateness costs it in stiffness; null without a device", default=None
    )

    @property
    def best(self) -> Lateness:
        """Of the loop as it would be served here: with real-time priority where that is granted."""
        return self.real_time or self.ordinary

    def report(self) -> Iterable[Part]:
        """The lateness of both kinds of turns, what it costs, what was found, what to change."""
        yield from self._late()
        yield Lines([f"{one.about}: {one.told}" for one in self.findings])
        yield from self._to_change()

    def in_short(self) -> Iterable[Part]:
        """The same without what was found."""
        yield from self._late()
        yield from self._to_change()

    def _late(self) -> Iterator[Part]:
        kinds = {"ordinary thread": self.ordinary}
        if self.real_time is not None:
            kinds["real-time priority"] = self.real_time
        heads = [("late by [ms]", "50 %", "99 %", "99.9 %", "worst", "missed", "steps")]
        rows = [(name, *_row(lateness)) for name, lateness in kinds.items()]
        yield f"a loop at {shown(Exact(1 / self.sample_period.fraction), 'Hz')}, without a device"
        yield Table(heads=heads, rows=rows, lefts=1)
        if self.real_time is None:
            yield f"real-time priority was not granted: {self.asked['priority'].told}"
        if self.cost is not None:
            yield f"what the 99.9 % cost {self.device}:"
            yield self.cost.table()

    def _to_change(self) -> Iterator[Part]:
        advice = [f"{one.about}: {one.advice}" for one in self.findings if one.advice]
        yield f"what to change: {'nothing that was found' if not advice else ''}".rstrip()
        yield Lines(advice)


def _row(lateness: Lateness) -> tuple[str, ...]:
    return (*(f"{1e3 * t:.3g}" for t in lateness.shares), str(lateness.missed), str(lateness.steps))


def doctor(
    device: Device | None = None,
    environment: Environment | None = None,
    *,
    duration: RealLike = 60,
    sample_period: RealLike | None = None,
    core: int | None = None,
) -> Checkup:
    """Run a loop that does nothing but be on time, and say how late it was, what that costs, and what helps.

    Parameters
    ----------
    device, environment
        Of which to say what the lateness costs in stiffness; without an environment a spring. With a
        transmission it is of what the motor feels, whatever stands behind it.
    duration
        How long [s]: half of it with real-time priority, where that is granted, in turns of a few seconds.
    sample_period
        T ≥ 20e-6 [s]; by default that of the device, or 1 ms.
    core
        Number of the core that the loop keeps to; None for any.

    Raises
    ------
    InputError
        If the period is too short, the duration shorter than 1000 periods, the law has no stiffness, there is
        no such core, or the system is none of POSIX.
    """
    period = _period(sample_period, device)
    seconds = read_number(duration, GLOSSARY["sample_period"], "duration", bound="> 0", why="0 has no step")
    if seconds.fraction < _FEWEST * period.fraction:
        raise InputError(
            f"duration must be ≥ {shown(Exact(_FEWEST * period.fraction), 's')}, got {shown(seconds, 's')}: "
            f"one step in {_FEWEST} is told, and a period is {shown(period, 's')}"
        )
    law = None
    if device is not None:
        if device.transmission is not None and device.transmission.encoder == "handle":
            raise InputError(
                "what lateness costs is told of the motor's friction, which proves nothing where the encoder "
                "is at the handle: give --rate alone, in Python sample_period"
            )
        device = as_one_body(device.replace(sample_period=period))
        law = environment or Wall(stiffness=1)
        stiffness_cost(device, law, 0.0)  # what it cannot be told of is refused before the wait
    elif environment is not None:
        raise InputError("what lateness costs an environment depends on the device: give one as well")
    before = Moment.now()
    with progress_bar("seconds") as bar:
        measured = measure_lateness(float(period), float(seconds), core=core, progress=bar)
    best = measured.real_time or measured.ordinary
    return Checkup(
        period,
        *measured,
        findings=tuple(findings(measured.asked, before)),
        device=None if device is None else device.name,
        cost=None if law is None or device is None else stiffness_cost(device, law, best.quantile(_SHARE)),
    )


def _period(given: RealLike | None, device: Device | None) -> Exact:
    value = given if given is not None else _DEFAULT_PERIOD
    if given is None and device is not None:
        value = Exact(device.motor_side.exact("sample_period"))
    period: Exact = read_number(
        value, GLOSSARY["sample_period"], "sample_period", bound="> 0", why="a step takes time"
    )
    if period < _LEAST_PERIOD:
        raise InputError(
            f"sample_period must be ≥ {shown(_LEAST_PERIOD, 's')}, got {shown(period, 's')}: to sleep and to "
            "read the clock takes a good part of a shorter one"
        )
    return period


# What the system itself tells: each finding is read from Linux, from the file that it names; what cannot be
# read is said to be unknown, and nothing is inferred.  Sources: the manual pages proc(5), limits.conf(5)
# and the kernel's documentation of cpufreq, cpuidle and the clocksource; the latency timer of FTDI's USB
# ports is that of its application note 232B-04.


_DEEP = 50
"""A core whose deepest sleep takes longer to end makes a loop late [µs]."""

_BUSY = 0.5
"""Runnable tasks for each core from which on a loop has to wait its turn."""

_STOLEN = 0.001
"""Share of the time from which on the host is worth a word."""

_FAST_CLOCKS = ("tsc", "arch_sys_counter", "kvm-clock", "hyperv_clocksource_tsc_page", "riscv_clocksource")
"""Those that are read without a call into the kernel."""


@dataclass(frozen=True)
class Finding:
    """One thing that makes a loop late, or does not."""

    about: str = answered("of what")
    seen: str | None = answered("what was read; null where it cannot be read here")
    advice: str | None = answered("what to change; null where it is well, or unknown", default=None)

    @property
    def told(self) -> str:
        """What was seen, or that it cannot be."""
        return "cannot be read here" if self.seen is None else self.seen


@dataclass(frozen=True)
class Moment:
    """What the system tells of a moment, in proc(5) /proc/stat and /proc/loadavg; None where it does not."""

    total: int | None
    """Ticks that have passed, of all cores."""
    stolen: int | None
    """Those that the host took."""
    load: float | None
    """Tasks that ran or waited for a core, over the last minute."""

    @classmethod
    def now(cls, root: Path = Path("/")) -> Moment:
        """As of now."""
        words = (_read(root / "proc/stat") or "").partition("\n")[0].split()
        ticks = [int(word) for word in words[1:9]] if words[:1] == ["cpu"] and len(words) > 8 else []
        load = (_read(root / "proc/loadavg") or "").split()
        return cls(
            sum(ticks) if ticks else None, ticks[7] if ticks else None, float(load[0]) if load else None
        )


def findings(granted: Granted, before: Moment, root: Path = Path("/")) -> list[Finding]:
    """What there is to say about this machine, from what a loop with real-time priority was granted.

    The load `before` the measurement, and what the host took since, are told.
    """
    told = {
        "kernel": _kernel(root),
        "real-time priority": _priority(granted),
        "memory": _memory(granted, root),
        "frequency of the cores": _governor(root),
        "sleep of the cores": _sleep(granted, root),
        "USB serial ports": _usb(root),
        "virtual machine": _virtual(root, before),
        "load": _load(root, before),
        "clock": _clock(root),
    }
    return [Finding(about, *seen) for about, seen in told.items()]


Seen = tuple[str | None, str | None]
"""What was read, and what to change, as of `Finding`."""


def _read(path: Path) -> str | None:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return None


def _all(root: Path, pattern: str) -> Iterator[tuple[Path, str]]:
    """Every file of a pattern that can be read, and its text."""
    for path in sorted(root.glob(pattern)):
        text = _read(path)
        if text is not None:
            yield path, text


def _kernel(root: Path) -> Seen:
    version = _read(root / "proc/version")
    if version is None:
        return None, None
    release = version.split()[2] if len(version.split()) > 2 else platform.release()
    if _read(root / "sys/kernel/realtime") == "1" or "PREEMPT_RT" in version:
        return f"{release}, PREEMPT_RT", None
    return (
        f"{release}, without PREEMPT_RT",
        "its own work may hold the loop up for milliseconds: install a PREEMPT_RT kernel, such as "
        "linux-image-rt-amd64 of Debian",
    )


def _priority(granted: Granted) -> Seen:
    if "priority" in granted:
        return granted["priority"].told, None
    advice = None
    if hasattr(os, "sched_setscheduler"):
        advice = (
            f'add "@realtime - rtprio {PRIORITY}" to /etc/security/limits.conf, your user to the group '
            "realtime, and log in again"
        )
    return f"not granted: {granted['priority'].told}", advice


def _memory(granted: Granted, root: Path) -> Seen:
    told = _read(root / "proc/meminfo")
    if told is None:
        return None, None
    kib = {line.split(":")[0]: int(line.split()[1]) for line in told.splitlines() if len(line.split()) > 1}
    total, free = kib.get("SwapTotal"), kib.get("SwapFree")
    if total is None or free is None:
        return None, None
    swap = f"swap {_mib(total - free)} of {_mib(total)} used" if total else "no swap"
    if "memory" in granted:
        return f"locked while the loop runs; {swap}", None
    limit = memory_limit()
    reason = granted["memory"].told if limit is None else f"this user may lock {_mib(limit // 1024)}"
    advice = 'add "@realtime - memlock unlimited" to /etc/security/limits.conf'
    return f"not locked: {reason}; {swap}", advice if total else None


def _mib(kib: int) -> str:
    return f"{kib / 1024:.0f} MiB"


def _governor(root: Path) -> Seen:
    told = [text for _, text in _all(root, "sys/devices/system/cpu/cpu[0-9]*/cpufreq/scaling_governor")]
    if not told:
        return None, None
    slow = [text for text in told if text != "performance"]
    seen = ", ".join(f"{told.count(name)} × {name}" for name in sorted(set(told)))
    advice = "a slow core takes longer for each step: sudo cpupower frequency-set -g performance"
    return f"governor {seen}", advice if slow else None


def _sleep(granted: Granted, root: Path) -> Seen:
    """The longest time that a core takes to come back from a sleep that it may go into."""
    longest = -1
    for path, text in _all(root, "sys/devices/system/cpu/cpu[0-9]*/cpuidle/state[0-9]*/latency"):
        if _read(path.with_name("disable")) in (None, "0") and text.isdigit():
            longest = max(longest, int(text))
    if longest < 0:
        return None, None
    seen = f"the deepest takes {shown(1e-6 * longest, 's')} to end"
    if "awake cores" in granted:
        return f"{seen}, and is forbidden while the loop runs", None
    advice = "sudo chmod o+w /dev/cpu_dma_latency, and the loop keeps the cores awake while it runs"
    return seen, advice if longest > _DEEP else None


def _usb(root: Path) -> Seen:
    if not (root / "sys/bus").is_dir():
        return None, None
    ports = [
        (path.parent.name, int(text), path)
        for path, text in _all(root, "sys/bus/usb-serial/devices/*/latency_timer")
        if text.isdigit()
    ]
    if not ports:
        return "none that holds bytes back by a latency timer", None
    seen = ", ".join(f"{name} holds bytes back for {shown(1e-3 * timer, 's')}" for name, timer, _ in ports)
    slow = next((path for _, timer, path in ports if timer > 1), None)
    where = "" if slow is None else "/" + str(slow.relative_to(root))
    return seen, f"echo 1 | sudo tee {where}" if slow else None


def _virtual(root: Path, before: Moment) -> Seen:
    told = _read(root / "proc/cpuinfo")
    if told is None:
        return None, None
    flags = next((line for line in told.splitlines() if line.startswith("flags")), None)
    if flags is None:  # other processors than those of the x86 family do not tell
        return None, None
    if "hypervisor" not in flags.split():
        return "no", None
    share = _stolen(before, Moment.now(root))
    if share is None:
        return "yes; how much time the host takes is not told", None
    advice = "the host runs others in that time: serve on a machine of your own, or pin its virtual cores"
    seen = f"yes; its host took {shown(share, '%', 2)} of the time meanwhile, as the kernel counts"
    return seen, advice if share > _STOLEN else None


def _stolen(before: Moment, after: Moment) -> float | None:
    if before.total is None or before.stolen is None or after.total is None or after.stolen is None:
        return None
    passed = after.total - before.total
    return (after.stolen - before.stolen) / passed if passed > 0 else None


def _load(root: Path, before: Moment) -> Seen:
    cores = len(list(root.glob("sys/devices/system/cpu/cpu[0-9]*")))
    if before.load is None or not cores:
        return None, None
    seen = f"{before.load:g} tasks ran or waited in the minute before, on {cores} core{'s' * (cores > 1)}"
    advice = "end what else runs, or keep a core free (isolcpus= on the kernel's command line)"
    return seen, advice if before.load > _BUSY * cores else None


def _clock(root: Path) -> Seen:
    told = _read(root / "sys/devices/system/clocksource/clocksource0/current_clocksource")
    if told is None:
        return None, None
    advice = f"each look at {told} is a call into the kernel, up to microseconds; see why tsc was given up"
    return told, None if told in _FAST_CLOCKS else advice
