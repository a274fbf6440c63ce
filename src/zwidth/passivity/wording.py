"""What a scope says in words, in full and in short: the one place where either is made.

Nothing reads these sentences again: whoever needs a fact takes it from the record.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from zwidth.passivity.scope import (
    OF_THE_LAW,
    Contact,
    Encoder,
    Hands,
    Law,
    Outcome,
    Sampling,
    Scope,
    Torque,
    Transmission,
)
from zwidth.quantity.exact import Interval
from zwidth.quantity.text import in_words, shown, told_quantity

NOT_FOUND = "Neither a proof nor a motion that takes energy out was found"
UNWRITTEN = "No motion that shows it was found short enough to be written down."


class _Said(NamedTuple):
    in_full: str
    in_short: str


def _alike(words: str) -> _Said:
    return _Said(words, words)


_CONTACT: dict[Contact, _Said] = {
    "made and broken": _Said("contact made and broken at any instant", "contact made and broken"),
    "kept": _Said(
        "contact is kept: the hand stays inside; making and breaking contact is not covered",
        "contact kept: making and breaking it is not covered",
    ),
    "both sides": _Said(
        "the law acts at every position: there is no contact to make or break; "
        "what a spring holds where the motion starts may come back and is not counted",
        "a law that acts at every position: what a spring holds where the motion starts may come back and is "
        "not counted",
    ),
}
_OF_A_MOTION: dict[Contact, _Said] = {
    "made and broken": _alike("the motion makes and breaks contact"),
    "kept": _Said(
        "the motion stays inside: a hand that keeps contact can make it", "the motion stays inside"
    ),
    "both sides": _Said(
        "the law acts at every position: there is no contact to make or break",
        "a law that acts at every position",
    ),
}
_ALSO = {
    "springs": "the same holds for every spring law of slope 0 to K that is 0 somewhere",
    "clamped": "also for a wall that is clamped so that it never pulls",
}
_LAW: dict[Law, _Said] = {
    "rounded coefficients": _Said(
        "H(z) has the coefficients of its discretization rounded to double precision",
        "coefficients of H(z) rounded to doubles",
    ),
    "rounded power": _Said("K uⁿ is rounded to {digits} digits, as no decimal writes it", "K uⁿ rounded"),
    "table": _Said(
        "the law is a table of its states and forces, as the simulator's compiled law gives them in doubles; "
        "the checker takes the table as it stands; zwidth verify steps the law again where a file has its "
        "parameters",
        "the law as a table of its states and forces",
    ),
    "doubles": _Said(
        "the law computes with doubles: every rounding is paid for, numbers below 1e-300 aside",
        "rounding of doubles counted, numbers below 1e-300 aside",
    ),
    "floats": _Said(
        "the law computes with floats: every rounding is paid for, numbers below 1e-36 aside",
        "rounding of floats counted, numbers below 1e-36 aside",
    ),
    "behind a coupling": _Said(
        "the scene gives out no energy of its own, by the way it is stepped, its rounding aside; "
        "the coupling is proved passive before every such environment; "
        "what scene and coupling hold at first may come back",
        "rounding of the scene aside; what scene and coupling hold at first may come back",
    ),
    "covered by a wall": _Said(
        "the laws add no more than the virtual damping of a wall, and that wall is proved",
        "the laws covered by the proof of a wall",
    ),
    "covered with less friction": _Said(
        "the laws add no more than the virtual damping of a wall and a part of Coulomb friction; "
        "that wall is proved with what is left of it",
        "the laws covered by the proof of a wall with less friction",
    ),
    "potential bounded below": _Said(
        "of springs: those whose potential is bounded below",
        "of springs, those whose potential is bounded below",
    ),
    "energy at first bounded": _Said(
        "environments that have stored no more than a bounded energy at first",
        "environments of a bounded energy at first",
    ),
    "any before the last": _Said(
        "any environment, and any laws before the last one of the chain",
        "any environment and laws before the last one",
    ),
}
AS_ONE = "motor, encoder and hand move as one"
TRANSMISSION = f"{AS_ONE}: no cable, belt or gear gives way between them"
_TRANSMISSION: dict[Transmission, _Said] = {
    "": _Said("", ""),
    "rigid": _Said(TRANSMISSION, AS_ONE),
    "any": _Said(
        "friction of the motor's side pays for all, with what damping inside and behind the transmission, as "
        "given, adds whatever the hand does: however stiff cable, belt or gear are, and whatever they move",
        "any stiffness between motor and hand",
    ),
    "as given": _Said(
        "motor and hand are joined by one spring and one damper, of the numbers that were given",
        "a transmission of the numbers given",
    ),
}
_TAKES: dict[Transmission, str] = {
    "": "the device", "rigid": "the device", "any": "what the motor moves", "as given": "the motor's side"
}  # fmt: skip
_HELD: dict[Transmission, str] = {
    "": "the device", "rigid": "the device", "any": "the device", "as given": "the hand's side"
}  # fmt: skip
_ENCODER: dict[Encoder, _Said] = {
    "ideal": _Said("ideal position sensor: no quantization", "ideal position sensor"),
    "counted": _Said(
        "encoder counts of one size, their phase against the surface unknown", "encoder steps counted"
    ),
    "not counted": _Said("encoder steps are left out", "encoder steps left out"),
}
_TORQUE: dict[Torque, _Said] = {
    "": _Said("", ""),
    "follows the arm": _alike("the torque follows the arm within a period"),
    "follows the readings": _Said(
        "the torque follows the readings of the encoders within a period",
        "the torque follows the encoders within a period",
    ),
    "held": _Said("the torque is computed once a sample and held", "the torque held over a sample"),
}
_SAMPLING: dict[Sampling, _Said] = {
    "constant": _Said(
        "a constant sample period and delay, no missed samples",
        "constant period and delay, no missed samples",
    ),
    "any": _alike("any sample period, delays and missed samples"),
}


def claim_of_passivity(scope: Scope, at_limit: bool) -> str:
    """The sentence of a proof, without its point."""
    hand = {"kept": "a hand that keeps contact"}.get(scope.contact, "the hand")
    if not scope.hands.every:
        return (
            "No motion of the hand within these bounds takes energy out of this loop, ever"
            f"{_for_any_value(scope)}{if_friction_goes_on(scope)}"
        )
    more = "; it is exactly at its limit, equality included" if at_limit else ""
    return f"{takes_none(hand, 'loop')}{_for_any_value(scope)}{if_friction_goes_on(scope)}{more}"


def takes_none(whose: str, out_of: str) -> str:
    """That none of whose motions takes energy out of what, without its point."""
    return f"No motion of {whose}, however fast or skilled, can take energy out of this {out_of}"


def takes_any(whose: str, out_of: str) -> str:
    """That whoever it is can take out more than any bound, without its point."""
    return f"{whose} can take any amount of energy out of this {out_of}"


def claim_of_a_motion(energy: float, seconds: float, depth: float, speed: float, unit: str) -> str:
    """The sentence of a motion that takes energy out [J; s; m, m/s or rad, rad/s], without its point."""
    taken = takes("the hand", energy, "loop", seconds)
    if is_beyond_hands(depth, speed, unit):
        return f"{taken}, although it is more than any hand does"
    return f"{taken}, although no hand goes on for so long" if seconds > LONGEST_OF_HANDS else taken


def takes(whose: str, energy: float, out_of: str, seconds: float) -> str:
    """Of whose motion, how much it takes out each time [J], and how long it is [s], without its point."""
    return f"{takes_once(whose, energy, out_of, seconds)}, each time it is made"


def takes_once(whose: str, energy: float, out_of: str, seconds: float) -> str:
    """The same of one that begins at rest."""
    return f"A motion of {whose} takes {shown(energy, 'J')} out of this {out_of} in {shown(seconds, 's')}"


LARGEST_OF_HANDS = {"m": (1.0, 10.0), "rad": (20.0, 200.0)}
"""How far, and how fast, a hand goes at most [m, m/s; rad, rad/s]."""

LONGEST_OF_HANDS = 60.0
"""How long it goes on with a fast and regular motion [s]."""


def is_beyond_hands(depth: float, speed: float, unit: str) -> bool:
    """Whether a motion is deeper [m; rad] or faster than any hand's."""
    far, fast = LARGEST_OF_HANDS[unit]
    return depth > far or speed > fast


