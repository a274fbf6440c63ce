"""Advice is the bound of the outcome that is printed, a limit is one as printed: both are asked again."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import example
from strategies import seeds

import zwidth as zw
from zwidth.cli.check.limit_report import _claim
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering import OnePole, Window
from zwidth.passivity.advice import Advice
from zwidth.passivity.bracket import Bracket, passive_limit
from zwidth.passivity.bracket.bracket import parameter_of
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.formulas.nonlinear_spring import certify_spring
from zwidth.passivity.loop_advice import advise_on_spring
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.units import parse_number

PADDLE = zw.Device(damping="0.15", coulomb_friction="0.12", resolution="22.4e-6", rate=1000)
IDEAL = PADDLE.replace(resolution=0)
Loop = tuple[zw.Device, Any]

_MORE = ("rate", "damping", "coulomb_friction", "time_constant")
"""Of which the safer side is above."""

_SAID = re.compile(r"(?:to|as low as) (-?[\d.e-]+) ?(\D*?)(?: while contact is kept)?(?: \(now .*\))?$")


def typed(value: float) -> Exact:
    return Exact(f"{value:.4g}")


def drawn(rng: random.Random) -> Loop:
    """A loop near its limit: with and without delay, encoder, friction, interval; any linear law."""
    b, period = 10 ** rng.uniform(-2, 0.5), 10 ** rng.uniform(-4, -2.3)
    late = rng.choice([0, 0, rng.randrange(1, 4), rng.uniform(0, 3), rng.uniform(0, 3)])
    stiffness, damping = rng.uniform(0, 1.3) * b / period / (1 + late), rng.uniform(-0.3, 1) * b
    numbers: dict[str, Any] = {
        "damping": typed(b),
        "sample_period": typed(period),
        "delay": late * typed(period).fraction if isinstance(late, int) else typed(late * period),
    }
    if rng.random() < 0.6:
        numbers["resolution"] = typed(10 ** rng.uniform(-6, -4))
    if rng.random() < 0.7:
        numbers["coulomb_friction"] = typed(10 ** rng.uniform(-3, 0))
    if rng.random() < 0.12:
        key = rng.choice([k for k in numbers if float(numbers[k])])
        end = typed(float(numbers[key]) * rng.uniform(1.01, 1.5))
        numbers[key] = Interval(*sorted((Exact(numbers[key]), end), key=float))
    device = zw.Device(**numbers, motion=rng.choice(["linear", "linear", "linear", "rotary"]))
    return device, _law(rng, stiffness, damping, period)


def _law(rng: random.Random, stiffness: float, damping: float, period: float) -> Environment:
    k, b = typed(stiffness), typed(damping)
    kind = rng.randrange(9)
    if kind == 0:
        return zw.Wall(k)
    if kind < 5:
        slow = OnePole(typed(period * 10 ** rng.uniform(-1, 1)))
        filters = [None, None, Window(rng.randrange(2, 6)), slow]
        b = rng.choice([b, typed(abs(damping) / 4)])
        return zw.Wall(k, b, rng.choice(filters), clamped=rng.random() < 0.1)
    branch, eta = typed(stiffness * rng.uniform(0.1, 1)), typed(abs(damping) * rng.uniform(0.2, 2) + 1e-4)
    how = rng.choice(["backward", "tustin"])
    if kind == 5:
        return zw.Maxwell(branch, eta, discretization=how)
    if kind < 8:
        return zw.StandardLinearSolid(k, branch, eta, discretization=how)
    lead = [0.7 * stiffness * period, stiffness]
    return zw.ContinuousTransferFunction(lead, [period / 2, 1], discretization="tustin")


def turned(loop: Loop, advice: Advice, value: float | Fraction) -> Loop:
    device, law = loop
    key, exact = advice.parameter, Exact(value)
    if key == "stiffness":
        return device, law.replace(stiffness=end(law.stiffness, exact))
    if key == "virtual_damping":
        return device, law.replace(damping=exact)
    if key == "time_constant":
        return device, law.replace(velocity_filter=OnePole(exact))
    if key == "rate":
        period = Exact(1 / exact.fraction)
        return device.replace(sample_period=end(device.sample_period, period)), law
    return device.replace(**{key: end(getattr(device, key), exact, low=key in _MORE)}), law


def end(now: Any, value: Exact, low: bool = False) -> Any:
    """The end of an interval that asks for more, moved; a value in the place of one."""
    if not isinstance(now, Interval):
        return value
    if low:
        return value if value.fraction >= now.high.fraction else Interval(value, now.high)
    return value if value.fraction <= now.low.fraction else Interval(now.low, value)


def faults(device: zw.Device, law: Any, contact: str, rng: random.Random) -> Iterator[str]:
    """What is said of how far a number may or must go, and is not so."""
    verdict = check_by_closed_forms(device, law, contact=contact)
    for advice in verdict.advice:
        if advice.parameter == "velocity_filter":
            yield from _of_another_filter((device, law), advice, contact)
        elif isinstance(advice.to, float):
            told = f"{verdict.outcome}, {advice}:"
            if advice.kind == "slack" and not advice.to and not advice.current:
                yield f"{told} it has none of it"
            elif advice.to < float("inf"):
                yield from (f"{told} {fault}" for fault in _of_a_number((device, law), advice, contact, rng))


def _of_a_number(loop: Loop, advice: Advice, contact: str, rng: random.Random) -> Iterator[str]:
    to, now = advice.to, advice.current
    assert isinstance(to, float)
    assert isinstance(now, float)
    more = advice.parameter in _MORE
    said = _SAID.search(advice.text)
    values = {"at its value": to}
    if said is not None:
        values["as it is printed"] = float(parse_number(f"{said[1]} {said[2]}", advice.unit, "it"))
    if advice.kind == "slack" and to != now:
        for part in (rng.random() for _ in range(6)):
            values[f"{part} of the way"] = now + part * (to - now)
    for where, value in values.items():
        if not holds(turned(loop, advice, value), advice, contact):
            yield f"not {where}, {value!r}"
            return
    high = 3e-3 if is_slow(loop) else 1e-6
    beyond = to * (1 - high if more else 1 + high)
    limited = not advice.is_alone and (to or not more)
    if limited and holds(turned(loop, advice, beyond or 1e-14), advice, contact):
        yield f"beyond, at {beyond!r}, too"


def is_slow(loop: Loop) -> bool:
    from zwidth.passivity.corners import worst_corners
    from zwidth.passivity.parameter_limits import is_of_high_degree

    return any(is_of_high_degree(*corner) for corner in worst_corners(*loop))


def holds(loop: Loop, advice: Advice, contact: str) -> bool:
    """Whether `check` says of it what the advice promises."""
    kept = advice.text.partition(" (now")[0].endswith("while contact is kept")
    try:
        return check_by_closed_forms(*loop, contact="kept" if kept else contact).outcome == "passive"
    except zw.InputError:
        return False


def _of_another_filter(loop: Loop, advice: Advice, contact: str) -> Iterator[str]:
    device, law = loop
    name, number = re.search(r"(window|one-pole filter) of ([\d.]+ ?\w+)", advice.text).groups()
    if name == "window":
        samples = int(number.split()[0])
        other, less = Window(samples), Window(samples - 1) if samples > 2 else None
    else:
        other, less = OnePole(Exact(parse_number(number, "s", "it"))), None
    if not holds((device, law.replace(velocity_filter=other)), advice, contact):
        yield f"{advice}: not so"
    if less and holds((device, law.replace(velocity_filter=less)), advice, contact):
        yield f"{advice}: a shorter one will do"


ADVISED = {
    "spring": (PADDLE, zw.Wall(770)),
    "delayed": (PADDLE.replace(delay="0.0013"), zw.Wall(120)),
    "coarse": (PADDLE.replace(resolution="22.4e-4"), zw.Wall(150)),
    "damped": (IDEAL, zw.Wall(200, "0.08")),
    "filtered": (IDEAL, zw.Wall(280, "0.08", OnePole("0.001"))),
    "much damped": (IDEAL, zw.Wall(100, "0.12")),
    "passive spring": (PADDLE, zw.Wall(180)),
    "passive damped": (IDEAL.replace(delay="0.0001"), zw.Wall(80, "0.02")),
    "passive, negative virtual damping": (PADDLE, zw.Wall(80, "-0.02")),
}


@pytest.mark.parametrize("name", ADVISED)
def test_advice_is_enough_and_no_more(name: str) -> None:
    advice = check_by_closed_forms(*ADVISED[name], contact="kept").advice
    of_filters = [a for a in advice if a.parameter == "velocity_filter"]
    assert {a.kind for a in advice} == {"slack" if name.startswith("passive") else "change"}
    assert any(a.to for a in advice if a not in of_filters)
    assert all(a.current == "backward difference" for a in of_filters)
    assert of_filters or name != "much damped"
    assert list(faults(*ADVISED[name], "kept", random.Random(1))) == []


def test_a_spring_behind_a_part_of_a_sample_has_its_own_slack() -> None:
    """With B = 0.2031 such a wall is passive in contact alone; the sensor has no steps, the device no f_c."""
    device = zw.Device(damping="0.2", rate="2 kHz", delay="0.3 ms")
    verdict = zw.check(device, zw.Wall(150))
    told = {advice.parameter: advice.text for advice in verdict.advice}
    assert told["virtual_damping"] == "virtual damping may go up to 0.09608 N·s/m (now 0 N·s/m)"
    assert not {"resolution", "coulomb_friction"} & set(told)
    kept = zw.check(device, zw.Wall(150, "0.1"))
    assert kept.outcome == "passive in contact"
    assert all(advice.text.partition(" (")[0].endswith("while contact is kept") for advice in kept.advice)


def test_a_change_that_nobody_can_make_gives_way_to_one_in_contact() -> None:
    """A solid behind a delay: a hand that leaves asks for b = 60 N·s/m, one that stays for 0.66."""
    device = zw.Device(damping="0.05", rate="1 kHz", delay="1 ms")
    tissue = zw.StandardLinearSolid(310, 144, 60)
    told = {advice.parameter: advice for advice in zw.check(device, tissue).advice}
    assert told["damping"].text.endswith("while contact is kept")
    assert told["damping"].to < 0.7
    enough = device.replace(damping=Exact(told["damping"].to))
    assert zw.check(enough, tissue).outcome == "passive in contact"


def test_a_rate_of_whole_samples_stands_alone() -> None:
    """A hair more of it is a delay of a part of a sample, which asks for more: no limit, but where it is."""
    device = zw.Device(
        damping="0.6335", coulomb_friction="0.2706", resolution=0, sample_period="0.00154", delay="0.00462"
    )
    wall = zw.Wall(stiffness="97.52", damping="0.1236", velocity_filter=OnePole("0.004815"))
    verdict = zw.check(device, wall)
    (rate,) = (advice for advice in verdict.advice if advice.parameter == "rate")
    assert verdict.outcome == "passive"
    assert rate.is_alone
    assert "for delays of whole samples alone" in rate.text


def test_a_negative_damper_is_told_with_its_sign() -> None:
    verdict = zw.check(zw.Device(damping="0.2", rate="2 kHz"), zw.Wall(150, "-0.02"))
    (told,) = [advice for advice in verdict.advice if advice.parameter == "virtual_damping"]
    assert told.current == -0.02
    assert told.to < told.current
    assert told.text.startswith("virtual damping may go down to -0.")


@seeds(8)
def test_advice_is_the_bound_of_the_outcome_that_is_printed(seed: int) -> None:
    """At its value, and as it is printed, `check` says the same; just beyond it, it does not."""
    rng = random.Random(seed)
    assert list(faults(*drawn(rng), rng.choice(["made and broken"] * 3 + ["kept"]), rng)) == []


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
@example(seed=39887)  # which comes to delays that no proof has room for
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


STOP = zw.NonlinearSpring(positions=["0.01", "0.013"], forces=[0, 3])
"""A bump stop of 1000 N/m, 10 mm away."""

DETENTS = zw.NonlinearSpring.detents(3, "0.01", "0.5")
"""±200 N/m."""

LIGHT = zw.Device(mass="0.05", damping="0.05", coulomb_friction="0.1", resolution="1e-5", rate=1000)
"""For which both are too stiff."""


def is_proved(advice: Advice, at: zw.Device, spring: zw.NonlinearSpring, share: float) -> bool:
    """Whether the checker accepts the loop with an advised value, times a share."""
    value = advice.to * share
    if advice.parameter == "stiffness":
        forces = [round(float(f) * value / advice.current, 12) for f in spring.forces]
        spring = zw.NonlinearSpring(positions=spring.positions, forces=forces)
    else:
        at = at.replace(**{advice.parameter: value})
    return certify_spring(at, spring).covered() is not None


@pytest.mark.parametrize("spring", [STOP, DETENTS], ids=["stop", "detents"])
@pytest.mark.parametrize("delay", [0, "0.00003"])
def test_each_change_is_proved_and_a_hundredth_less_is_not(
    spring: zw.NonlinearSpring, delay: str | int
) -> None:
    """Each of rate, damping and slope alone, without delay Coulomb friction too; no change of the encoder."""
    given = LIGHT.replace(delay=delay)
    advice = advise_on_spring(given, spring, passive=False)
    pays = set() if delay else {"coulomb_friction"}
    assert {one.parameter for one in advice} == {"rate", "damping", "stiffness"} | pays
    for one in advice:
        assert is_proved(one, given, spring, 1.0), one.text
        less = 1.01 if one.parameter == "stiffness" else 0.99
        assert not is_proved(one, given, spring, less), one.text


def test_the_slack_of_a_spring_that_is_proved() -> None:
    """How far each number may go; the encoder, with f_c, up to 2 f_c/s.

    Of a rise R = (s − 2b/T) ℓ over ℓ, with 2b/T beyond: (R/2 − f') ℓ + (R − f')² T/4b = 0, f' = f_c − s Δ/2.
    """
    verdict = zw.check(LIGHT.replace(damping=1), STOP)
    assert verdict.outcome == "passive"
    assert dict(verdict.rows())["limit"] == "sampling against viscous damping"
    slack = {one.parameter: one.to for one in verdict.advice}
    assert slack == pytest.approx(
        {
            "stiffness": 2059.37,
            "damping": 0.468835,
            "rate": 468.835,
            "resolution": 2e-4,
            "coulomb_friction": 0.005,
        },
        rel=1e-3,
    )


def test_where_no_condition_is_known_nothing_is_advised() -> None:
    """Of a spring that pulls away for ever."""
    pulling = zw.NonlinearSpring(positions=[0, "0.01"], forces=[0, -3])
    assert zw.check(LIGHT, pulling).advice == ()


@pytest.mark.parametrize(("contact", "at_most"), [("made and broken", 0.0), ("kept", 0.0751)])
def test_where_the_corners_do_not_decide_the_change_is_one_that_holds_between_them(
    contact: str, at_most: float
) -> None:
    """A delay within 0 … 0.25 ms behind B = 0.5: what the corners bear is not proved between them, a little
    less is of a hand that stays inside, and of any hand the bare spring."""
    wide = PADDLE.replace(coulomb_friction="0.1", delay=Interval("0", "0.00025"))
    verdict = zw.check(wide, zw.Wall(150, "0.5"), contact=contact)
    assert (verdict.outcome, verdict.environment.damping) == ("undecided", Exact("0.5"))
    (less,) = [one for one in verdict.advice if one.parameter == "virtual_damping"]
    assert isinstance(less.to, float)
    assert at_most * 0.99 <= less.to <= at_most
    assert zw.check(wide, zw.Wall(150, less.to), contact=contact).outcome == "passive"


def test_a_sentence_looks_for_the_easiest_change_alone() -> None:
    """Of a large scene every change takes seconds; where none would do, all were looked for, and are kept."""
    verdict = zw.check(PADDLE, zw.Wall(770))
    assert verdict.claim.endswith("lower the stiffness from 770 N/m to 300 N/m.")
    assert "advice" not in vars(verdict)
    assert verdict.advice[0].text.startswith("raise the rate")
    none = zw.check(PADDLE.replace(damping=0, coulomb_friction=0), zw.Wall(770))
    assert ": " not in none.claim
    kept = vars(none)["advice"]
    assert kept == zw.check(none.device, none.environment).advice
