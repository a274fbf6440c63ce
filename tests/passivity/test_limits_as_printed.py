"""What `limit` prints is so as it is printed: each end is rounded, and still proved or refuted."""

from __future__ import annotations

import random
import re
from dataclasses import replace

import pytest
from strategies import seeds
from test_advice import drawn

import zwidth as zw
from zwidth.cli.check.limit_report import _claim
from zwidth.passivity.bracket import Bracket, passive_limit
from zwidth.passivity.bracket.bracket import parameter_of
from zwidth.quantity.exact import Exact
from zwidth.quantity.units import parse_number

_END = re.compile(r"(-?[\d.]+(?:e[+-]?\d+)? ?[^\s,;]*?) is (proved passive|active)")


def ends(bracket: Bracket) -> set[tuple[str, str]]:
    """(value, "proved passive" or "active") of both sentences that name them."""
    return {*_END.findall(_claim(bracket)), *_END.findall(bracket.describe())}


@pytest.mark.parametrize(
    ("parameter", "unit", "proved", "refuted"),
    [
        ("environment.stiffness", "N/m", "123.456", "123.458"),
        ("device.damping", "N*s/m", "123.458", "123.456"),
    ],
)
def test_an_end_is_rounded_to_its_own_side(parameter: str, unit: str, proved: str, refuted: str) -> None:
    """A proved stiffness down and a refuted one up, damping the other way; with the other end and without."""
    found = passive_limit(zw.Device(damping="0.2", rate="1 kHz"), zw.Wall(100), iterate=False)
    values = sorted((123.4568, 123.4572), reverse=parameter == "device.damping")
    bracket = replace(
        found, parameter=parameter, unit=unit, proved_passive=values[0], proved_active=values[1]
    )
    said = {text: value.split()[0] for value, text in ends(bracket)}
    assert said == {"proved passive": proved, "active": refuted}
    for missing in ("proved_passive", "proved_active"):
        (alone,) = ends(replace(bracket, **{missing: None}))
        assert alone[0].split()[0] == said[alone[1]]


@seeds(4)
def test_both_ends_hold_as_they_are_printed(seed: int) -> None:
    """Given to `check`, the one is passive and the other active."""
    rng = random.Random(seed)
    loop = drawn(rng)
    while not (loop[0].is_certain and loop[1].is_certain):
        loop = drawn(rng)
    names = ["device.damping", "device.coulomb_friction", "device.resolution", "device.delay", "device.rate"]
    name = rng.choice([*names, "gain", *(["stiffness"] * 4 if hasattr(loop[1], "stiffness") else [])])
    bracket = passive_limit(*loop, name, iterate=False, tolerance=rng.choice([0.1, 0.01, 0.001]))
    assert bool(ends(bracket)) == (bracket.proved_passive is not None or bracket.proved_active is not None)
    change = parameter_of(*loop, name).change
    for value, said in ends(bracket):
        turned = change(Exact(parse_number(value.strip(), bracket.unit, name)))
        assert zw.check(*turned, iterate=False).outcome == said.removeprefix("proved ")
