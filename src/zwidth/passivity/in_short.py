"""What limits a claim, in a few words for each thing: `wording` says the same in full.

A short report may leave out numbers and reasons, and nothing that makes the claim narrower.  So the words
here are made from the same record, and a test goes through all of its entries.
"""

from __future__ import annotations

from collections.abc import Iterator

from zwidth.passivity.scope import Contact, Encoder, Law, Sampling, Scope, Torque
from zwidth.passivity.wording import AS_ONE, describe_hands
from zwidth.quantity.text import in_words, told_quantity

_CONTACT: dict[Contact, str] = {
    "made and broken": "contact made and broken",
    "kept": "contact kept: making and breaking it is not covered",
    "both sides": (
        "a law that acts at every position: what a spring holds where the motion starts may come back and is "
        "not counted"
    ),
}
_OF_A_MOTION: dict[Contact, str] = {
    "made and broken": "the motion makes and breaks contact",
    "kept": "the motion stays inside",
    "both sides": "a law that acts at every position",
}
_LAW: dict[Law, str] = {
    "rounded coefficients": "coefficients of H(z) rounded to doubles",
    "rounded power": "K uⁿ rounded",
    "table": "the law as a table of its states and forces",
    "doubles": "rounding of doubles counted, numbers below 1e-300 aside",
    "floats": "rounding of floats counted, numbers below 1e-36 aside",
    "behind a coupling": "rounding of the scene aside; what scene and coupling hold at first may come back",
    "covered by a wall": "the laws covered by the proof of a wall",
    "covered with less friction": "the laws covered by the proof of a wall with less friction",
    "potential bounded below": "of springs, those whose potential is bounded below",
    "energy at first bounded": "environments of a bounded energy at first",
    "any before the last": "any environment and laws before the last one",
}
_ENCODER: dict[Encoder, str] = {
    "ideal": "ideal position sensor",
    "counted": "encoder steps counted",
    "not counted": "encoder steps left out",
}
_TORQUE: dict[Torque, str] = {
    "": "",
    "follows the arm": "the torque follows the arm within a period",
    "follows the readings": "the torque follows the encoders within a period",
    "held": "the torque held over a sample",
}
_SAMPLING: dict[Sampling, str] = {
    "constant": "constant period and delay, no missed samples",
    "any": "any sample period, delays and missed samples",
}


def in_short(scope: Scope, outcome: str | None = None, hands: bool = True) -> str:
    """What a result takes for granted, in one paragraph; of a motion what it does.

    `hands` is False where the hands stand elsewhere in the report.
    """
    return "; ".join(part for part in _parts(scope, outcome == "active", hands) if part)


def _parts(scope: Scope, active: bool, hands: bool) -> Iterator[str]:
    yield (_OF_A_MOTION if active else _CONTACT)[scope.contact]
    yield f"the law fed with the {scope.fed_with}" if scope.fed_with else ""
    yield "the law never pulls" if scope.clamped else ""
    yield f"the arm in its region, {scope.region}" if scope.region is not None else ""
    if hands:
        yield from _hands(scope, active)
    yield _losses(scope)
    yield _actuator(scope)
    yield AS_ONE if scope.transmission else ""
    yield _TORQUE[scope.torque]
    yield _forces(scope)
    yield _SAMPLING[scope.sampling]
    yield _ENCODER[scope.encoder]
    if scope.assumed:
        yield f"{', '.join(map(in_words, scope.assumed))} not given, taken as 0"
    yield from (_LAW[note] for note in scope.law)


def _hands(scope: Scope, active: bool) -> Iterator[str]:
    """A motion that was found is of a hand that is fast and strong enough to make it."""
    bounded = not scope.hands.every and not active
    if bounded:
        yield f"only {describe_hands(scope.hands, scope.motion)}"
    if scope.hands.impedance is None:
        fast = bounded and scope.hands.speed is not None
        yield "hands of any force" if fast else "hands of any speed and force"


def _losses(scope: Scope) -> str:
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
    return f"at least {', '.join(parts)} in the device{left_out}{_measured(scope)}"


def _measured(scope: Scope) -> str:
    if scope.friction_speed is None:
        return ""
    speed = told_quantity(scope.friction_speed, "friction_speed", scope.motion)
    return f", measured up to {speed} and taken for granted beyond"


def _actuator(scope: Scope) -> str:
    parts = {"force limit": scope.force_limit, "converter steps": scope.force_steps}
    counted = [name for name, value in parts.items() if value]
    return f"{' and '.join(counted)} counted, else an ideal actuator" if counted else "ideal actuator"


def _forces(scope: Scope) -> str:
    if scope.largest_force is None:
        return ""
    moment = "" if scope.largest_moment is None else f" and moments up to {scope.largest_moment:.6g} N·m"
    return f"forces of the wall up to {told_quantity(scope.largest_force, 'force', scope.motion)}{moment}"
