"""Thousands of loops side by side, over any parameter.

They go in blocks through the kernel, on as many threads as asked for, each with the same bits as when it is
simulated alone.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import fields, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
import xarray as xr

from zwidth.errors import InputError
from zwidth.loop.plant import (
    ACTUATOR_WORK,
    COULOMB,
    FAULT,
    HAND_LOSS,
    HAND_WORK,
    INSIDE,
    POSITION,
    SATURATED,
    SOURCE_WORK,
    STATE_SIZE,
    STOPS,
    VELOCITY,
    VISCOUS,
)
from zwidth.loop.runs import DEEPEST, EXTRACTED, HIGHEST, LOWEST, PEAK, SUMMARY, run_each
from zwidth.loop.setup import Laid, empty_record, laid_out, started
from zwidth.loop.simulate import Progress
from zwidth.loop.trace import UNITS, VARIABLES
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator.operator import Operator
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Indices = NDArray[np.int64]

T = TypeVar("T")

BLOCK = 32
"""Loops that one thread runs before it says that they are finished."""

OPTIONS = ("initial_position", "initial_velocity", "encoder_phase")
"""Arguments of `simulate` that can be varied besides the parameters of device, environment and hand."""


class Outcome(NamedTuple):
    """A number kept of each loop: where it is found, its kind of unit, what it means."""

    of_state: int | None
    of_summary: int | None
    kind: int
    long_name: str


_COUNT = 4
OUTCOMES = {
    "position": Outcome(POSITION, None, 0, "position at the end"),
    "velocity": Outcome(VELOCITY, None, 1, "velocity at the end"),
    "deepest_position": Outcome(None, DEEPEST, 0, "deepest position at a sample"),
    "swing": Outcome(None, None, 0, "range of the positions in the last quarter of the samples"),
    "peak_actuator_force": Outcome(None, PEAK, 2, "largest actuator force just after a sample"),
    "energy_extracted": Outcome(
        None, EXTRACTED, 3, "most that the hand had got out at a sample, max(−W_h), stored at first or not"
    ),
    "hand_work": Outcome(HAND_WORK, None, 3, VARIABLES["hand_work"].long_name),
    "actuator_work": Outcome(ACTUATOR_WORK, None, 3, VARIABLES["actuator_work"].long_name),
    "viscous_loss": Outcome(VISCOUS, None, 3, VARIABLES["viscous_loss"].long_name),
    "coulomb_loss": Outcome(COULOMB, None, 3, VARIABLES["coulomb_loss"].long_name),
    "hand_source_work": Outcome(SOURCE_WORK, None, 3, VARIABLES["hand_source_work"].long_name),
    "hand_damper_loss": Outcome(HAND_LOSS, None, 3, VARIABLES["hand_damper_loss"].long_name),
    "stops": Outcome(STOPS, None, _COUNT, "how often the mass stopped or turned round"),
    "samples_inside": Outcome(INSIDE, None, _COUNT, "samples at which the law acted"),
    "samples_saturated": Outcome(SATURATED, None, _COUNT, "samples whose command was beyond the limit"),
}
"""What is kept of each loop."""


def simulate_batch(
    device: Device,
    environment: object,
    operator: Operator,
    duration: RealLike,
    *,
    vary: Mapping[str, Sequence[Any] | Array],
    together: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> xr.Dataset:
    """Simulate a loop for many values of its parameters.

    Parameters
    ----------
    device, environment, operator, duration
        As of `simulate`.
    vary
        For each parameter its values: {"stiffness": [100, 300], "device.damping": […]}. A name
        that several of device, environment and operator have is written with its owner before it;
        initial_position, initial_velocity and encoder_phase can be varied too.
    together
        False: every combination, one dimension for each parameter. True: the first values of
        all, then the second values, …, along one dimension `case`.
    workers
        By default as many as there are processors.
    progress
        Called with (loops done, loops in all).
    options
        Further arguments of `simulate`, the same for all loops.

    Returns
    -------
    xarray.Dataset
        Final state, extremes and energies of every loop. Interrupted by Ctrl-C, the loops that
        are not finished are NaN, and the attribute `interrupted` says how many were.

    Raises
    ------
    InputError
        If a parameter is unknown or a loop cannot be simulated.
    """
    axes = _axes(vary, together)
    base = _Base(device, as_environment(environment, device=device), operator, options)
    owners = [_owner(name, base) for name in axes]
    loops = _laid_out(base, axes, owners, together, duration)
    states, summaries, finished = _run_all(loops, _workers(workers), progress)
    return _dataset(base, axes, owners, together, states, summaries, finished)


class _Base(NamedTuple):
    device: Device
    environment: Environment
    operator: Operator
    options: dict[str, Any]


def _axes(vary: Mapping[str, Sequence[Any] | Array], together: bool) -> dict[str, list[Any]]:
    axes = {str(name): _values(str(name), values) for name, values in vary.items()}
    if not axes or not all(axes.values()):
        raise InputError(
            "vary needs one parameter with one value at least, such as {'stiffness': [100, 300]}"
        )
    if together and len({len(values) for values in axes.values()}) > 1:
        lengths = ", ".join(f"{name} {len(values)}" for name, values in axes.items())
        raise InputError(f"values varied together must be equally many, got {lengths}")
    return axes


def _values(name: str, values: Any) -> list[Any]:
    try:
        listed = list(np.atleast_1d(values))
        hash(tuple(listed))
    except (TypeError, ValueError):  # an array, a list or a set in it, or lists of different lengths
        raise InputError(
            f"{name!r} is varied over single values, such as [100, 300], got {values!r}: of a parameter that "
            "is itself a list simulate each value on its own"
        ) from None
    return listed


def _owner(name: str, base: _Base) -> tuple[str, str]:
    """(device, environment, operator or option; the key there)."""
    parts = {
        "device": [f.name for f in fields(base.device)] + ["rate"],
        "environment": [f.name for f in fields(base.environment)],
        "operator": [f.name for f in fields(base.operator)],
        "option": list(OPTIONS),
    }
    owner, _, key = name.rpartition(".")
    if owner:
        if key in parts.get(owner, ()):
            return owner, key
        raise InputError(f"there is no parameter {name!r} to vary; {_choices(parts)}")
    found = [part for part, keys in parts.items() if name in keys]
    if len(found) == 1:
        return found[0], name
    if not found:
        raise InputError(f"there is no parameter {name!r} to vary; {_choices(parts)}")
    raise InputError(f"{name!r} is ambiguous: write {' or '.join(f'{part}.{name}' for part in found)}")


def _choices(parts: Mapping[str, Iterable[str]]) -> str:
    return "there are " + "; ".join(f"{part}: {', '.join(keys)}" for part, keys in parts.items())


class _Loops(NamedTuple):
    """Many loops: what they are laid out as, which of these each one is, and how it starts."""

    laid: list[Laid]
    which: list[int]
    starts: Array


def _laid_out(
    base: _Base, axes: dict[str, list[Any]], owners: list[tuple[str, str]], together: bool, duration: RealLike
) -> _Loops:
    """Each part is made, and each three parts are laid out, once for all loops that have them."""
    lengths = [len(values) for values in axes.values()]
    taken = [np.arange(lengths[0])] * len(axes) if together else [*np.indices(lengths).reshape(len(axes), -1)]
    varied: dict[str, dict[str, tuple[list[Any], Indices]]] = defaultdict(dict)
    for (owner, key), values, row in zip(owners, axes.values(), taken, strict=True):
        plain = [value.item() if isinstance(value, np.generic) else value for value in values]
        varied[owner][key] = plain, row
    devices, of_device = _parts(base.device, base.device.replace, varied["device"])
    laws, of_law = _parts(base.environment, base.environment.replace, varied["environment"])
    hands, of_hand = _parts(base.operator, partial(replace, base.operator), varied["operator"])
    parts = np.stack(np.broadcast_arrays(of_device, of_law, of_hand, taken[0])[:3])
    kinds, which = np.unique(parts, axis=1, return_inverse=True)
    options, known = dict(base.options), dict[Any, Any]()
    own = [
        varied["option"].get(key, ([options.pop(key, usual)], np.zeros_like(taken[0])))
        for key, usual in zip(OPTIONS, (None, 0.0, 0.0), strict=True)
    ]
    placed = own[0][0] != [None]
    laid = [
        laid_out(devices[i], laws[j], hands[k], duration, known, placed=placed, **options)
        for i, j, k in kinds.T.tolist()
    ]
    chosen = ([values[i] for i in row.tolist()] for values, row in own)
    rows = which.ravel().tolist()
    starts = [laid[i].starts(*start) for i, *start in zip(rows, *chosen, strict=True)]
    return _Loops(laid, rows, np.array(starts))


def _parts(
    part: T, make: Callable[..., T], varied: dict[str, tuple[list[Any], Indices]]
) -> tuple[list[T], Indices]:
    """A part as often as its values differ, and which of these each loop has."""
    if not varied:
        return [part], np.array([0])
    rows, read = [], []
    for values, row in varied.values():
        first: dict[Any, int] = {}
        rows.append(np.array([first.setdefault(value, i) for i, value in enumerate(values)])[row])
        # a float is read here, once for all parts that take it
        read.append([Exact(v) if type(v) is float and 1e-40 < abs(v) < 1e40 else v for v in values])
    chosen, which = np.unique(rows, axis=1, return_inverse=True)
    given = ((values[i] for values, i in zip(read, row, strict=True)) for row in chosen.T.tolist())
    return [make(**dict(zip(varied, values, strict=True))) for values in given], which.ravel()


def _workers(given: int | None) -> int:
    if given is None:
        return os.cpu_count() or 1
    if given != int(given) or given < 1:
        raise InputError(f"workers is a whole number ≥ 1, got {given}")
    return int(given)


def _run_all(
    loops: _Loops, threads: int, progress: Progress | None
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """(states, summaries, finished) of all loops, a row each."""
    count = len(loops.which)
    states, summaries = np.zeros((count, STATE_SIZE)), np.full((count, SUMMARY), np.nan)
    finished = np.zeros(count, dtype=bool)
    stop: list[bool] = []

    def job(rows: list[int]) -> None:
        if not stop:
            states[rows], summaries[rows] = _run_block(
                [loops.laid[loops.which[row]] for row in rows], loops.starts[rows]
            )
            finished[rows] = True

    pool = ThreadPoolExecutor(threads)
    futures: list[Future[None]] = [pool.submit(job, rows) for rows in _blocks(loops)]
    try:
        for future in as_completed(futures):
            future.result()
            if progress is not None:
                progress(int(finished.sum()), count)
    except KeyboardInterrupt:
        stop.append(True)
        if not finished.any():
            raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
    return states, summaries, finished


def _blocks(loops: _Loops) -> list[list[int]]:
    """BLOCK loops each that have clock and hand in common, and a law of the same length."""
    keys = []
    for laid in loops.laid:
        f, law = laid.frame, laid.packed
        keys.append((id(f.signals), f.late, f.offset, f.points, law.numbers.size, law.remembers, laid.plain))
    groups: dict[tuple[Any, ...], list[int]] = {}
    for row, which in enumerate(loops.which):
        groups.setdefault(keys[which], []).append(row)
    return [rows[at : at + BLOCK] for rows in groups.values() for at in range(0, len(rows), BLOCK)]


def _run_block(laid: list[Laid], starts: Array) -> tuple[Array, Array]:
    """(states, summaries), a row for each loop."""
    states, laws, memories = started(laid, starts)
    summaries, frame = np.empty((len(laid), SUMMARY)), laid[0].frame
    commands, record, work = empty_record(frame)
    plants = np.array([loop.frame.plant for loop in laid])
    run_each(
        laid[0].plain, frame.points, states, plants, laws, memories, work, frame.late, frame.offset,
        frame.lengths, frame.arrivals, frame.missed, *frame.optional(), commands, record, summaries,
    )  # fmt: skip
    return states, summaries


def _dataset(
    base: _Base,
    axes: dict[str, list[Any]],
    owners: list[tuple[str, str]],
    together: bool,
    states: Array,
    summaries: Array,
    finished: NDArray[np.bool_],
) -> xr.Dataset:
    if (states[finished, FAULT] != 0.0).any():
        raise InputError(
            "a motion has too many stops in one sample to be followed: device, hand and forces differ by so "
            "many orders of magnitude that rounding decides; scale them closer together"
        )
    keys = [key for _, key in owners]
    names = [key if keys.count(key) == 1 else f"{owner}_{key}" for owner, key in owners]
    shape = (len(finished),) if together else tuple(len(values) for values in axes.values())
    dims = ("case",) if together else tuple(names)
    units = (*UNITS[base.device.motion], "J", "1")
    variables = {}
    for name, outcome in OUTCOMES.items():
        if outcome.of_state is not None:
            values = states[:, outcome.of_state]
        elif outcome.of_summary is not None:
            values = summaries[:, outcome.of_summary]
        else:
            values = summaries[:, HIGHEST] - summaries[:, LOWEST]
        values = np.where(finished, values, np.nan).reshape(shape)
        variables[name] = (dims, values, {"units": units[outcome.kind], "long_name": outcome.long_name})
    coordinates = {
        name: ("case" if together else name, np.asarray(values), _unit_of(owner, base))
        for name, values, owner in zip(names, axes.values(), owners, strict=True)
    }
    attributes = {"device": base.device.name, "operator": base.operator.describe(base.device.motion)}
    if not finished.all():
        attributes["interrupted"] = f"{int(finished.sum())} of {len(finished)} loops are finished"
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _unit_of(owner: tuple[str, str], base: _Base) -> dict[str, str]:
    part, key = owner
    if part == "environment" and key == "damping":
        key = "virtual_damping"
    if part == "option":
        key = {"initial_position": "position"}.get(key, key)
    if part in ("device", "environment", "option") and key in GLOSSARY:
        quantity = GLOSSARY[key]
        return {"units": quantity.unit_for(base.device.motion), "long_name": quantity.meaning}
    return {}