def size(depth: float, speed: float, unit: str) -> str:
    """How deep and how fast a motion is, and whether no hand does that."""
    beyond = ", more than any hand does" if is_beyond_hands(depth, speed, unit) else ""
    return f"to {shown(depth, unit)} at up to {shown(speed, f'{unit}/s')}{beyond}"


def _for_any_value(scope: Scope) -> str:
    names = ["value of the environment" if n == OF_THE_LAW else in_words(n) for n in scope.intervals]
    if not names:
        return ""
    if len(names) == 1:
        return f", for any {names[0]} within its range"
    return f", for any {', '.join(names[:-1])} and {names[-1]} within their ranges"


def if_friction_goes_on(scope: Scope) -> str:
    """The condition of a claim about a device whose friction was measured up to some speed.

    Of hands with a bound on speed too: theirs is a mean over a sample.
    """
    if scope.friction is not None:
        return ""
    return _measured(scope, ", if friction beyond {}, where it was not measured, is no less than f_c + b |v|")


def lines(scope: Scope, outcome: str | None = None) -> tuple[str, ...]:
    """What a result covers and takes for granted, a line for each thing; of a motion what it does."""
    return tuple(_lines(scope, active=outcome == "active"))


def of_transmission(scope: Scope) -> str:
    """Of which transmission a proof is, in short; "" where motor and hand move as one."""
    return "" if scope.transmission == "rigid" else _TRANSMISSION[scope.transmission].in_short


