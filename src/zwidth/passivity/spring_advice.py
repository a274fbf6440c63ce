"""What to change of a nonlinear spring's loop, or how far each of its numbers may go, and what binds.

    b ≥ (L/2 + d s) T, with a part of a sample somewhat more      f_c ≥ s Δ/2

are enough (`formulas.nonlinear_spring`); the stiffness of such a spring is its steepest slope s, and a softer
one has all its forces scaled.  Every value given was itself proved passive, all else as it was; that no value
of a number alone is proved does not say that none would do, so that those are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import inf

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.nonlinear import NonlinearSpring
from zwidth.passivity.advice import Advice
from zwidth.passivity.budget import DELAY, QUANTIZATION, SAMPLING
from zwidth.passivity.formulas.nonlinear_spring import certify_spring, spring_need
from zwidth.passivity.found import Need
from zwidth.passivity.knob import Knob, between_rates, turn_all
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import in_words

Loop = tuple[Device, Environment]


def binding_of_spring(device: Device, needs: Sequence[Need]) -> str:
    """The condition of which least is left, or most is missing."""
    worst = min(needs, key=lambda need: (need.has - need.needed) / (need.needed or 1.0))
    if worst.name == "coulomb_friction":
        return QUANTIZATION
    return DELAY if 2 * device.exact("delay") > device.exact("sample_period") else SAMPLING


def advise_on_spring(device: Device, spring: Environment, passive: bool) -> tuple[Advice, ...]:
    """Advice on every number of a certain device and on the steepest slope.

    Parameters
    ----------
    device
        Whose parameters are no intervals.
    spring
        That is given by points.
    passive
        True to say how far each number may go, False for what to change.
    """
    kind = "slack" if passive else "change"
    found = []
    for knob, at in _knobs(device, spring):
        for advice in turn_all([knob], device.motion, kind):  # type: ignore[arg-type]
            if isinstance(advice.to, float) and (advice.to == inf or _is_proved(at, advice.to)):
                found.append(advice)
    return tuple(found)


def _knobs(device: Device, spring: Environment) -> Iterator[tuple[Knob, Callable[[Fraction], Loop]]]:
    def of_device(key: str) -> Callable[[Fraction], Loop]:
        return lambda value: (device.replace(**{key: Exact(value)}), spring)

    def knob(key: str, now: float, at: Callable[[Fraction], Loop], more: bool, name: str) -> Knob:
        return Knob(key, now, lambda value: _is_enough(at, value), more, name)

    now = float(device.exact("sample_period") ** -1)
    rate = knob("rate", now, of_device("rate"), True, "rate")
    between = partial(between_rates, now, float(device.exact("delay")))
    yield replace(rate, between=between), of_device("rate")
    for key, more in (("damping", True), ("coulomb_friction", True), ("resolution", False)):
        name = {"damping": "device damping", "resolution": "encoder resolution"}.get(key, in_words(key))
        yield knob(key, float(device.exact(key)), of_device(key), more, name), of_device(key)
    steepest = spring_need(device, spring).steepest
    if steepest > 0:

        def scaled(slope: Fraction) -> Loop:
            forces = [Exact(f.fraction * slope / steepest) for _, f in spring.points]
            return device, NonlinearSpring(positions=[x for x, _ in spring.points], forces=forces)

        yield knob("stiffness", float(steepest), scaled, False, "steepest slope"), scaled


def _is_enough(at: Callable[[Fraction], Loop], value: Fraction) -> bool:
    """The two conditions, in exact numbers; a value that cannot be built is not enough."""
    try:
        device, spring = at(value)
        need = spring_need(device, spring)
    except (InputError, ZeroDivisionError):
        return False
    b, friction = device.exact("damping"), device.exact("coulomb_friction")
    return need.bounded and need.spare(b) >= 0 and friction >= need.coulomb_friction


def _is_proved(at: Callable[[Fraction], Loop], value: float) -> bool:
    """Whether the checker accepts the loop with this value."""
    return certify_spring(*at(Exact(value).fraction)).covered() is not None
