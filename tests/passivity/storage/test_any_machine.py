"""Values end the same however many threads improve them, whichever is faster, however busy the machine is."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity import value_iteration_fallback as gap
from zwidth.passivity.storage import value_iteration as iterating
from zwidth.passivity.storage.domain import domain_for, losses_of
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.relaxing_grid import RelaxingGrid
from zwidth.passivity.storage.value_iteration import ValueIteration, value_iteration


class LastFirst(ThreadPoolExecutor):
    """The thread that was given its work last is done first."""

    def map(self, work: Callable[..., object], *jobs: Iterable[object], **_: object) -> Iterable[object]:
        """What each job gives, in the order of the jobs."""
        return [work(*job) for job in reversed(list(zip(*jobs, strict=True)))][::-1]


def iterated(damping: float, wall: zw.Wall, grid: type[Grid | RelaxingGrid]) -> ValueIteration:
    """On a device of one N, m and s; K = 1 N/m."""
    device = zw.Device(damping=damping, coulomb_friction=6, resolution=1, sample_period=1)
    law, losses = finite_law(device, wall), losses_of(device)
    return value_iteration(grid(law, losses, domain_for(law, losses, 12, 8), 8, "outer"))


def relaxing(damping: float) -> ValueIteration:
    """A wall with a slow filter of velocity, B = 10 KT and τ = 9 T, fed with the penetration."""
    return iterated(damping, zw.Wall(1, 10, zw.rendering.OnePole(9)), RelaxingGrid)


def in_blocks(damping: float) -> ValueIteration:
    """A wall whose velocity is that of two samples, on a grid that is taken for a large one."""
    return iterated(damping, zw.Wall(1, 2, zw.rendering.Window(2)), Grid)


@pytest.mark.parametrize(
    ("grid", "damping"), [(relaxing, 1.2), (relaxing, 0.9), (in_blocks, 1.0), (in_blocks, 0.1)]
)
def test_the_order_of_the_threads_does_not_matter(
    grid: Callable[[float], ValueIteration], damping: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same rounds, and the same most that can be taken out of each state."""
    monkeypatch.setattr(iterating, "ALONE", 100)
    here = grid(damping)
    monkeypatch.setattr(iterating, "ThreadPoolExecutor", LastFirst)
    there = grid(damping)
    assert (here.rounds, here.cycle) == (there.rounds, there.cycle)
    assert (here.value is None) == (there.value is None)
    assert here.value is None or np.array_equal(here.value, there.value)


def test_blocks_end_at_the_values_of_a_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """No fewer rounds, the same least storage function; and where a motion gains, one that does."""
    whole = in_blocks(1.0)
    monkeypatch.setattr(iterating, "ALONE", 100)
    blocks = in_blocks(1.0)
    assert blocks.rounds >= whole.rounds > 1
    assert whole.value is not None
    assert np.array_equal(blocks.value, whole.value)
    assert in_blocks(0.1).cycle


class Slow:
    """A clock on a machine so slow that an hour passes whenever it is read."""

    def __init__(self) -> None:
        self.now = 0.0

    def monotonic(self) -> float:
        """The time."""
        self.now += 3600
        return self.now


def test_a_slow_machine_finds_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Work is counted: of a limit, cut short by its effort, and of what a check adds by iterating values."""
    paddle = zw.catalogue.device("haptic-paddle").replace(delay="1 ms")
    wall = zw.Wall(100, "0.02")

    def found() -> tuple[str, str]:
        bracket = zw.limit(paddle, wall, penetration="0.0005", speed="0.2", tolerance=1e-4, effort=0.5)
        assert bracket.proved_passive is not None
        assert bracket.relative_width > 1e-4
        return repr(bracket.to_dict()), repr(zw.check(paddle, wall.replace(stiffness=420)).to_dict())

    here = found()
    monkeypatch.setattr(iterating, "time", Slow())
    assert found() == here


def test_an_end_by_time_is_said() -> None:
    """Where a person asks for one, and it came first; not where it did not."""
    paddle = zw.catalogue.device("haptic-paddle").replace(delay="1 ms")
    bounds = {"penetration": "0.0005", "speed": "0.2"}
    cut = zw.limit(paddle, zw.Wall(100, "0.02"), **bounds, tolerance=1e-6, seconds=0)
    assert cut.cut_by_time
    assert cut.to_dict()["cut_by_time"]
    assert "in the time given" in cut.describe()
    whole = zw.limit(paddle, zw.Wall(100, "0.02"), **bounds, seconds=3600, tolerance=0.2)
    assert not whole.cut_by_time
    assert "cut_by_time" not in whole.to_dict()
    short = zw.available_storage(paddle, zw.Wall(700, "0.02"), **bounds, seconds=0)
    assert (short.outcome, short.cut_by_time) == ("undecided", True)
    assert "time given" in short.claim
    none = zw.available_storage(paddle, zw.Wall(700, "0.02"), **bounds, effort=0)
    assert (none.outcome, none.cut_by_time) == ("undecided", False)
    assert gap.EFFORT < iterating.EFFORT
