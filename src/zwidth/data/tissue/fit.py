"""The parameters of a tissue from a record of position and force: output error, least squares.

    min over p of  Σ (y_k − ŷ_k(p))²

What a recording adds to the tissue, a zero that drifts, a late force, holes, an end of the sensor's range, is
looked for in what is left, and fitted, left out or refused; `search` has how.

ŷ is the force of the continuous-time model under the measured position, linear between its samples, or the
position under the force (creep): simulated without error, so that no sample period and no discretization
enters the parameters.  The search runs over their logarithms: they stay positive, and their scales do not
matter.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from zwidth.data.tissue.findings import hole_places
from zwidth.data.tissue.model import Record, Response, as_model
from zwidth.data.tissue.result import TissueFit
from zwidth.data.tissue.search import fitted
from zwidth.errors import InputError
from zwidth.model.environment.modes import samples
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown
from zwidth.showing import Part, Shown, Table

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

STANDARD_MODELS = ("kelvin-voigt", "maxwell", "standard-linear-solid", "generalized-maxwell")


def fit_tissue(
    time: ArrayLike | xr.Dataset,
    position: ArrayLike | str | None = None,
    force: ArrayLike | str | None = None,
    *,
    model: str = "standard-linear-solid",
    branches: int | None = None,
    response: Response = "force",
    rest: RealLike | None = None,
    offset: bool = False,
    noise: Literal["correlated", "white"] = "correlated",
    motion: Literal["linear", "rotary"] = "linear",
) -> TissueFit:
    """The springs and dashpots of a tissue from measured positions and forces.

    Parameters
    ----------
    time
        Of the samples [s], increasing; or an xarray.Dataset along `time`, such as a trace.
    position
        x [m; rad]; the name of a variable where a Dataset is given, "position" by default.
    force
        With which the tissue resists [N; N·m]; or a name, by default "force", then "actuator_force".
    model
        "kelvin-voigt", "maxwell", "standard-linear-solid" (default), "generalized-maxwell" or
        "hunt-crossley".
    branches
        Of "generalized-maxwell": 1 to 6, 2 by default.
    response
        What is predicted from the other, and carries the noise: "force" (default; relaxation, free motion)
        or "position" (creep).
    rest
        The input before the first sample, for ever: a relaxation test whose step comes before the first
        sample has rest=0.  None: that of the first sample.
    offset
        True to fit a constant added to the response as well: the bias of a sensor.
    noise
        "correlated" (default): the intervals allow for a memory of the noise; "white": they do not.
    motion
        "linear" or "rotary", for the units.

    Raises
    ------
    InputError
        If the samples, the model or an option is not one of these, there are fewer samples than parameters,
        or the record is of no tissue: a sign turned round, too little within the sensor's range.

    Notes
    -----
    Give positions that are > 0 inside the tissue, and samples in contact only: a linear model has no surface.
    """
    record = _record(time, position, force, response, rest)
    chosen = as_model(model, branches, response)
    if noise not in ("correlated", "white"):
        raise InputError(f'noise is "correlated" or "white", got {noise!r}')
    if motion not in ("linear", "rotary"):
        raise InputError(f'motion is "linear" or "rotary", got {motion!r}')
    count = len(chosen.parameters) + bool(offset)
    if record.time.size < 2 * count:
        raise InputError(
            f"{record.time.size} samples do not fix {count} parameters; give {2 * count} at the least"
        )
    return fitted(chosen, record, bool(offset), noise, motion)


def compare_tissues(
    time: ArrayLike | xr.Dataset,
    position: ArrayLike | str | None = None,
    force: ArrayLike | str | None = None,
    *,
    models: tuple[str, ...] = STANDARD_MODELS,
    **options: Any,
) -> TissueComparison:
    """Several models on one record, that of the smallest BIC first.

    Parameters
    ----------
    time, position, force
        As for `fit_tissue`.
    models
        Their names.
    options
        All else as for `fit_tissue`; `branches` goes to "generalized-maxwell".

    Raises
    ------
    InputError
        As `fit_tissue`.
    """
    branches = options.pop("branches", None)
    fits = [
        fit_tissue(
            time,
            position,
            force,
            model=name,
            branches=branches if name == "generalized-maxwell" else None,
            **options,
        )
        for name in models
    ]
    return TissueComparison(tuple(sorted(fits, key=lambda fit: fit.bic)))


def _record(time: Any, position: Any, force: Any, response: object, rest: RealLike | None) -> Record:
    if response not in ("force", "position"):
        raise InputError(f'response is "force" or "position", got {response!r}')
    if hasattr(time, "data_vars"):
        time, position, force = _from_dataset(time, position, force)
    if position is None or force is None:
        raise InputError("give time, position and force; or a Dataset that holds them")
    t, x = samples(time, position, "position")
    _, f = samples(time, force, "force")
    other = "position" if response == "force" else "force"
    before = None if rest is None else float(read_number(rest, other, "rest"))
    if not np.ptp(x) and not (before is not None and x[0] != before) and response == "force":
        raise InputError(
            "the position never changes, so it says nothing: give a record of motion, or for a relaxation "
            "test the position before its step as rest=0"
        )
    begins = hole_places(t, x if response == "force" else f)
    if begins and response == "position":
        raise InputError(
            f"the record has a hole in time after t = {shown(t[begins[0] - 1], 's', 6)}, across which the "
            "force changes: how the tissue crept meanwhile is not known; give the part before it or after it"
        )
    return Record(t, x, f, response, before, begins)


def _from_dataset(data: Any, position: Any, force: Any) -> tuple[Any, Any, Any]:
    first = next((name for name in ("force", "actuator_force") if name in data), "force")
    names = "position" if position is None else position, first if force is None else force
    for name in ("time", *names):
        if not isinstance(name, str) or name not in data:
            raise InputError(
                f"the Dataset has no variable {name!r}; it has {', '.join(map(str, data.data_vars))}"
            )
    return data["time"].values, data[names[0]].values, data[names[1]].values


@dataclass(frozen=True, eq=False, repr=False)
class TissueComparison(Shown):
    """Several models fitted to one record, that of the smallest BIC first.

    Parameters
    ----------
    fits
        In the order of their BIC.
    """

    fits: tuple[TissueFit, ...]

    @property
    def best(self) -> TissueFit:
        """The fit of the smallest BIC."""
        return self.fits[0]

    def __getitem__(self, name: str) -> TissueFit:
        return {fit.model.name: fit for fit in self.fits}[name]

    def table(self) -> list[list[str]]:
        """Headings, then one line of text per model; AIC and BIC above the smallest."""
        aic, bic = (min(getattr(fit, key) for fit in self.fits) for key in ("aic", "bic"))
        lines = [["model", "parameters", "r²", "RMS", "AIC above", "BIC above", "identifiable"]]
        for fit in self.fits:
            numbers = f"{fit.r_squared:.6f}", f"{fit.rms:.3g}", f"{fit.aic - aic:.1f}", f"{fit.bic - bic:.1f}"
            known = "yes" if fit.identifiable else "no"
            lines.append([fit.model.name, str(fit.estimates.size), *numbers, known])
        return lines

    def report(self) -> Iterable[Part]:
        """The table."""
        head, *rows = self.table()
        yield Table(heads=[head], rows=rows)
