"""From whatever holds a recording to the device: a file, a Dataset, a log."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import TYPE_CHECKING, Any

from zwidth.data.identification.device import identify as device
from zwidth.data.identification.device.choice import Zero
from zwidth.data.identification.device.identified import Identified
from zwidth.data.logs import Log, read_log
from zwidth.errors import InputError
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    import xarray as xr


def identify(
    recording: Log | str | PathLike[str] | xr.Dataset,
    *,
    mass: object = None,
    delay: object = 0,
    zero: Zero | None = None,
    model: device.Model = "Coulomb and viscous",
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
    known = None if mass is None else float(parse_number(mass, GLOSSARY["mass"].unit_for(log.motion), "mass"))
    late = float(parse_number(delay, "s", "delay"))
    return device.identify(log, mass=known, delay=late, zero=zero, model=model, progress=progress)


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
