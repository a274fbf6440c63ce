"""The one number of a coupling to change: four fifths of the largest value that is proved passive."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import fmean

from zwidth.data.diagnosis.change import PASSIVE, Lowered, largest, lowered_to, text_of, with_margin
from zwidth.data.diagnosis.pairs.energy import PairEvidence
from zwidth.errors import InputError
from zwidth.model.pairs import Pair
from zwidth.model.rendering.friction_compensation import FrictionCompensation
from zwidth.passivity.check import check
from zwidth.passivity.pairs.verdict import PairVerdict
from zwidth.quantity.glossary import GLOSSARY

_PARAMETERS = {
    "link delay": ("stiffness", "damping"),
    "sampling": ("stiffness", "damping"),
    "delay": ("stiffness", "damping"),
    "damping": ("damping", "stiffness"),
    "local damping": ("local_damping", "stiffness"),
    "friction compensation": ("compensation",),
    "actuator limit": ("stiffness",),
}
_NAMES = {
    "stiffness": ("stiffness of the coupling", "stiffness"),
    "damping": ("damping against the other arm", "virtual_damping"),
    "local_damping": ("local damping", "virtual_damping"),
    "compensation": ("compensated Coulomb friction", "coulomb_friction"),
}
_SLOWEST = 0.05
"""Of the usual speed of the arms: over which a sign becomes a tanh, for a proof."""


@dataclass(frozen=True, kw_only=True)
class PairChange(Lowered):
    """One number of the coupling, from where it is to where it may be."""

    pair: Pair
    """With that number changed."""
    verdict: PairVerdict


def change_for(cause: str, seen: PairEvidence, pair: Pair) -> PairChange | None:
    """The change that takes a cause away; None where no single number does, or none is proved."""
    gains = _gains(seen)
    for key in _PARAMETERS[cause]:
        current = gains[key]
        if current <= 0:
            continue
        top = min(current, _followed(seen)) if cause == "actuator limit" else current
        to = _limit(pair, gains, seen) if key == "stiffness" and top == current else None
        if to is None:
            to = largest(lambda value, key=key: _verdict(pair, gains | {key: value}, seen), top)  # type: ignore[misc]
        if to is None:
            continue
        changed = _built(pair, gains | {key: to}, seen)
        name, quantity = _NAMES[key]
        unit = GLOSSARY[quantity].unit_for("rotary" if seen.rotary else "linear")
        return PairChange(
            parameter=key,
            current=current,
            to=to,
            unit=unit,
            text=lowered_to(name, current, to, unit),
            pair=changed,
            verdict=check(changed),
        )
    return None


def _followed(seen: PairEvidence) -> float:
    """The stiffness whose force the motors can follow in this motion, the arms against each other."""
    apart = seen.vibration.angular * sum(seen.amplitudes)
    return min(rate for rate in seen.rates if rate is not None) / apart


def _limit(pair: Pair, gains: dict[str, float], seen: PairEvidence) -> float | None:
    """The stiffness by the verdict's own limit, where it is proved with it; None where that helps nothing."""
    verdict = _verdict(pair, gains, seen)
    limit = None if verdict is None else verdict.largest_stiffness
    if not limit:
        return None
    to = with_margin(min(limit, gains["stiffness"]))
    softer = _verdict(pair, gains | {"stiffness": to}, seen) if to > 1e-3 * gains["stiffness"] else None
    return to if softer is not None and softer.outcome in PASSIVE else None


def _gains(seen: PairEvidence) -> dict[str, float]:
    """Of the leader's side; a term that hardly does anything in a cycle is none."""
    leader = seen.laws[0]
    assert leader is not None
    most = max(abs(work) for work in seen.supplied.values())
    found = {
        "stiffness": leader.stiffness,
        "damping": leader.damping,
        "local_damping": leader.local_damping,
        "compensation": leader.compensation,
    }
    terms = {"damping": "damping", "local_damping": "local damping", "compensation": "friction compensation"}
    return {
        key: 0.0 if key in terms and abs(seen.supplied[terms[key]]) < 0.01 * most else value
        for key, value in found.items()
    }


def _built(pair: Pair, gains: dict[str, float], seen: PairEvidence) -> Pair:
    leader, follower = seen.laws
    assert leader is not None
    assert follower is not None
    devices = [
        device if late is None or rate is not None else device.replace(delay=text_of(late))
        for device, late, rate in zip((pair.leader, pair.follower), seen.delays, seen.rates, strict=True)
    ]
    ratio = follower.stiffness / leader.stiffness
    helped = gains["compensation"]
    return Pair(
        *devices,
        stiffness=text_of(gains["stiffness"]),
        damping=text_of(gains["damping"]),
        local_damping=text_of(gains["local_damping"]),
        follower_stiffness=text_of(ratio * gains["stiffness"]) if abs(ratio - 1) > 0.02 else None,
        delay=(text_of(follower.link_delay), text_of(leader.link_delay)),
        compensation=FrictionCompensation(coulomb=text_of(helped), speed=text_of(_speed(seen)))
        if helped
        else None,
    )


def _speed(seen: PairEvidence) -> float:
    return _SLOWEST * seen.vibration.angular * fmean(seen.amplitudes)


def _verdict(pair: Pair, gains: dict[str, float], seen: PairEvidence) -> PairVerdict | None:
    try:
        return check(_built(pair, gains, seen))
    except InputError:
        return None
