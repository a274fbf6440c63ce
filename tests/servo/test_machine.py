"""What the system tells of itself: read from its files, or said to be unknown."""

import re

import pytest

from zwidth.machine.servo import checkup
from zwidth.machine.servo.checkup import Moment, findings
from zwidth.machine.servo.priority import Answer, Granted
from zwidth.quantity.answered import data_of

ALL = Granted(
    tuple(Answer(wish, True, "yes") for wish in ("timers", "awake cores", "memory", "one core", "priority"))
)
NONE = Granted(tuple(Answer(each.wish, False, "no") for each in ALL.answers))

CPU = "sys/devices/system/cpu"
WELL = {
    "proc/version": "Linux version 6.12.1-rt5 (x@y) (gcc) #1 SMP PREEMPT_RT",
    "proc/meminfo": "MemTotal: 100 kB\nSwapTotal:       0 kB\nSwapFree:        0 kB",
    "proc/cpuinfo": "processor : 0\nflags : fpu tsc sse2",
    "proc/stat": "cpu  10 0 20 900 0 0 0 0 0 0\ncpu0 10 0 20 900 0 0 0 0 0 0",
    "proc/loadavg": "0.10 0.20 0.30 1/200 4242",
    f"{CPU}/cpu0/cpufreq/scaling_governor": "performance",
    f"{CPU}/cpu0/cpuidle/state0/latency": "2",
    f"{CPU}/cpu1/online": "1",
    "sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "1",
    "sys/devices/system/clocksource/clocksource0/current_clocksource": "tsc",
}


def _told(root, changes, granted=ALL, before=None):
    """The findings, of a system with these files; None for one that is not there."""
    for path, text in {**WELL, **changes}.items():
        if text is not None:
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text + "\n")
    return {one.about: one for one in findings(granted, before or Moment.now(root), root)}


def test_nothing_is_to_be_changed_where_all_is_well(tmp_path):
    found = _told(tmp_path, {})
    assert [one.about for one in found.values() if one.advice or one.seen is None] == []
    assert "PREEMPT_RT" in found["kernel"].seen
    assert found["virtual machine"].seen == "no"


def test_what_cannot_be_read_is_said_to_be_unknown(tmp_path):
    """Nothing is inferred, and nothing advised, of a system without these files."""
    found = findings(ALL, Moment.now(tmp_path), tmp_path)
    unknown = [one for one in found if one.about != "real-time priority"]
    assert len(unknown) == 8
    assert all(one.seen is None and one.advice is None for one in unknown)
    assert all(one.told == "cannot be read here" for one in unknown)


DEEP = {
    f"{CPU}/cpu1/cpuidle/state2/latency": "133",
    f"{CPU}/cpu1/cpuidle/state3/latency": "890",
    f"{CPU}/cpu1/cpuidle/state3/disable": "1",
}
SWAP = {"proc/meminfo": "SwapTotal:    2097152 kB\nSwapFree:     1048576 kB"}
GUEST = {"proc/cpuinfo": "flags : fpu hypervisor tsc"}
TAKEN = {**GUEST, "proc/stat": "cpu  200 300 400 1000 300 100 73 127 50 50"}
"""120 of 1500 ticks since a look before."""
BEFORE = Moment(total=1000, stolen=7, load=0.0)
USB = "sys/bus/usb-serial/devices"
CLOCK = "sys/devices/system/clocksource/clocksource0/current_clocksource"
VERSION = "Linux version 6.8.0-31 (b@d) #31 SMP PREEMPT_DYNAMIC"


@pytest.mark.parametrize(
    ("about", "changes", "seen", "advice", "more"),
    [
        ("kernel", {"proc/version": VERSION}, "6.8.0-31", "RT", {}),
        (
            "frequency of the cores",
            {f"{CPU}/cpu1/cpufreq/scaling_governor": "powersave"},
            "1 × performance, 1 × powersave",
            "frequency-set -g performance",
            {},
        ),
        (
            "USB serial ports",
            {f"{USB}/ttyUSB1/latency_timer": "16"},
            "ttyUSB0 holds bytes back for 1 ms, ttyUSB1 holds bytes back for 16 ms",
            f"echo 1 | sudo tee /{USB}/ttyUSB1/latency_timer",
            {},
        ),
        # a system with a bus and no such port
        ("USB serial ports", {f"{USB}/ttyUSB0/latency_timer": None, "sys/bus/pci/x": "1"}, "^none", None, {}),
        ("load", {"proc/loadavg": "1.90 1 1 3/200 1"}, "1.9 tasks", "keep a core free", {}),
        ("clock", {CLOCK: "hpet"}, "hpet", "tsc was given up", {}),
        ("sleep of the cores", DEEP, "133 µs", "cpu_dma_latency", {"granted": NONE}),
        ("sleep of the cores", DEEP, "133 µs.*forbidden|forbidden.*133 µs", None, {"granted": ALL}),
        ("virtual machine", TAKEN, r"\b8 % of the time", " ", {"before": BEFORE}),
        (
            "virtual machine",
            {**GUEST, "proc/stat": TAKEN["proc/stat"].replace("127", "7")},
            r"\b0 % of the time",
            None,
            {"before": BEFORE},
        ),
        ("virtual machine", GUEST, "not told", None, {"before": Moment(None, None, None)}),
        ("memory", SWAP, "may lock 8 MiB.*1024 MiB of 2048 MiB", "memlock", {"granted": NONE}),
        ("memory", SWAP, "", None, {"granted": ALL}),
        ("memory", {}, "", None, {"granted": NONE}),  # what cannot be put aside stays in memory unlocked
        ("real-time priority", {}, "^not granted: no$", "@realtime - rtprio 40", {"granted": NONE}),
    ],
)
def test_what_makes_a_loop_late_is_told_with_what_helps(
    about, changes, seen, advice, more, tmp_path, monkeypatch
):
    monkeypatch.setattr(checkup, "memory_limit", lambda: 8 * 2**20)
    one = _told(tmp_path, changes, **more)[about]
    assert re.search(seen, one.seen)
    assert (one.advice is None) if advice is None else advice in one.advice
    assert data_of(one) == {"about": about, "seen": one.seen, "advice": one.advice}
