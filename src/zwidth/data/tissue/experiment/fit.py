"""From a spreadsheet, or from arrays, to a test that was understood and fitted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Literal

import numpy as np

from zwidth.data.logs import Finding
from zwidth.data.tissue.experiment.choice import (
    MODELS,
    Tried,
    label,
    not_told_apart,
    taken,
    tried,
    understood,
)
from zwidth.data.tissue.experiment.columns import Raw, read_tests
from zwidth.data.tissue.experiment.estimate import bends, covariance
from zwidth.data.tissue.experiment.history import KINDS, Kind, history_of, kind_of, one_trial, places
from zwidth.data.tissue.experiment.result import TissueTest
from zwidth.data.tissue.model import as_model
from zwidth.data.tissue.result import TissueFit
from zwidth.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Zero = Literal["fitted", "exact"]

_ARRAYS = "arrays"

MOST_TRIALS = 50
"""Of a file, that are fitted beside the one that is asked for."""


def read_test(
    path: str | PathLike[str],
    *,
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    kind: Kind | None = None,
    trial: int | None = None,
    models: tuple[str, ...] = (),
    zero: Zero = "fitted",
    sheet: str | None = None,
) -> TissueTest:
    """A relaxation, creep or loading test from a spreadsheet: which tissue, and how well it is known.

    Parameters
    ----------
    path
        The file: text with any delimiter and decimal sign, or another format that `zwidth.read_log` reads.
    columns
        The column of each of time, indentation and force, where its name is not known: {"force": "Ch 2"}.
    units
        The unit of each, where neither name nor file states it: {"indentation": "mm"}.
    kind
        "relaxation", "creep" or "loading"; None: as the data say.
    trial
        Which of several in the file, from 1; None: the first.  The model that it takes is fitted to the
        others too (`TissueTest.trials`).
    models
        Names of those to be fitted; none: all that such a test allows.
    zero
        "fitted" (default): the zero of the response may be off by a constant; "exact": it is not.
    sheet
        The name of the sheet of a workbook; None: of several that hold a test each is a trial.

    Raises
    ------
    InputError
        If the file cannot be read, a column or its unit is not known, or no tissue was pushed.
    """
    every = places(read_tests(path, columns, units, sheet))
    number = 1 if trial is None else trial
    if not 1 <= number <= len(every):
        raise InputError(f"{path} has {len(every)} trials, and trial {number} is wanted")
    own = _fitted(*every[number - 1], kind, models, zero)
    if len(every) == 1:
        return own
    return replace(own, number=number, trials=_beside(own, every, number, zero))


def fit_test(
    time: ArrayLike,
    indentation: ArrayLike,
    force: ArrayLike,
    *,
    kind: Kind | None = None,
    models: tuple[str, ...] = (),
    zero: Zero = "fitted",
) -> TissueTest:
    """The same of arrays in SI units.

    Parameters
    ----------
    time
        [s]; need not begin at 0 nor be even.
    indentation
        Of the probe, of either sign, from any origin [m].
    force
        Of either sign, with any zero [N].
    kind, models, zero
        As for `read_test`.

    Raises
    ------
    InputError
        If they are of different lengths, or no tissue was pushed.
    """
    arrays = [np.asarray(values, dtype=float) for values in (time, indentation, force)]
    if any(values.ndim != 1 or values.shape != arrays[0].shape for values in arrays):
        shapes = ", ".join(str(values.shape) for values in arrays)
        raise InputError(f"time, indentation and force are three arrays of one length; got {shapes}")
    t, x, f = arrays
    return _fitted(Raw(_ARRAYS, t, x, f, None, ()), 1, kind, models, zero)


def _beside(
    own: TissueTest, every: list[tuple[Raw, int]], number: int, zero: Zero
) -> tuple[TissueFit | str, ...]:
    """The model that was taken, fitted to each trial of the file; why not, where it is not."""
    found: list[TissueFit | str] = []
    for k, (raw, place) in enumerate(every[:MOST_TRIALS], 1):
        if k == number:
            found.append(own.best)
            continue
        try:
            found.append(_fitted(raw, place, own.test.kind, (own.names[own.chosen],), zero).best)
        except InputError as error:
            found.append(str(error))
    return tuple(found)


def _fitted(raw: Raw, place: int, kind: Kind | None, models: tuple[str, ...], zero: Zero) -> TissueTest:
    _check(kind, models, zero)
    trial = one_trial(raw, place)
    found = kind_of(trial.time, trial.indentation, trial.force)
    seen = history_of(trial, kind or found, raw.source)
    zeroed = zero == "fitted" and not seen.starts_loaded
    test = understood(seen, zeroed)
    every = tried(test, zeroed, models)
    if not every:
        raise InputError(f"none of the models {', '.join(models)} is fitted to a {test.kind} test")
    best = taken(every)
    return TissueTest(
        source=raw.source,
        test=test,
        seen_as=found,
        tried=tuple(every),
        fits=tuple(
            replace(
                _fit(each, (*trial.findings, *test.findings), shaped=k == best),
                units_stated=raw.source != _ARRAYS,
            )
            for k, each in enumerate(every)
        ),
        chosen=best,
        as_good=not_told_apart(every, best),
    )


def _check(kind: object, models: tuple[str, ...], zero: object) -> None:
    if kind is not None and kind not in KINDS:
        raise InputError(f"kind is one of {', '.join(KINDS)}; got {kind!r}")
    if zero not in ("fitted", "exact"):
        raise InputError(f'zero is "fitted" or "exact"; got {zero!r}')
    known = [label(as_model(name, branches, "force")) for name, branches in MODELS]
    for name in models:
        if name not in (*known, "generalized-maxwell"):
            raise InputError(f"there is no model {name!r} of a tissue; there are {', '.join(known)}")


def _fit(each: Tried, findings: tuple[Finding, ...], shaped: bool) -> TissueFit:
    """What was found, as every fit of a tissue is given; `shaped`: with the ends of its intervals."""
    task, found = each.task, each.found
    ends = bends(task, found) if shaped else []
    spread, condition = covariance(found)
    if each.apart is not None:
        spread = spread + each.apart
    own = task.own + task.zero
    order = _slow_last(each)
    scale = np.ones(own)
    scale[task.own :] = task.size
    return TissueFit(
        model=task.model,
        estimates=(found.point[:own] * scale)[order],
        covariance=(spread[:own, :own] * np.outer(scale, scale))[np.ix_(order, order)],
        residuals=-found.left * task.size,
        output=task.output,
        response="position" if task.test.kind == "creep" else "force",
        condition=condition,
        noise_order=int(found.noise.memory > 0),
        independent_samples=found.noise.independent,
        motion="linear",
        further=found.point.size - own,
        findings=findings,
        position=task.test.depth,
        time=task.test.time,
        bends=tuple(ends[k] for k in order[: task.own]) if ends else (),
    )


def _slow_last(each: Tried) -> list[int]:
    """The places of the numbers, branches in the order of their relaxation times."""
    own, point = each.task.own, each.found.point
    places = list(range(own + each.task.zero))
    if each.task.model.name != "generalized-maxwell":
        return places
    pairs = sorted(
        zip(places[1:own:2], places[2:own:2], strict=True), key=lambda p: point[p[1]] - point[p[0]]
    )
    return [0, *(k for pair in pairs for k in pair), *places[own:]]
