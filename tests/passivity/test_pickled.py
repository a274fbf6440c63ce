"""Results go to other processes and come back: nothing in them resists being pickled or copied."""

from __future__ import annotations

import copy
import pickle

import pytest

import zwidth as zw

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = zw.Device(damping="0.3", sample_period="0.001")
FILTER = zw.PulseTransferFunction([1000, -990], [1, "-0.5"])
LOOPS = {
    "passive": (PADDLE, zw.Wall(300)),
    "active": (PADDLE, zw.Wall(770)),
    "filter": (IDEAL.replace(damping=9), FILTER),
    "active filter": (IDEAL.replace(damping="0.1"), FILTER),
    "touched": (IDEAL.replace(damping="0.025"), zw.Wall(10, "0.3", zw.rendering.OnePole("0.01"))),
    "part of a sample": (IDEAL.replace(delay="0.0004"), zw.Wall(100)),
    "interval": (PADDLE, zw.Wall(zw.Interval(200, 400))),
    "row": (PADDLE, zw.render(zw.Wall(770), zw.rendering.ForceBounding())),
    "spring of any form": (PADDLE, zw.NonlinearSpring([0, "0.001"], [0, "0.1"])),
}


@pytest.mark.parametrize("name", LOOPS)
def test_a_verdict_is_the_same_afterwards(name: str) -> None:
    """Outcome, scope and evidence; the witness can still be made."""
    verdict = zw.check(*LOOPS[name])
    for again in (pickle.loads(pickle.dumps(verdict)), copy.deepcopy(verdict)):
        assert again.to_dict() == verdict.to_dict()
        assert (again.outcome, again.scope) == (verdict.outcome, verdict.scope)
        assert (again.witness is None) is (verdict.witness is None)
