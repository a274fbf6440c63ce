"""Just-noticeable differences of stiffness, and where they are said."""

from math import isnan

import numpy as np
import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.loop.traces.measures import WEBER, noticeable_differences

PADDLE = zw.catalogue.device("haptic-paddle")


@pytest.mark.parametrize(("steps", "felt"), [(1, 1230.0), (2, 1512.9), (-1, 813.0081300813008), (0, 1000.0)])
def test_steps_of_23_percent(steps, felt):
    assert noticeable_differences(felt, 1000) == pytest.approx(steps, abs=1e-12)


def test_just_below_a_step_and_just_above():
    """The step lies at 1 + w, whatever w is."""
    for weber in (0.07, WEBER, 0.5):
        step = 400 * (1 + weber)
        below, above = (noticeable_differences(step * by, 400, weber) for by in (1 - 1e-9, 1 + 1e-9))
        assert below < 1 < above


@pytest.mark.parametrize("felt", [0.0, -20.0, float("nan"), float("inf")])
def test_what_was_not_felt_has_no_number(felt):
    """A wall that was not touched, or that pulled."""
    assert isnan(noticeable_differences(felt, 1000))


@pytest.mark.parametrize(("wanted", "weber"), [(0, 0.2), (-1, 0.2), (float("inf"), 0.2), (9, 0), (9, -0.1)])
def test_nothing_to_compare_with_is_refused(wanted, weber):
    with pytest.raises(InputError, match="must be finite and > 0"):
        noticeable_differences(100, wanted, weber)


def test_a_trace_says_what_was_felt():
    """A press on a spring feels that spring but for the encoder; on half of it, so many steps less."""
    trace = zw.simulate(PADDLE, zw.Wall(300), zw.operators.TypicalTouch(), 2.0)
    assert trace.zwidth.felt_stiffness == pytest.approx(300, rel=0.02)
    assert abs(trace.zwidth.stiffness_jnds(300)) < 0.1
    expected = np.log(trace.zwidth.felt_stiffness / 600) / np.log(1.23)
    assert trace.zwidth.stiffness_jnds(600) == pytest.approx(expected)
    assert trace.zwidth.stiffness_jnds(600, weber=0.1) < expected < -3


def test_the_bench_says_it_with_its_source():
    found = zw.compare(PADDLE, zw.Wall(600), {"wall": zw.Wall(600), "softer": zw.Wall(300)})
    steps = found.scores["stiffness_jnds"]
    expected = np.log(found.scores["static_stiffness"] / 600) / np.log(1.23)
    assert np.allclose(steps, expected)
    assert abs(float(steps.sel(law="wall"))) < 0.2
    assert float(steps.sel(law="softer")) == pytest.approx(np.log(0.5) / np.log(1.23), abs=0.2)
    assert "JNDs" in repr(found)
    assert "just-noticeable differences of 23% (Jones & Hunter 1990)" in repr(found)
