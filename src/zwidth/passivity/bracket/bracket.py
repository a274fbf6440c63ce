"""A bracket: the last value of a parameter that is proved passive, and the first that is refuted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from fractions import Fraction
from math import inf
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.result import Result, evidence_of
from zwidth.passivity.scope import Scope
from zwidth.passivity.storage.chain_document import ChainStorage
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.storage_function import StorageFunction
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import describe_hands, lines
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import at_least, at_most, in_words, shown


@dataclass(frozen=True, repr=False)
class Bracket(Result):
    """The last value of a parameter that is proved passive, and the first that is refuted."""

    margin = None  # it is the limit itself, and asks of no value whether it is proved
    _FORMAT = "zwidth limit 1"
    _PICTURE = "limit_figure"
    _BESIDES = (
        (
            "proved_passive_N_per_m, proved_active_N_per_m",
            "the two sides, in the unit of the parameter; null where none was found",
        ),
        ("every_hand_N_per_m", "the two sides for hands without bounds, as far as they are known"),
        ("certificate", "the proof at the one value; a `storage` certificate only in a saved file"),
        ("violation, witness", "the violation and the motion at the other, or one of them"),
    )

    parameter: str = answered('which: `"environment.stiffness"`, `"device.damping"`, …')
    unit: str = known("its SI unit")
    proved_passive: float | None = known("proved passive; None where no such value was found")
    proved_active: float | None = known("refuted; likewise")
    certificate: Certificate | None = known("the proof at the one value")
    witness: Gain | Witness | None = known("the motion at the other")
    scope: Scope = answered(
        "what it is about: every hand, or hands within bounds; contact; what of the actuator is counted"
    )
    every_hand: tuple[float | None, float | None] = known(
        "what is known of every hand, where the bracket is about bounded ones: the last value proved passive "
        "and the first refuted; None where there is none"
    )
    evaluations: int = answered("loops decided")
    seconds: float = known("the time that took", unit="s")
    storage: StorageFunction | ChainStorage | None = known(
        "the storage function at `proved_passive`, to look at; None where a closed condition proves it",
        default=None,
    )
    bounds: HandBounds | None = known(
        "the bounds on the hand, exact; None where the bracket is about every hand", default=None
    )
    violation: Violation | None = known(
        "what of the linear criterion is violated at `proved_active`, where closed conditions found it",
        default=None,
    )
    beyond: str = known(
        "where a side is open because no proof has room for a value further on: that value, and why",
        default="",
    )
    cut_by_time: bool = answered(
        "true where a time that was given ended the search, and another machine may find a closer one; not "
        "there otherwise",
        optional=True,
        default=False,
    )

    every_value: bool = known(
        "whether every value is proved passive: what proves this one proves them", default=False
    )

    @property
    def outcome(self) -> str:
        """ "bracketed", with a value on each side; "one side"; or "undecided"."""
        sides = [side is not None for side in (self.proved_passive, self.proved_active)]
        return ("undecided", "one side", "bracketed")[sum(sides)]

    @property
    def claim(self) -> str:
        """The bracket in a sentence."""
        return self.describe()

    @property
    @answers()
    def hand(self) -> str:
        """The hands that the bracket is about, in words: "every hand", or bounds."""
        return describe_hands(self.scope.hands, self.scope.motion)

    @property
    @answers()
    def assumptions(self) -> tuple[str, ...]:
        """What the proof covers and takes for granted, line by line."""
        return lines(self.scope)

    @property
    @answers("of the bracket; null where a side is missing", finite=True)
    def relative_width(self) -> float:
        """|proved_active − proved_passive| over the larger of the two; inf where one is missing."""
        if self.proved_passive is None or self.proved_active is None:
            return inf
        return abs(self.proved_active - self.proved_passive) / max(self.proved_active, self.proved_passive)

    def outward(
        self, values: tuple[float | None, float | None], digits: int = 6
    ) -> tuple[float | None, float | None]:
        """A proved and a refuted value so rounded that each still is: away from what is between them."""
        sides = (at_least, at_most) if more_is_safer(self.parameter) else (at_most, at_least)
        proved, refuted = (side(v, self.unit, digits) for side, v in zip(sides, values, strict=True))
        return proved, refuted

    def describe(self) -> str:
        """The bracket in a sentence."""
        name = in_words(self.parameter).replace("environment.", "").replace(".", " ")
        if self.every_value:
            return f"{name}: every value is proved passive"
        if self.proved_passive is None and self.proved_active is None:
            given = "in the time given" if self.cut_by_time else "with the effort given"
            return f"{name}: nothing was decided {given}"
        ends = self.outward((self.proved_passive, self.proved_active))
        passive, active = (shown(value, self.unit, 6) for value in ends)
        beyond = f"; {self.beyond}" if self.beyond else ""
        if self.proved_active is None:
            return f"{name}: {passive} is proved passive, and nothing is refuted{beyond}"
        if self.proved_passive is None:
            return f"{name}: no value is proved passive; {active} is active{beyond}"
        return f"{name}: {passive} is proved passive, {active} is active, for {self.hand}"

    def to_dict(self) -> dict[str, Any]:
        """Values, assumptions and evidence as plain data."""
        suffix = unit_suffix(self.unit)
        return {
            **super().to_dict(),
            f"proved_passive_{suffix}": self.proved_passive,
            f"proved_active_{suffix}": self.proved_active,
            f"every_hand_{suffix}": list(self.every_hand),
            **evidence_of(self),
        }


# The numbers of a loop of which a limit can be sought, and how each is changed.


Loop = tuple[Device, Environment]

MORE_IS_SAFER = frozenset({"damping", "coulomb_friction", "rate"})
"""Parameters of a device of which a loop needs enough; of all others it may have too much."""

_MORE_OF_A_LAW_IS_SAFER = frozenset({"virtual_mass"})  # the same of an environment
_NO_PART = {
    "mass": "a hand without a limit on its force moves every mass as it likes",
    "stiction": "only sliding friction is counted",
    "friction_speed": "a claim names it, no bound contains it",
    "motor_inductance": "the actuator is taken to give every force at once",
    "supply_voltage": "the actuator is taken to give every force at once",
    "current_limit": "the actuator is taken to give every force at once",
}
_NO_PART_BEHIND = {"handle_mass": _NO_PART["mass"], "handle_coulomb_friction": "a large motion outweighs it"}


def refuse_without_part(key: str, force_limit: bool, force_resolution: bool) -> None:
    """Refuse a parameter on which no outcome depends."""
    if key in _NO_PART:
        raise InputError(
            f"{key} plays no part, so it has no limit: {_NO_PART[key]}. Ask for damping, coulomb_friction, "
            "resolution, delay or rate of the device, or for a parameter of the environment"
        )
    counted = {"force_limit": force_limit, "force_resolution": force_resolution}
    if not counted.get(key, True):
        option = f"--count-{key.replace('_', '-')}"
        raise InputError(f"{key} plays no part unless it is counted in: give {key}=True, {option}")


class Parameter(NamedTuple):
    """One number of the loop: its unit, its value or a first guess, and the loop with another value."""

    name: str
    unit: str
    now: float
    change: Callable[[Exact], Loop]
    more_is_safer: bool = False
    least: Exact | None = None  # where what is proved may be proved of every value

    def proves_more(self, verdict: Any) -> bool:
        """Whether a proof at the least value is one of every other.

        More of b₂ is always safer; of the others it is where what the motor feels pays for all.
        """
        if getattr(verdict, "outcome", "") != "passive":
            return False
        return self.name == "transmission.handle_damping" or verdict.scope.transmission == "any"


def parameter_of(device: Device, environment: Environment, name: str) -> Parameter:
    """The parameter that is asked for, one of a rendered environment included; the laws follow it."""
    owner, _, key = name.rpartition(".")
    met = environment.met
    in_environment = {f.name for f in fields(met)} - {"exponent", "sample_period"}  # unit of K; the device's
    in_device = {*parameters_of(type(device)), "rate"}
    if key == "gain" and met.scaled(Fraction(1)) is not None:
        return _gain(device, environment)
    if owner in ("", "environment") and key in in_environment:
        return _of_environment(device, environment, key)
    if owner in ("", "device") and key in in_device:
        return _of_device(device, environment, key)
    if owner == "transmission" and device.transmission is not None:
        return _of_transmission(device, environment, key)
    gain = "" if met.scaled(Fraction(1)) is None else ", and gain, a factor on its force"
    raise InputError(
        f"no parameter {name!r}: the environment has {', '.join(sorted(in_environment))}{gain}; the device "
        f"has {', '.join(sorted(in_device))}"
    )


def _gain(device: Device, environment: Environment) -> Parameter:
    """A factor on the force of the environment."""

    def change(value: Exact) -> Loop:
        scaled = environment.met.scaled(value.fraction)
        assert scaled is not None
        return device, environment.around(scaled)

    return Parameter("environment.gain", "1", 1.0, change)


def _of_environment(device: Device, environment: Environment, key: str) -> Parameter:
    met = environment.met
    now = getattr(met, key)
    if not isinstance(now, float):
        raise InputError(f"{key} is not one number: give an environment with a certain value of it")

    def change(value: Exact) -> Loop:
        return device, environment.around(met.replace(**{key: value}))

    unit = met.unit_of(key, device.motion)
    first = abs(float(now)) or _guess(device, key)
    return _parameter(f"environment.{key}", unit, first, change)


def _of_device(device: Device, environment: Environment, key: str) -> Parameter:
    motor = device.motor_side
    if key in ("rate", "sample_period") and getattr(environment.met, "sample_period", None) is not None:
        raise InputError(
            f"H(z) was made for one sample period, so no other {in_words(key)} can be asked for: give H(s), "
            "type transfer-function, ContinuousTransferFunction; or H(z) without its sample_period"
        )
    known = 1 / motor.exact("sample_period") if key == "rate" else motor.exact(key)

    def change(value: Exact) -> Loop:
        return device.replace(**{key: value}), environment

    now = float(known) or _guess(device, key)
    found = _parameter(f"device.{key}", device.unit(key), now, change)
    behind = device.transmission is not None and key == "damping"  # what lets through much may do without
    return found._replace(least=Exact(0)) if behind else found


def _of_transmission(device: Device, environment: Environment, key: str) -> Parameter:
    given = device.transmission
    assert given is not None
    if key in _NO_PART_BEHIND:
        raise InputError(f"transmission.{key} plays no part, so it has no limit: {_NO_PART_BEHIND[key]}")
    own = given.parameters()
    now = own.get(key)
    if not isinstance(now, Exact):
        raise InputError(f"transmission.{key} is no number that is known; it has {', '.join(own)}")

    def change(value: Exact) -> Loop:
        return device.replace(transmission=given.replace(**{key: value})), environment

    unit = device.unit("stiffness" if key == "stiffness" else "damping")
    least = now if key == "stiffness" else Exact(0)
    return Parameter(f"transmission.{key}", unit, float(now) or 1.0, change, True, least)


def _parameter(name: str, unit: str, now: float, change: Callable[[Exact], Loop]) -> Parameter:
    return Parameter(name, unit, now, change, more_is_safer(name))


def more_is_safer(name: str) -> bool:
    """Whether a loop needs enough of a parameter, and does not have too much of it."""
    owner, _, key = name.partition(".")
    return key in (MORE_IS_SAFER if owner == "device" else _MORE_OF_A_LAW_IS_SAFER)


def _guess(device: Device, key: str) -> float:
    """A first value of a parameter that is 0, from the device's other numbers."""
    device = device.motor_side
    b, f = device.exact("damping"), device.exact("coulomb_friction")
    t, step = device.exact("sample_period"), device.exact("resolution")
    sizes = {"stiffness": 2 * b / t, "damping": b, "coulomb_friction": f}
    fallback = {"stiffness": 2 * f / step if step else Fraction(1), "delay": t}
    return float(sizes.get(key, Fraction(0)) or fallback.get(key, Fraction(1)) or Fraction(1))
