"""Where a limit is looked for first: near where it is, and the answers are those of every single loop."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import zwidth as zw
from zwidth.model.environment import OnePole, Window
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.parameter_limits import (
    likely_damping,
    likely_friction,
    likely_resolution,
    likely_value,
    provable,
)
from zwidth.quantity.exact import Exact

PADDLE: dict[str, Any] = {
    "damping": "0.15 N*s/m", "coulomb_friction": "0.038 N", "resolution": "20 um", "rate": "1 kHz",
    "delay": "0",
}  # fmt: skip
WALLS = {
    "a spring": zw.Wall(stiffness=123),
    "behind a delay": zw.Wall(stiffness=71, damping="0.013 N*s/m"),
    "damped": zw.Wall(stiffness=77, damping="0.031 N*s/m"),
    "damped through a window": zw.Wall(stiffness=470, damping="0.31 N*s/m", velocity_filter=Window(3)),
    "damped through a pole": zw.Wall(stiffness=95, damping="0.06 N*s/m", velocity_filter=OnePole("2.3 ms")),
    "a negative damper": zw.Wall(stiffness=140, damping="-0.021 N*s/m"),
    "clamped": zw.Wall(stiffness=60, damping="0.04 N*s/m", clamped=True),
    "a solid": zw.Maxwell(stiffness=250, damping="0.9 N*s/m"),
}


def device(name: str, **more: Any) -> zw.Device:
    late = {"delay": "1.4 ms"} if name == "behind a delay" else {}
    return zw.Device(**{**PADDLE, **late, **more})


@pytest.mark.parametrize("name", WALLS)
def test_it_is_near_where_decisions_turn(name: str) -> None:
    """A part in a billion below what is likely is proved, above it is not, or the other way round."""
    here, law = device(name), WALLS[name]
    decision = decide(here, law)
    of_one = decide(here.replace(resolution=1), law)
    found = {
        "damping": (likely_damping(decision, False), True),
        "coulomb_friction": (likely_friction(decision, False), True),
        "resolution": (likely_resolution(of_one, False), False),
    }
    for key, (likely, more) in found.items():
        if 0 < likely < float("inf"):
            turns(lambda value, key=key: (here.replace(**{key: Exact(value)}), law), likely, more)
    now = float(law.stiffness)

    def stiffer(value: Fraction) -> tuple[zw.Device, Any]:
        return here, law.replace(stiffness=Exact(value))

    likely = likely_value(stiffer, False, now, now, more=False)
    assert likely is not None
    turns(stiffer, likely, more=False)


def turns(change: Any, likely: float, more: bool) -> None:
    below, above = (Exact(likely * (1 + off)).fraction for off in (-1e-9, 1e-9))
    assert provable(change, below) is not more
    assert provable(change, above) is more


def test_where_nothing_helps_none_is_likely() -> None:
    """No friction makes up for damping that is missing, no damping for friction."""
    weak = decide(device("a spring", damping="0.01 N*s/m"), WALLS["a spring"])
    assert likely_friction(weak, False) == float("inf")
    assert likely_resolution(weak, False) == 0
    rough = decide(device("a spring", resolution="5 mm"), WALLS["a spring"])
    assert likely_damping(rough, False) == float("inf")


DAMPED = {"stiffness": 110, "damping": "0.02 N*s/m"}
ANOTHER = {
    "damping": ({"damping": "0.16 N*s/m"}, {}),
    "coulomb_friction": ({"coulomb_friction": "0.039 N"}, {}),
    "resolution": ({"resolution": "21 um"}, {}),
    "rate": ({"rate": "900 Hz"}, {}),
    "delay": ({"delay": "0.2 ms"}, {}),
    "stiffness": ({}, {"stiffness": 111}),
    "damping of the law": ({}, {"damping": "0.021 N*s/m"}),
    "filter": ({}, {"velocity_filter": Window(2)}),
    "clamped": ({}, {"clamped": True}),
}


@pytest.mark.parametrize("name", ANOTHER)
def test_limits_and_advice_are_those_of_the_loop_and_of_no_other(name: str) -> None:
    """After one loop another that differs in a single number: its answers are as if it were the first."""
    first = zw.Device(**PADDLE), zw.Wall(**DAMPED)
    of_device, of_law = ANOTHER[name]
    before = answers(*first)
    changed = answers(first[0].replace(**of_device), first[1].replace(**of_law))
    assert changed != before
    assert changed == answers(zw.Device(**{**PADDLE, **of_device}), zw.Wall(**{**DAMPED, **of_law}))
    assert answers(*first) == before


def answers(here: zw.Device, law: zw.Wall) -> dict[str, Any]:
    """Numbers and advice of the closed forms, each loop decided by itself; every value advised is proved."""
    verdict = check_by_closed_forms(here, law)
    found = verdict.numbers()
    stiffness = next(one for one in verdict.advice if one.parameter == "stiffness")
    if isinstance(stiffness.to, float):
        assert stiffness.to == pytest.approx(verdict.max_stiffness, rel=1e-6)
        assert check_by_closed_forms(here, law.replace(stiffness=stiffness.to)).is_proved
    return {key: found[key] for key in ("max_stiffness_N_per_m", "required_damping_N_s_per_m", "advice")} | {
        "scope": verdict.scope.to_dict()
    }
