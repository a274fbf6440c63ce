"""Mass, damping and Coulomb friction of a device from a log of its motion.

    m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a

in means over smooth pulses inside strokes (`pulses`), by least squares with the two halves of
the samples as each other's instruments (`moments`), with the scatter of the strokes as the
measure of uncertainty (`regression`).  Abbott & Okamura (2005, section IV-B) fit the same
equation to smoothed and differentiated positions.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Literal

import numpy as np

from zwidth.data.identification.device.choice import Zero, choose, too_little
from zwidth.data.identification.device.curve import fastest
from zwidth.data.identification.device.findings import findings
from zwidth.data.identification.device.fit import Found, gather
from zwidth.data.identification.device.identified import Identified
from zwidth.data.identification.device.impossible import refuse_impossible
from zwidth.data.identification.device.pulses import PIECES
from zwidth.data.identification.device.regression import offset
from zwidth.data.logs import Log
from zwidth.errors import InputError

Model = Literal["Coulomb and viscous", "viscous"]


def identify(
    log: Log,
    *,
    mass: float | None = None,
    delay: float = 0.0,
    zero: Zero | None = None,
    model: Model = "Coulomb and viscous",
    progress: Callable[[int, int], None] | None = None,
) -> Identified:
    """As `zwidth.identify`, with numbers in the place of texts: mass [kg; kg·m²], delay [s]."""
    zero = _checked(log, mass, delay, zero, model)
    own = (*(() if mass is not None else ("mass",)), "damping", "coulomb_friction")
    late = delay / log.sample_period

    def through(other: Log, progress: Callable[[int, int], None] | None = None) -> Found:
        choice = choose(other, own, mass, late, zero)
        return gather(other, choice, mass=mass, delay=late, zero=zero, progress=progress)

    found = through(log, progress)
    names = _terms(found, own, model)
    estimates, fit = found.estimates(names), found.regression(names)
    viscous = found.regression(tuple(n for n in names if n not in ("coulomb_friction", "slow")))
    if estimates is None or fit is None or viscous is None:
        raise InputError(too_little(log))
    seen = found.points.labelled(fit, mass, log.motion)
    quickest = fastest(seen)
    directions, slopes = found.directions(names), found.slopes(names, min(quickest))
    if directions is None or slopes is None or not min(quickest) > 0:
        raise InputError(too_little(log))
    refuse_impossible(log, estimates, lambda other: through(other).estimates(names))
    weights = found.shape.value / found.shape.piece
    return Identified(
        estimates=estimates,
        directions=directions,
        fastest=quickest,
        slopes=slopes,
        mass=mass,
        sample_period=log.sample_period,
        resolution=log.resolution,
        motion=log.motion,
        source=log.source,
        explained=fit.explained,
        force_noise=float(np.sqrt(fit.residual / np.sum(weights**2))),
        offset=offset(found.moments, fit, mass),
        viscous_alone=viscous.value("damping"),
        pulse_length=PIECES * found.shape.piece * log.sample_period,
        strokes=found.moments.strokes,
        pulses=found.moments.pulses,
        findings=(
            *log.findings,
            *findings(found, names, estimates, directions, slopes, min(quickest), log.sample_period),
        ),
        seen=seen,
    )


def _terms(found: Found, own: tuple[str, ...], model: Model) -> tuple[str, ...]:
    """What is fitted: friction as it was asked for, and what else is seen."""
    friction = own if model == "Coulomb and viscous" else own[:-1]
    spring = ("spring",) if found.sees(own, "spring") else ()
    slow = ("slow",) if friction == own and found.sees((*own, "quadratic"), "slow") else ()
    return (*friction, *spring, *slow, *(("force_lag",) if found.late else ()))


def _checked(log: Log, mass: float | None, delay: float, zero: Zero | None, model: str) -> Zero:
    if model not in ("Coulomb and viscous", "viscous"):
        raise InputError(f'model is "Coulomb and viscous" or "viscous", got {model!r}')
    if not log.channels and mass is None:
        raise InputError(
            f"{log.source} has no force: a free motion shows b/m and f_c/m only; give the mass "
            "(a kitchen scale will do), or log the force of the hand or of the actuator"
        )
    if mass is not None and not 0 < mass < inf:
        raise InputError(f"mass must be > 0 and finite, got {mass!r}: it is what the force accelerates")
    if not 0 <= delay < inf:
        raise InputError(f"delay must be ≥ 0 s, got {delay!r}: the force follows the sample it came from")
    if zero is None:
        return "drifts" if "hand_force" in log.channels else "constant"
    if zero not in ("drifts", "constant", "exact"):
        raise InputError(f'zero is "drifts", "constant" or "exact", got {zero!r}')
    return zero
