"""Many laws, the same touches: what each promises, what it keeps, what it costs the feel."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np

from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.loop.setup import empty_record, prepare
from zwidth.loop.simulate import run_setup, simulate
from zwidth.loop.traces.measures import (
    SOURCE,
    WEBER,
    bounces,
    chatter,
    free_damping,
    generated_energy,
    noticeable_differences,
    peak_force,
    penetration,
    rate_hardness,
    rms_force,
    settling_time,
    static_stiffness,
)
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.environment.wall import Wall
from zwidth.model.pairs import Pair
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import shown
from zwidth.showing import Part
from zwidth.study.bench.adversary import FASTEST, Attack, attack
from zwidth.study.bench.advice import (
    Touch,
    advice,
    answer,
    legend,
    on_paper,
    short_table,
    standard_touches,
    table,
    told_of,
)
from zwidth.study.bench.laws import about_axis, at_rim, radius_of, standard_laws, wall_to_render
from zwidth.study.bench.motions import found_motions
from zwidth.study.bench.pairs import PairComparison, compare_pairs
from zwidth.study.bench.standing import Standing, standing

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_TIMED = 20_000
"""Samples over which a step is timed."""


class Score(NamedTuple):
    """One column: what is measured, in which touch, and its unit."""

    meaning: str
    touch: str
    unit: str
    of: Callable[[xr.Dataset], float]


SCORES: Mapping[str, Score] = {
    "static_stiffness": Score("stiffness felt at rest", "press", "N/m", static_stiffness),
    "rate_hardness": Score("rate-hardness in the first 10 ms", "press", "N/m", rate_hardness),
    "chatter": Score("force above 30 Hz in contact", "press", "N", chatter),
    "penetration": Score("deepest position", "press", "m", penetration),
    "settling_time": Score("time until at rest", "press", "s", settling_time),
    "rms_force": Score("RMS force in contact", "press", "N", rms_force),
    "peak_force": Score("largest force", "tap", "N", peak_force),
    "bounces": Score("times that contact is lost", "tap", "1", bounces),
    "tap_chatter": Score("force above 30 Hz after a tap", "tap", "N", chatter),
    "generated_energy": Score("energy given out", "tap", "J", generated_energy),
    "dowel_energy": Score("energy given out to a dowel", "dowel", "J", generated_energy),
    "free_damping": Score("damping felt in free air", "free air", "N*s/m", free_damping),
}
"""What is computed of each law, by variable."""


@dataclass(frozen=True, repr=False)
class LawComparison(Documented):
    """What became of each law.

    Attributes
    ----------
    scores
        Dimension `law`; the variables of `SCORES`, units and meanings in the attributes, and
        `stiffness_jnds`, just-noticeable differences between what is felt and what was wanted,
        `gain`, energy that the worst motion takes out in a round [J], `step_time` [s],
        `status`: "passive" with a certificate, "theorem" by a proof on paper, no certificate, "active" with
        a motion, or "undecided".
    attacks
        The motion of each law that took out most.
    standings
        What is known of each law for every hand: its status, why, and what of the device that counts.
    traces
        Of each law and touch.
    device, environment
        What was compared.
    radius
        Of a device that turns: how far from its axis it was touched [m]; traces and motions are those of
        that place.  None for a handle.
    """

    FORMAT = "zwidth laws 1"

    scores: xr.Dataset
    attacks: Mapping[str, Attack]
    standings: Mapping[str, Standing]
    traces: Mapping[str, Mapping[str, xr.Dataset]]
    device: Device
    environment: Wall
    radius: float | None = None

    def about_axis(self, device: Device, wall: Wall, radius: Exact) -> LawComparison:
        """What was found at the rim, `radius` [m] from the axis, of a device that turns and its wall.

        Scores are torques and angles; traces and motions stay those of the rim.
        """
        scores, far = about_axis(self.scores, float(radius)), float(radius)
        return replace(self, scores=scores, device=device, environment=wall, radius=far)

    @property
    def evidence(self) -> dict[str, str]:
        """Of each law, why its status is what it is."""
        return {name: known.evidence for name, known in self.standings.items()}

    @property
    def advice(self) -> str:
        """What to do, in a paragraph."""
        return advice(self.scores, self.device, self.environment)

    def in_short(self, most: int = 6) -> Iterable[Part]:
        """What to do, and the table of a few laws."""
        what = answer(self.scores, self.device, self.environment)
        yield f"{self._what()}: {what}"
        yield ""
        yield short_table(self.scores, told_of(self.scores, self.environment), most)
        yield ""
        yield from on_paper(self.scores)

    def report(self) -> Iterable[Part]:
        """What to do, the table, and what its words mean."""
        yield f"{self._what()}: {self.advice}"
        yield ""
        yield table(self.scores)
        yield ""
        yield legend(self.scores)

    def to_dict(self) -> dict[str, Any]:
        """The scores of each law, a unit in every key, what is known of it, and the advice."""
        laws = {name: self._known(name) | self._scored(name) for name in map(str, self.scores["law"].values)}
        touched = {} if self.radius is None else {"touched_at_radius_m": self.radius}
        return {"format": self.FORMAT, "advice": self.advice, **touched, "laws": laws}

    def _what(self) -> str:
        """What was compared, in a few words."""
        touched = "" if self.radius is None else f", touched {shown(self.radius, 'm')} from its axis"
        law = self.environment.describe(self.device.motion)
        return f"{law} on {self.device.name or 'the device'}{touched}"

    def _known(self, name: str) -> dict[str, Any]:
        known = self.standings[name]
        return {
            "status": known.status,
            "proof": known.proof,
            "evidence": known.evidence,
            "withheld": list(known.withheld),
            "scope": known.scope.to_dict(),
        }

    def _scored(self, name: str) -> dict[str, float | None]:
        """By name and unit; None for what has no bound."""
        scores = self.scores.sel(law=name).drop_vars("status").data_vars.items()
        units = {key: value.attrs["units"] for key, value in scores}
        return {
            str(key) if units[key] == "1" else f"{key}_{unit_suffix(units[key])}": _finite(float(value))
            for key, value in scores
        }

    def figure(self) -> Figure:
        """Stability against fidelity, and the touches of each law."""
        figure: Figure = above("plots").laws_figure(self)
        return figure


def _finite(number: float) -> float | None:
    return number if isfinite(number) else None


@overload
def compare(
    device: Device,
    environment: Wall | Any,
    laws: Mapping[str, Environment] | None = ...,
    *,
    fastest: RealLike = ...,
    handle_radius: RealLike | None = ...,
    progress: Callable[[int, int], None] | None = ...,
) -> LawComparison: ...
@overload
def compare(
    device: Mapping[str, Pair], *, progress: Callable[[int, int], None] | None = ...
) -> PairComparison: ...
def compare(
    device: Device | Mapping[str, Pair],
    environment: Wall | Any = None,
    laws: Mapping[str, Environment] | None = None,
    *,
    fastest: RealLike = FASTEST,
    handle_radius: RealLike | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LawComparison | PairComparison:
    """Put laws on the bench: three touches, a stroke in free air, and a hand that tries to take energy out.

    Pairs of arms, by name, are compared by `compare_pairs`: ``compare({"positions": pair, …})``.

    Parameters
    ----------
    device
        With a mass, every number certain.
    environment
        The wall that is to be rendered.
    laws
        Environments by name, such as ``{"mine": zw.render(wall, MyLaw())}``; None: all of `standard_laws`.
    fastest
        Speed of the fastest hand that tries to take energy out [m/s].  What gains only beyond 1 m/s, about
        what a hand reaches, says so in the evidence.
    handle_radius
        Of a device that turns, how far from its axis it is touched, > 0 [m]; None of a handle.
    progress
        Told (laws done, laws in all).

    Raises
    ------
    InputError
        If the device has no mass, the environment is no wall with a stiffness, or the speed is not > 0; if a
        device that turns has no radius, or laws of one's own, whose numbers are not of its rim.
    """
    if isinstance(device, Mapping):
        if environment is not None or laws is not None:
            raise InputError("pairs are compared as they are: leave out the environment and the laws")
        return compare_pairs(device, progress=progress)
    wall = wall_to_render(as_environment(environment))
    if device.motion == "rotary":
        if laws is not None:
            raise InputError(
                "laws of your own have numbers about the axis, and the bench touches the rim: compare the "
                "standard ones, or give device, wall and laws at the handle: rotary(…, handle_radius=…)"
            )
        radius = radius_of(device, handle_radius)
        there = compare(*at_rim(device, wall, radius), fastest=fastest, progress=progress)
        return there.about_axis(device, wall, radius)
    if handle_radius is not None:
        raise InputError("handle_radius is of a device that turns, and this one is linear: leave it out")
    if device.mass is None:
        raise InputError("the touches are simulated and need the device's mass [kg]")
    chosen = standard_laws(device, wall) if laws is None else dict(laws)
    if not chosen:
        raise InputError("laws is empty: there is nothing to compare")
    touches = standard_touches(device, float(wall.stiffness))  # type: ignore[arg-type]
    known = found_motions(device, wall, fastest)
    traces: dict[str, dict[str, xr.Dataset]] = {}
    attacks: dict[str, Attack] = {}
    known_of: dict[str, Standing] = {}
    times: dict[str, float] = {}
    for done, (name, law) in enumerate(chosen.items()):
        if progress is not None:
            progress(done, len(chosen))
        traces[name] = {key: _touched(device, law, touch) for key, touch in touches.items()}
        attacks[name] = attack(device, law, fastest=fastest, known=known)
        known_of[name] = standing(device, law, attacks[name])
        times[name] = _step_time(device, law, touches["press"])
    if progress is not None:
        progress(len(chosen), len(chosen))
    return LawComparison(
        scores=_dataset(traces, attacks, known_of, times, float(wall.stiffness)),  # type: ignore[arg-type]
        attacks=attacks,
        standings=known_of,
        traces=traces,
        device=device,
        environment=wall,
    )


def _touched(device: Device, law: Environment, touch: Touch) -> xr.Dataset:
    return simulate(device, law, touch.hand, touch.duration)


def _step_time(device: Device, law: Environment, touch: Touch) -> float:
    """Time that the simulator takes for a sample with this law [s]."""
    period = float(device.exact("sample_period"))
    setup = prepare(device, law, touch.hand, _TIMED * period)
    best = float("inf")
    for _ in range(2):
        commands, record, work = empty_record(setup.frame)
        start = time.perf_counter()
        run_setup(setup, setup.state.copy(), setup.memory.copy(), work, commands, record, None)
        best = min(best, time.perf_counter() - start)
    return best / _TIMED


def _dataset(
    traces: Mapping[str, Mapping[str, xr.Dataset]],
    attacks: Mapping[str, Attack],
    standings: Mapping[str, Standing],
    times: Mapping[str, float],
    wanted: float,
) -> xr.Dataset:
    import xarray as xr

    names = list(traces)
    data = xr.Dataset(coords={"law": names})
    for key, score in SCORES.items():
        values = [score.of(traces[name][score.touch]) for name in names]
        data[key] = ("law", np.array(values, dtype=float))
        data[key].attrs = {"units": score.unit, "long_name": score.meaning, "touch": score.touch}
    steps = [noticeable_differences(felt, wanted) for felt in data["static_stiffness"].values.tolist()]
    data["stiffness_jnds"] = ("law", steps)
    data["stiffness_jnds"].attrs = {
        "units": "1",
        "long_name": f"felt over wanted stiffness, in steps of {WEBER:.0%} ({SOURCE})",
        "touch": "press",
    }
    gains = [a.gain if a.extracts else min(a.gain, 0.0) for a in (attacks[name] for name in names)]
    data["gain"] = ("law", gains)
    data["gain"].attrs = {"units": "J", "long_name": "taken out by a round of the worst motion"}
    data["step_time"] = ("law", [times[name] for name in names])
    data["step_time"].attrs = {"units": "s", "long_name": "time of a simulated sample"}
    data["status"] = ("law", [standings[name].status for name in names])
    data["status"].attrs = {"long_name": "what is known for every hand"}
    return data
