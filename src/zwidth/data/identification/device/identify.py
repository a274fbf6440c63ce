"""Mass, damping and Coulomb friction of a device from a log of its motion.

    m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a

in means over smooth pulses inside strokes (`pulses`), by least squares with the two halves of the samples as
each other's instruments (`moments`), with the scatter of the strokes as the measure of uncertainty
(`estimate`).  Abbott & Okamura (2005, section IV-B) fit the same equation to smoothed and differentiated
positions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from zwidth.data.identification.device.choice import Zero, choose, too_little
from zwidth.data.identification.device.curve import fastest
from zwidth.data.identification.device.estimate import offset
from zwidth.data.identification.device.findings import findings, moves_apart, refuse_impossible
from zwidth.data.identification.device.fit import Found, gather
from zwidth.data.identification.device.numbers import IdentifiedNumbers
from zwidth.data.identification.device.pulses import PIECES
from zwidth.data.identification.device.table import report, source_name
from zwidth.data.identification.device.two_masses import seen_to_swing, two_masses
from zwidth.data.logs import Log, read_log
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.model.specification.read import question_unit
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import Part, Shown
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

Model = Literal["Coulomb and viscous", "viscous"]

QUICKEST_HAND = 30.0
"""[m/s] With nothing in it."""


def identify_log(
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
        raise InputError(too_little(log, zero))
    seen = found.points.labelled(fit, mass, log.motion)
    quickest = fastest(seen)
    directions, slopes = found.directions(names), found.slopes(names, min(quickest))
    if directions is None or slopes is None or not min(quickest) > 0:
        raise InputError(too_little(log, zero))
    if log.motion == "linear" and min(quickest) > QUICKEST_HAND:
        raise InputError(
            f"{log.source}: the handle moves at {shown(min(quickest), 'm/s', 3)}, and no hand does: most "
            'likely the unit of the position is another, such as units={"position": "mm"}'
        )
    refuse_impossible(log, estimates, lambda other: through(other).estimates(names))
    shaken = model == "Coulomb and viscous" and mass is None and seen_to_swing(log, estimates, late)
    apart = two_masses(log, estimates, late) if shaken else None
    cable = apart if apart is not None and apart.explain else None
    weights = found.shape.value / found.shape.piece
    return Identified(
        estimates=estimates if cable is None else {**estimates, **cable.motor},
        cable=cable,
        as_one=not shaken,
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
            *(() if apart is None else (moves_apart(apart),)),
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


def identify(
    recording: Log | str | PathLike[str] | xr.Dataset,
    *,
    mass: object = None,
    delay: object = 0,
    zero: Zero | None = None,
    model: Model = "Coulomb and viscous",
    progress: Callable[[int, int], None] | None = None,
    **reading: Any,
) -> Identified:
    """Identify a device from its log: ``m ẍ + b ẋ + f_c sgn ẋ = f_h − f_a``.

    Parameters
    ----------
    recording
        A log, a file as `read_log` reads it, or a Dataset such as a trace: the position, and the force of the
        hand, of the actuator, or both. Without any force the mass must be given: a free motion shows b/m and
        f_c/m only.
    mass
        m > 0 where it is known [kg; kg·m²], or a text with a unit, "36 g".
    delay
        From a sample to the actuator force computed from it, ≥ 0 [s].
    zero
        Of the force: "drifts" along straight lines of some seconds (a load cell; the default where there is
        a hand force), "constant" (gravity; the default otherwise), or "exact".
    model
        "Coulomb and viscous", or "viscous": a mass and a damper; where Coulomb friction is seen, it says so.
    progress
        Told (samples done, samples in all).
    reading
        Further arguments of `read_log` or `Log.from_arrays`, such as columns={…}, units={…},
        resolution="22.4 um".

    Raises
    ------
    InputError
        If the recording cannot be read or shows too little: too few strokes, or no force and no mass.
    """
    log = log_from(recording, **reading)
    known = None if mass is None else parse_number(mass, GLOSSARY["mass"].unit_for(log.motion), "mass")
    if known is not None and log.motion == "linear":
        question_unit(mass, known, "mass", "kg")
    late = float(parse_number(delay, "s", "delay"))
    weighed = None if known is None else float(known)
    return identify_log(log, mass=weighed, delay=late, zero=zero, model=model, progress=progress)


def log_from(recording: Log | str | PathLike[str] | xr.Dataset, **reading: Any) -> Log:
    """The log that something holds; `reading` says how, where it is not a log already."""
    if isinstance(recording, Log):
        if reading:
            raise InputError(
                f"a log has been read already; {', '.join(reading)} is for read_log; or give the file instead"
            )
        return recording
    if isinstance(recording, str | PathLike):
        return read_log(recording, **reading)
    return Log.from_arrays(recording, **reading)


@dataclass(frozen=True, kw_only=True, repr=False)
class Identified(Shown, IdentifiedNumbers):
    __doc__ = IdentifiedNumbers.__doc__  # its arguments are the numbers

    def to_toml(self, confidence: float | None = 0.99, **others: Any) -> str:
        """The device as a specification that `zwidth check` reads; comments say where numbers come from.

        Parameters
        ----------
        confidence, others
            As for `device`.
        """
        from zwidth.data.identification.device.table import to_toml

        given = {"name": f"identified from {source_name(self)}", **others}
        return to_toml(self, self.device(confidence, **given), confidence)

    def save(
        self,
        path: str | PathLike[str],
        confidence: float | None = 0.99,
        *,
        force: bool = False,
        **others: Any,
    ) -> None:
        """Save `to_toml`, whole or not at all.

        Parameters
        ----------
        path
            The file, my-device.toml.
        confidence, others
            As for `device`.
        force
            Replace a file that exists.

        Raises
        ------
        InputError
            If the file exists, or cannot be written.
        """
        text, target = self.to_toml(confidence, **others), Path(path)
        check_target(target, force)
        with writing_whole(target) as file:
            file.write(text.encode())

    def plot(self, path: str | PathLike[str] | None = None, *, force: bool = False) -> Figure:
        """Friction against speed, what is left over, data against model; saved where a path is given.

        Parameters
        ----------
        path
            Ends in .png, .svg or .pdf.
        force
            Replace a file that exists.
        """
        figure: Figure = above("plots").identification_figure(self)
        if path is not None:
            above("plots").save_figure(lambda: figure, Path(path), overwrite=force)
        return figure

    def to_dict(self, confidence: float = 0.99) -> dict[str, Any]:
        """Everything but the points, units in the keys, as `zwidth identify --json` prints it."""
        from zwidth.data.identification.device.table import to_dict

        return to_dict(self, confidence)

    def report(self) -> Iterable[Part]:
        """The table, what it rests on, and what was found besides."""
        return report(self)
