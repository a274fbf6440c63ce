"""What a person should know about an identified device, in sentences."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from zwidth.data.identification.device.choice import SURE
from zwidth.data.identification.device.estimate import Directions, Estimate, perhaps_none, unit_of
from zwidth.data.identification.device.fit import Found
from zwidth.data.logs import Finding
from zwidth.quantity.text import told_quantity

_SEEN = {
    "slow": "more friction at rest than f_c, as of lubricated contacts (Stribeck),",
    "spring": "a spring, or gravity on an arc,",
    "force_lag": "a force recorded late, or early where this is negative,",
}


_KINDS = {"slow": "Stribeck friction"}


def findings(
    found: Found,
    names: tuple[str, ...],
    estimates: Mapping[str, Estimate],
    directions: Directions,
    slopes: Directions,
    speed: float,
    period: float,
) -> Iterable[Finding]:
    """The wrong model first, then what is not known, then what was fitted besides."""
    yield from _model(found, names, estimates, period)
    if directions.difference.beyond(SURE):
        yield Finding(
            kind="damping by direction",
            text=f"damping differs by direction: {directions.inward} into the wall, {directions.outward} "
            "out of it; a hand may be quick one way and slow the other, so walls rest on the smaller",
        )
    yield from perhaps_none(estimates, ("damping", "coulomb_friction"))
    for name, what in _SEEN.items():
        if name in estimates:
            until = (
                f", gone at {told_quantity(found.moments.knee, 'friction_speed', found.motion, 3)}"
                if name == "slow"
                else ""
            )
            text = f"{what} is seen and fitted: {estimates[name]}{until}"
            yield Finding(kind=_KINDS.get(name, name.replace("_", " ")), text=text)
    yield from _bend(found, names, slopes, speed)


def _bend(found: Found, names: tuple[str, ...], slopes: Directions, speed: float) -> Iterable[Finding]:
    """Friction whose slope changes with speed."""
    if "coulomb_friction" not in names:
        return
    more = () if "slow" in names else ("slow",)
    if found.sees(names, "quadratic") or found.sees((*names, *more), "quadratic"):
        at = told_quantity(speed, "friction_speed", found.motion, 3)
        yield Finding(
            kind="bent friction",
            text=f"friction is not f_c + b |v|: at {at} its slope is {slopes.weaker}; "
            "what is proved rests on the largest model below the friction curve",
        )


def _model(
    found: Found, names: tuple[str, ...], estimates: Mapping[str, Estimate], period: float
) -> Iterable[Finding]:
    whole = (*(n for n in names if n != "coulomb_friction"), "coulomb_friction")
    full, viscous = found.regression(whole), found.regression(whole[:-1])
    if full is None or viscous is None:
        return
    stiffness, damping, force = (unit_of(n, found.motion) for n in ("spring", "damping", "coulomb_friction"))
    limits = [f"{2 * fit.value('damping') / period:.4g} {stiffness}" for fit in (viscous, full)]
    if "coulomb_friction" not in names:
        if found.sees(names, "coulomb_friction"):
            yield Finding(
                kind="wrong model",
                text="a mass and a damper are the wrong model: Coulomb friction of "
                f"{full.value('coulomb_friction'):.3g} {force} is seen; without it 2b/T reads {limits[0]} "
                f"instead of {limits[1]}: walls between the two would be called passive and are not",
            )
    elif estimates["coulomb_friction"].beyond(SURE):
        yield Finding(
            kind="Coulomb friction",
            text=f"Coulomb friction is seen; a mass–damper model of the same data would say b = "
            f"{viscous.value('damping'):.3g} {damping}, 2b/T = {limits[0]} instead of {limits[1]}",
        )