def _lines(scope: Scope, active: bool) -> Iterator[str]:
    yield "; ".join(
        [
            (_OF_A_MOTION if active else _CONTACT)[scope.contact].in_full,
            *([f"the law is fed with the {scope.fed_with}"] if scope.fed_with else []),
            *(["the law never pulls: a force below 0 is given as 0"] if scope.clamped else []),
            *(_ALSO[more] for more in scope.also),
        ]
    )
    if scope.region is not None:
        yield f"the arm stays in its region, {scope.region}"
    if not scope.hands.every and not active:
        yield f"a proof covers {describe_hands(scope.hands, scope.motion)}"
    yield from _losses(scope)
    if scope.hands.impedance is None:
        speed = "speed and force" if scope.hands.speed is None or active else "force"
        limit = "limits on" if " and " in speed else "limit on"
        yield f"a hand without {limit} {speed}; the mass of {_HELD[scope.transmission]} plays no part"
    yield _actuator(scope)
    if scope.transmission:
        yield _TRANSMISSION[scope.transmission].in_full
    if scope.torque:
        yield _TORQUE[scope.torque].in_full
    if scope.largest_force is not None:
        yield _forces(scope)
    yield _SAMPLING[scope.sampling].in_full
    yield _ENCODER[scope.encoder].in_full
    yield from (f"{in_words(key)} was not given and taken as 0" for key in scope.assumed)
    yield from map(_of_the_law, scope.law)


def _of_the_law(note: Law) -> str:
    if note != "rounded power":
        return _LAW[note].in_full
    from zwidth.model.environment.nonlinear import DIGITS  # few loops have such a contact

    return _LAW[note].in_full.format(digits=DIGITS)


def intervals(scope: Scope, outcome: Outcome) -> str | None:
    """The line that stands beside a loop with intervals."""
    if not scope.intervals:
        return None
    within = {
        name: f"{in_words(name)} {told_quantity(Interval(*ends), name, scope.motion, 4)}"
        for name, *ends in scope.bounds
    }
    values = ", ".join(within.get(name, "each interval of the environment") for name in scope.intervals)
    holds = "" if outcome == "undecided" else "holds for every value "
    numbers = "numbers and motion" if outcome == "active" else "numbers"
    return f"{holds}within {values}; {numbers} are of the worst corner"


def _losses(scope: Scope) -> Iterator[str]:
    if scope.friction is not None:
        yield f"the device takes out what its friction curve says; {scope.friction.assumption}"
    elif scope.damping is not None:
        b = told_quantity(scope.damping, "damping", scope.motion)
        taken = f"the device takes out b = {b} of viscous friction; Coulomb friction is left out"
        if scope.coulomb_friction is not None:
            dry = told_quantity(scope.coulomb_friction, "force", scope.motion)
            whose = _TAKES[scope.transmission]
            taken = f"{whose} takes out at least b = {b} of viscous and f_c = {dry} of Coulomb friction"
        yield taken + _measured(
            scope, "; it was measured up to {}, for faster motions the same is taken for granted"
        )


def _measured(scope: Scope, words: str) -> str:
    """The words with the speed up to which friction was measured; "" where that is not known."""
    if scope.friction_speed is None:
        return ""
    return words.format(told_quantity(scope.friction_speed, "friction_speed", scope.motion))


def _actuator(scope: Scope) -> str:
    """What of the actuator is in it."""
    counted, left = _counted(scope, True), _counted(scope, False)
    rest = ", ".join([*left, "current rise and added filters"])
    if not counted:
        return f"ideal actuator: {rest} are not in the claim"
    verb = "is" if counted == ["force limit"] else "are"
    return f"the {' and the '.join(counted)} {verb} counted in; {rest} are not"


