"""Advice on a pair is the bound of its outcome: each value is asked of `check` again, on both sides."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from math import isinf
from typing import Any

from strategies import seeds

import zwidth as zw
from zwidth.passivity.advice import Advice, turn_all
from zwidth.passivity.pairs.limits import _of_the_arms, _of_the_coupling, with_share
from zwidth.quantity.exact import Exact
from zwidth.quantity.units import parse_number

_SAID = re.compile(r"(?:to|as low as) (-?[\d.e-]+) ?(\D*?)(?: of what it is)?(?: \(now .*\))?$")
_MORE = ("rate", "damping", "coulomb_friction")
"""Of which the safer side is above."""


def rounded(value: float) -> Exact:
    """As a person types it."""
    return Exact(f"{value:.4g}")


def drawn(rng: random.Random) -> zw.Pair:
    """Two arms, alike or not, near the limit of their coupling; some with compensated friction."""
    period, b = 10 ** rng.uniform(-3.7, -2.5), 10 ** rng.uniform(-1.5, 0)

    def arm(damping: float) -> zw.Device:
        numbers: dict[str, Any] = {"damping": rounded(damping), "sample_period": rounded(period)}
        if rng.random() < 0.6:
            numbers["coulomb_friction"] = rounded(10 ** rng.uniform(-2.5, 0))
        if rng.random() < 0.5:
            numbers["resolution"] = rounded(10 ** rng.uniform(-6, -4))
        if rng.random() < 0.3:
            numbers["delay"] = rounded(period * rng.choice([1, rng.uniform(0, 2)]))
        return zw.Device(**numbers)

    leader = arm(b)
    follower = rng.choice([leader, arm(b * 10 ** rng.uniform(-0.4, 0.4))])
    late = rng.choice([0, 0, rng.uniform(0, 3) * period])
    numbers: dict[str, Any] = {
        "stiffness": rounded(b / period * rng.uniform(0.05, 1.3) / (1 + 2 * late / period)),
        "delay": rounded(late),
    }
    for key, low, high in (("damping", -0.2, 0.6), ("local_damping", -0.1, 0.5)):
        if rng.random() < 0.45:
            numbers[key] = rounded(b * rng.uniform(low, high))
    if rng.random() < 0.25:
        sizes = {"coulomb": 10 ** rng.uniform(-2, -0.5), "viscous": b * rng.uniform(0, 0.5), "speed": 0.3}
        numbers["compensation"] = zw.FrictionCompensation(**{k: rounded(v) for k, v in sizes.items()})
    return zw.Pair(leader, follower, **numbers)


@seeds(6)
def test_where_a_limit_is_looked_for_first_changes_nothing(seed: int) -> None:
    pair = drawn(random.Random(seed))
    knobs = [*_of_the_coupling(pair), *_of_the_arms(pair)]
    for kind in ("slack", "change"):
        plain = [replace(knob, near=lambda: None) for knob in knobs]
        assert turn_all(knobs, pair.motion, kind) == turn_all(plain, pair.motion, kind)


def turned(pair: zw.Pair, parameter: str, value: float | Fraction) -> zw.Pair:
    """The pair with another value of what is advised on."""
    exact, arms = Exact(value), {arm: getattr(pair, arm) for arm in ("leader", "follower")}
    of_pair: dict[str, Callable[[], zw.Pair]] = {
        "stiffness": lambda: pair.replace(stiffness=exact),
        "virtual_damping": lambda: pair.replace(damping=exact),
        "local_damping": lambda: pair.replace(local_damping=exact),
        "link_delay": lambda: pair.replace(delay=exact),
        "compensation": lambda: with_share(pair, exact.fraction),
    }
    if parameter in of_pair:
        return of_pair[parameter]()
    arm, _, key = parameter.rpartition(".")
    for name, device in arms.items():
        lower = not arm and key != "rate" and device.exact(key) > exact.fraction  # it has more already
        if arm in ("", name) and not lower:
            arms[name] = device.replace(**{key: exact})
    return pair.replace(**arms)


def holds(pair: zw.Pair, parameter: str, value: float | Fraction) -> bool:
    try:
        return bool(zw.check(turned(pair, parameter, value)).passive)
    except zw.InputError:
        return False


def faults(pair: zw.Pair, rng: random.Random) -> Iterator[str]:
    """What is said of how far a number may or must go, and is not so."""
    verdict = zw.check(pair)
    for advice in verdict.advice:
        if isinstance(advice.to, float) and not isinf(advice.to):
            yield from (f"{verdict.outcome}, {advice}: {fault}" for fault in _of_one(pair, advice, rng))
    said = re.match(r"[\d.]+ ?\S+", dict(verdict.rows())["largest stiffness"])
    if said is not None:
        largest = parse_number(said[0], pair.leader.unit("stiffness"), "it")
        if not holds(pair, "stiffness", largest):
            yield f"the largest stiffness, {said[0]}, is not passive"
        if holds(pair, "stiffness", float(largest) * 1.0011):
            yield f"the largest stiffness, {said[0]}, is not the largest"


def _of_one(pair: zw.Pair, advice: Advice, rng: random.Random) -> Iterator[str]:
    to, now = advice.to, advice.current
    assert isinstance(to, float)
    assert isinstance(now, float)
    key = advice.parameter.rpartition(".")[2]
    more = key in _MORE or (key == "local_damping" and advice.kind == "change" and to > now)
    values = {"at its value": to}
    said = _SAID.search(advice.text)
    if said is not None:
        share = key == "compensation"
        number = float(said[1]) / 100 if share else parse_number(f"{said[1]} {said[2]}", advice.unit, "it")
        values["as it is printed"] = float(number)
    if advice.kind == "slack":
        values["on the way"] = now + rng.random() * (to - now)
    for where, value in values.items():
        if not holds(pair, advice.parameter, value):
            yield f"not {where}, {value!r}"
    if to and not advice.is_alone and holds(pair, advice.parameter, to * (1 - 2e-6 if more else 1 + 2e-6)):
        yield "beyond, too"


@seeds(3)
def test_advice_on_a_pair_is_the_bound_of_its_outcome(seed: int) -> None:
    rng = random.Random(seed)
    assert list(faults(drawn(rng), rng)) == []
