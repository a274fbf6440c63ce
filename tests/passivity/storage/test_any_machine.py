"""Values of a law that relaxes end the same however many threads improve them, and whichever is faster."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.storage.domain import domain_for, losses_of
from zwidth.passivity.storage.grid.relaxing import RelaxingGrid
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.solve.value_iteration import ValueIteration, value_iteration


class LastFirst(ThreadPoolExecutor):
    """The thread that was given its work last is done first."""

    def map(self, work: Callable[..., object], *jobs: Iterable[object], **_: object) -> Iterable[object]:
        """What each job gives, in the order of the jobs."""
        return [work(*job) for job in reversed(list(zip(*jobs, strict=True)))][::-1]


def iterated(damping: float) -> ValueIteration:
    """A wall with a slow filter of velocity, B = 10 KT and τ = 9 T, fed with the penetration."""
    device = zw.Device(damping=damping, coulomb_friction=6, resolution=1, sample_period=1, delay=0, mass=1)
    law = finite_law(device, zw.Wall(1, damping=10, velocity_filter=zw.rendering.OnePole(9)))
    losses = losses_of(device)
    return value_iteration(RelaxingGrid(law, losses, domain_for(law, losses, 12, 8), 8, "outer"))


@pytest.mark.parametrize("damping", [1.2, 0.9])
def test_the_order_of_the_threads_does_not_matter(damping: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same rounds, and the same most that can be taken out of each state."""
    here = iterated(damping)
    monkeypatch.setattr("zwidth.passivity.storage.solve.value_iteration.ThreadPoolExecutor", LastFirst)
    there = iterated(damping)
    assert (here.rounds, here.cycle) == (there.rounds, there.cycle)
    assert (here.value is None) == (there.value is None)
    assert here.value is None or np.array_equal(here.value, there.value)
