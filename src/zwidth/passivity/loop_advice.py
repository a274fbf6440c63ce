"""What to change: the smallest change that makes an active loop passive, or the slack of a passive one.

Every value given was itself proved passive, all else as it was, and of the same hands as the outcome: a loop
that is passive with contact made and broken stays so.  Where a proof of hands that keep contact is all that
was found, the advice says so.

What is asked for is convex in the K and the B of a wall, and more b, more f_c and a finer encoder never hurt:
beyond their limits nothing holds again.  In a delay, a period or the time constant of a filter that may
be (behind a part of a sample a wall asks for more than behind a whole one): of these the way is looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from math import inf
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import OnePole, Wall, Window
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.nonlinear import NonlinearSpring
from zwidth.model.environment.wall import wall_of
from zwidth.passivity.advice import (
    Advice,
    Guess,
    Kind,
    Knob,
    between_delays,
    between_rates,
    between_sizes,
    easiness,
    outward,
    turn_all,
)
from zwidth.passivity.budget import DELAY, QUANTIZATION, SAMPLING
from zwidth.passivity.certificate import Certificate, certify_box
from zwidth.passivity.corners import Loop, worst_corners
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.formulas.nonlinear_spring import certify_spring, spring_need
from zwidth.passivity.linear.boundary import COARSE, COARSER, Holds, smallest_holding
from zwidth.passivity.outcome_evidence import Need
from zwidth.passivity.parameter_limits import (
    has_stiffness,
    is_of_high_degree,
    likely_damping,
    likely_friction,
    likely_resolution,
    likely_value,
    provable,
)
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import in_words, shown

_WINDOWS = (2, 3, 4, 5, 6, 8, 10, 15, 20)

_KEPT = " while contact is kept"

_TOO_FAR = 10
"""Times as far: 60 N·s/m of damping for a hand that leaves help nobody where 0.7 do in contact."""

_OF = {"damping": "device ", "resolution": "encoder ", "time_constant": "filter "}


@dataclass(frozen=True)
class Asked:
    """What is to be proved of which loop: `box`, with its intervals, `at` their corner that asks for most.

    `contact` is as for `provable`.
    """

    at: Loop
    box: Loop
    contact: bool = False

    def knobs(self, stiffest: Guess) -> Iterator[Knob]:
        """All numbers that can be turned, from the device to the law; `stiffest` as for `advise`."""
        law, (whole, of_box) = self.at[1], self.box
        period, delay = ends(whole.sample_period)[1], ends(whole.delay)[1]
        hertz, late, sample = float(1 / period), float(delay), float(period)
        between = partial(between_rates, hertz, late)
        in_samples = delay > 0 and self._in_samples
        yield self._searched("rate", 1 / period, True, sample, between=between, in_samples=in_samples)
        yield from self._losses()
        between = partial(between_delays, late, sample)
        yield self._searched("delay", delay, False, sample, between=between, in_samples=self._in_samples)
        wall = wall_of(law)
        if has_stiffness(law):
            now = ends(of_box.stiffness)[1]  # type: ignore[attr-defined]
            on_the_way = None if wall is not None else partial(between_sizes, float(now))
            yield self._knob("stiffness", now, False, likely=stiffest, between=on_the_way)
        if wall is not None:
            yield from self._of_wall(wall)

    def _losses(self) -> Iterator[Knob]:
        """What takes energy out, and the encoder: of these it is known what a loop asks for."""
        decision = decide(*self.at)
        of_one = replace(decision, setting=replace(decision.setting, resolution=Fraction(1)))
        for key, more, needed, of in (
            ("damping", True, likely_damping, decision),
            ("coulomb_friction", True, likely_friction, decision),
            ("resolution", False, likely_resolution, of_one),
        ):
            yield self._knob(key, self.at[0].exact(key), more, likely=partial(needed, of, self.contact))

    def _of_wall(self, wall: Wall) -> Iterator[Knob]:
        whole = self.box[1]
        if isinstance(getattr(whole, "damping", None), Exact):
            b = ends(wall.damping)[0]
            usual = float(self.at[0].exact("damping")) or 1.0
            yield self._searched("virtual_damping", abs(b), False, usual, sign=-1 if b < 0 else 1)
        tau = getattr(getattr(whole, "velocity_filter", None), "time_constant", None)
        if isinstance(tau, Exact) and wall.damping != 0:
            between = partial(between_sizes, float(tau))
            yield self._searched("time_constant", tau.fraction, True, 0.0, between=between)

    def filtered(self, begin: float) -> Knob:
        """Of a one-pole filter in the place of that of the wall [s]; looked for from `begin` on."""
        knob = self._searched("time_constant", Fraction(begin), True, begin)
        return replace(knob, current=0.0, holds=self._proved("time_constant"))

    def _searched(self, key: str, now: Fraction, more: bool, other: float, **how: Any) -> Knob:
        """A knob of which secants say where its limit is likely; `other` as for `likely_value`."""
        change = partial(turned, self.at, key, sign=how.get("sign", 1))
        likely = partial(likely_value, change, self.contact, float(now), other, more)
        return self._knob(key, now, more, likely=likely, **how)

    def _knob(self, key: str, now: Fraction, more: bool, **how: Any) -> Knob:
        holds = self._proved(key, now, how.get("sign", 1))
        return Knob(key, float(now), holds, more, _OF.get(key, "") + in_words(key), **how)

    def _proved(self, key: str, now: Fraction | None = None, sign: int = 1) -> Holds:
        """Whether the loop with a value is proved passive; as it is, it is decided once for all knobs."""
        change = partial(turned, self.box, key, sign=sign)
        return lambda size: self._here if size == now else provable(change, size, self.contact)

    @cached_property
    def _in_samples(self) -> bool:
        """True where contact made and broken is proved, and with a delay half a sample longer never is."""
        device, law = self.at
        decision = decide(device, law)
        if decision.is_spring or not (self.contact or decision.is_clamped):
            return False
        longer = device.exact("delay") + device.exact("sample_period") / 2
        return decide(device.replace(delay=Exact(longer)), law).contact_damping is None

    @cached_property
    def _here(self) -> bool:
        return provable(lambda _: self.box, Fraction(0), self.contact)

    def is_confirmed(self, advice: Advice) -> bool:
        """Whether between the ends of intervals a value is proved as well, as the checker sees it."""
        if not isinstance(advice.to, float) or advice.to in (advice.current, inf):
            return True
        return self.covers(turned(self.box, advice.parameter, Exact(advice.to).fraction))

    def throughout(self, knob: Knob) -> Knob:
        """The same, to be turned until every value between the ends of intervals is proved."""

        def holds(size: Fraction) -> bool:
            return knob.holds(size) and self.covers(turned(self.box, knob.parameter, size, knob.sign))

        return replace(knob, holds=holds, likely=lambda: None)

    def covers(self, loop: Loop) -> bool:
        """Whether the checker finds it proved for all values of a loop that is provable at its corners."""
        if self.at == self.box:
            return True
        corners = worst_corners(*loop)
        proofs = certify_box(*loop, corners, [decide(*corner) for corner in corners])
        covered = None if proofs is None else Certificate(tuple(proofs)).covered()
        return covered is not None and not (self.contact and covered.contact == "kept")


Advised = Generator[Advice, None, tuple[Advice, ...]]


def advise(asked: Asked, passive: bool, or_kept: bool, stiffest: Guess) -> Advised:
    """Advice on every parameter of a loop: how far each may go of a `passive` one, else what to change.

    The easiest first, each looked for when it is asked for; in the end, from the device to the law, all of
    it.  With `or_kept` a proof of hands that keep contact is better than none, and better than a change that
    goes ten times as far; `stiffest` is the loop's `max_stiffness`, which is then not looked for twice.
    """
    first = dict(_turns(asked, passive, "" if asked.contact or not or_kept else _KEPT, stiffest))
    kept: dict[str, Iterator[Advice]] = {}
    if not passive and asked.contact and or_kept:
        kept = dict(_turns(replace(asked, contact=False), passive, _KEPT, lambda: None))
    whole: tuple[Advice, ...] = ()
    for turns in (first, kept):
        found: dict[str, list[Advice]] = {parameter: [] for parameter in turns}
        for parameter in sorted(turns, key=easiness):
            own = [*turns[parameter]]
            if any(_is_beyond(advice, advice.current) for advice in own):
                near = [*kept.get(parameter, ())]
                own = near if near and _is_beyond(own[0], near[0].to) else own
            found[parameter] = own
            yield from own
        whole = tuple(advice for turn in found.values() for advice in turn)
        if any(advice.to is not None for advice in whole):
            break
    return whole


def _is_beyond(advice: Advice, other: float | str | None) -> bool:
    """Whether it asks for ten times as much as another value, or for a tenth of it."""
    if not isinstance(advice.to, float) or not isinstance(other, float) or advice.to == other:
        return False
    if advice.parameter == "virtual_damping" and advice.to == 0:  # a bare spring, which anybody can render
        return False
    low, high = sorted((abs(advice.to), abs(other)))
    return high >= _TOO_FAR * low


_Turn = tuple[str, Iterator[Advice]]
"""A parameter, and what is advised of it, not looked for yet."""


def _turns(asked: Asked, passive: bool, hands: str, stiffest: Guess) -> Iterator[_Turn]:
    law = asked.at[1]
    for knob in asked.knobs(stiffest):
        yield knob.parameter, _turned(asked, passive, replace(knob, hands=hands))
    wall = wall_of(law)
    if not passive and wall is not None and wall.damping != 0:
        grain = COARSER if is_of_high_degree(*asked.at) else COARSE
        yield "velocity_filter", _estimators(asked, wall, hands, grain)


def _turned(asked: Asked, passive: bool, knob: Knob) -> Iterator[Advice]:
    kind: Kind = "slack" if passive else "change"
    motion, is_high = asked.at[0].motion, is_of_high_degree(*asked.at)
    if is_high:  # to find where a limit is likely takes as long as to find it
        knob = replace(knob, likely=lambda: None)
    turns = turn_all([knob], motion, kind, COARSER if is_high else COARSE)
    if not (passive or all(map(asked.is_confirmed, turns))):  # proved at the corners, and not between
        turns = turn_all([asked.throughout(knob)], motion, kind, COARSER)
    yield from filter(asked.is_confirmed, turns)


def turned(loop: Loop, key: str, value: Fraction, sign: int = 1) -> Loop:
    """The loop with a value of one of its parameters; an interval with its worse end there."""
    device, law = loop
    if key == "stiffness":
        return device, law.replace(stiffness=_moved(law.stiffness, value, False))  # type: ignore[attr-defined]
    if key == "virtual_damping":
        return device, law.replace(damping=Exact(sign * value))
    if key == "time_constant":
        return device, law.replace(velocity_filter=OnePole(Exact(value)))
    if key == "rate" and not isinstance(device.sample_period, Interval):
        return device.replace(rate=Exact(value)), law
    if key == "rate":
        key, value = "sample_period", 1 / value
    more = key in ("damping", "coulomb_friction")
    return device.replace(**{key: _moved(getattr(device, key), value, more)}), law


def _moved(now: Exact | Interval, value: Fraction, more: bool) -> Exact | Interval:
    """A value, or an interval with its worse end there; one value where its other end would be worse."""
    if not isinstance(now, Interval):
        return Exact(value)
    low, high = ends(now)
    if more:
        return Exact(value) if value >= high else Interval(Exact(value), now.high)
    return Exact(value) if value <= low else Interval(now.low, Exact(value))


def _estimators(asked: Asked, wall: Wall, hands: str, grain: int) -> Iterator[Advice]:
    """Another velocity estimator that makes the loop passive, if one of the usual does."""
    now = wall.velocity_filter.describe()
    device, law = asked.box

    def told(to: str, of: str = "") -> Advice:
        text = f"estimate velocity with a {to}{of} instead of the {now}{hands}"
        return Advice("velocity_filter", now, to, "", "change", text)

    for samples in _WINDOWS:
        other = device, law.replace(velocity_filter=Window(samples))
        if provable(lambda _, other=other: other, Fraction(0), asked.contact) and asked.covers(other):  # type: ignore[misc]
            yield told(f"window of {samples} samples")
            break
    if wall.velocity_filter.time_constant is None:
        period = float(ends(device.sample_period)[1])
        knob = asked.filtered(period)
        first = next((t for t in (period * 2**power for power in range(10)) if knob.proves(t)), None)
        tau = first and smallest_holding(knob.holds, first, grain, knob.likely())
        if tau is not None and asked.covers(turned(asked.box, "time_constant", Exact(tau).fraction)):
            yield told(f"one-pole filter of {shown(outward(tau, knob), 's')}", " (time constant)")


# A nonlinear spring (`formulas.nonlinear_spring`): its stiffness is its steepest slope s, and a softer one
# has all its forces scaled.  That no value of a number alone is proved does not say that none would do, so
# that those are left out.


_FEW_POINTS = 60
"""Up to which advice counts on what Coulomb friction pays: each value of each number is checked."""


def binding_of_spring(device: Device, needs: Sequence[Need]) -> str:
    """The condition of which least is left, or most is missing."""
    worst = min(needs, key=lambda need: (need.has - need.needed) / (need.needed or 1.0))
    if worst.name == "coulomb_friction":
        return QUANTIZATION
    return DELAY if 2 * device.exact("delay") > device.exact("sample_period") else SAMPLING


def advise_on_spring(device: Device, spring: Environment, passive: bool) -> tuple[Advice, ...]:
    """Advice on every number of a certain device and on the steepest slope.

    `device`: whose parameters are no intervals; `spring`: that is given by points; `passive`: True to say how
    far each number may go, False for what to change.
    """
    kind = "slack" if passive else "change"
    found = []
    for knob, at in _knobs(device, spring):
        for advice in turn_all([knob], device.motion, kind):  # type: ignore[arg-type]
            if not isinstance(advice.to, float):
                continue
            if advice.to == inf or certify_spring(*at(Exact(advice.to).fraction)).covered() is not None:
                found.append(advice)
    return tuple(found)


def _knobs(device: Device, spring: Environment) -> Iterator[tuple[Knob, Callable[[Fraction], Loop]]]:
    def of_device(key: str) -> Callable[[Fraction], Loop]:
        return lambda value: (device.replace(**{key: Exact(value)}), spring)

    now = float(device.exact("sample_period") ** -1)
    between = partial(between_rates, now, float(device.exact("delay")))
    at = of_device("rate")
    yield Knob("rate", now, partial(_is_enough, at), True, "rate", between=between), at
    for key, more in (("damping", True), ("coulomb_friction", True), ("resolution", False)):
        name, at = _OF.get(key, "") + in_words(key), of_device(key)
        yield Knob(key, float(device.exact(key)), partial(_is_enough, at), more, name), at
    steepest = spring_need(device, spring).steepest
    if steepest > 0:

        def scaled(slope: Fraction) -> Loop:
            forces = [Exact(f.fraction * slope / steepest) for _, f in spring.points]
            return device, NonlinearSpring(positions=[x for x, _ in spring.points], forces=forces)

        holds = partial(_is_enough, scaled)
        yield Knob("stiffness", float(steepest), holds, False, "steepest slope"), scaled


def _is_enough(at: Callable[[Fraction], Loop], value: Fraction) -> bool:
    """The conditions, in exact numbers, or that friction pays; a value that cannot be built is not enough."""
    try:
        device, spring = at(value)
        need = spring_need(device, spring)
    except (InputError, ZeroDivisionError):
        return False
    b, friction = device.exact("damping"), device.exact("coulomb_friction")
    if not need.bounded or friction < need.coulomb_friction:
        return False
    few = len(spring.points) <= _FEW_POINTS and device.exact("delay") == 0
    return need.spare(b) >= 0 or (few and certify_spring(device, spring).covered() is not None)