def _counted(scope: Scope, is_counted: bool) -> list[str]:
    """What of the actuator may be in a proof, and is or is not."""
    parts = {"force limit": scope.force_limit, "converter steps": scope.force_steps}
    return [name for name, value in parts.items() if value == is_counted]


def describe_hands(hands: Hands, motion: str) -> str:
    """The hands that a result is about, in words."""
    if hands.impedance is not None:
        return f"a hand that is known: {hands.impedance}"
    if hands.activity is not None:
        where = "" if hands.below is None else f" below {shown(hands.below, 'Hz', 6)}"
        most = told_quantity(hands.activity, "damping", motion)
        return f"hands that give out at most {most}{where} of their motion"
    bounds = []
    if hands.speed is not None:
        over = "each part of a sample with one force" if hands.in_each_part else "one sample"
        bounds.append(
            f"up to {told_quantity(hands.speed, 'friction_speed', motion, 4)} over {over}"
            + _counts(hands.counts_a_sample, " a sample")
        )
    if hands.inside is not None:
        counts = _counts(hands.counts_inside)
        far = told_quantity(hands.inside, "position", motion, 4)
        bounds.append(f"up to {far}{counts} {_sides(hands, motion)}")
    return f"hands of {', '.join(bounds)}" if bounds else "every hand"


def _counts(counts: float | None, per: str = "") -> str:
    """The same in counts of the encoder."""
    return "" if counts is None else f" ({counts:.4g} counts{per})"


def _sides(hands: Hands, motion: str) -> str:
    if hands.outside is None:
        return "inside and any distance outside"
    if hands.inside is not None and hands.outside == hands.inside:
        return "on either side"
    return f"inside and {told_quantity(hands.outside, 'position', motion, 4)} outside"


# In short: numbers and reasons may be left out, and nothing that makes a claim narrower.


def in_short(scope: Scope, outcome: str | None = None, hands: bool = True) -> str:
    """What a result takes for granted, in one paragraph; of a motion what it does.

    `hands` is False where the hands stand elsewhere in the report.
    """
    return "; ".join(part for part in _short_parts(scope, outcome == "active", hands) if part)


def _short_parts(scope: Scope, active: bool, hands: bool) -> Iterator[str]:
    yield (_OF_A_MOTION if active else _CONTACT)[scope.contact].in_short
    yield f"the law fed with the {scope.fed_with}" if scope.fed_with else ""
    yield "the law never pulls" if scope.clamped else ""
    yield f"the arm in its region, {scope.region}" if scope.region is not None else ""
    if hands:
        yield from _short_hands(scope, active)
    yield _short_losses(scope)
    counted = " and ".join(_counted(scope, True))
    yield f"{counted} counted, else an ideal actuator" if counted else "ideal actuator"
    yield _TRANSMISSION[scope.transmission].in_short
    yield _TORQUE[scope.torque].in_short
    yield _forces(scope)
    yield _SAMPLING[scope.sampling].in_short
    yield _ENCODER[scope.encoder].in_short
    if scope.assumed:
        yield f"{', '.join(map(in_words, scope.assumed))} not given, taken as 0"
    yield from (_LAW[note].in_short for note in scope.law)


def _short_hands(scope: Scope, active: bool) -> Iterator[str]:
    """A motion that was found is of a hand that is fast and strong enough to make it."""
    bounded = not scope.hands.every and not active
    if bounded:
        yield f"only {describe_hands(scope.hands, scope.motion)}"
    if scope.hands.impedance is None:
        fast = bounded and scope.hands.speed is not None
        yield "hands of any force" if fast else "hands of any speed and force"


def _short_losses(scope: Scope) -> str:
    if scope.friction is not None:
        return "friction not below its measured curve, continued beyond its ends"
    parts = []
    if scope.damping is not None:
        parts.append(f"b = {told_quantity(scope.damping, 'damping', scope.motion)}")
        if scope.coulomb_friction is not None:
            parts.append(f"f_c = {told_quantity(scope.coulomb_friction, 'force', scope.motion)}")
    if not parts:
        return ""
    left_out = "" if scope.coulomb_friction is not None else ", Coulomb friction left out"
    measured = _measured(scope, ", measured up to {} and taken for granted beyond")
    return f"at least {', '.join(parts)} in the device{left_out}{measured}"


def _forces(scope: Scope) -> str:
    if scope.largest_force is None:
        return ""
    most = scope.largest_moment
    moment = "" if most is None else f" and moments up to {shown(most, 'N*m', 6)}"
    return f"forces of the wall up to {told_quantity(scope.largest_force, 'force', scope.motion)}{moment}"
