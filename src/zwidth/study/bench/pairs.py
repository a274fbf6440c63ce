"""Ways to join two arms beside each other: what is proved, what the leader feels, how far they are apart."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from zwidth.errors import InputError
from zwidth.loop.simulate import simulate
from zwidth.loop.traces.measures import static_stiffness, tracking_error
from zwidth.model.environment import Wall
from zwidth.model.operator import PrescribedMotion, RecordedForce
from zwidth.model.pairs import Pair
from zwidth.passivity.pairs import PairCriterion, PairVerdict, check_pair
from zwidth.quantity.answered import finite
from zwidth.quantity.documented import Documented
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import shown, unit_text
from zwidth.showing import Part, Table

if TYPE_CHECKING:
    import xarray as xr

HARD = 100
"""How many times stiffer than the coupling the wall is that the follower meets."""

_FAR = {"linear": 0.01, "rotary": 0.1}
"""How far the leader goes [m; rad]."""

_PRESS, _RISE, _STROKE = 2.0, 0.5, 2.0
"""How long is pushed, the force rising for a part of it; and how long one to and fro takes [s]."""

_ANGLES = np.append(np.geomspace(1e-6, 0.01, 40), np.linspace(0.01, np.pi, 2000))


@dataclass(frozen=True, repr=False)
class PairComparison(Documented):
    """What became of each way to join two arms.

    Attributes
    ----------
    scores
        Dimension `scheme`; `outcome` and `largest_stiffness` of the verdict; `felt_stiffness`, of the leader
        against a real wall at the follower that is `HARD` times as stiff as the coupling; `tracking_error`,
        root mean square of x_l − x_f while the leader is led to and fro and nobody holds the follower;
        `missing_damping`, what both arms lack at the frequency that is worst for two hands, 0 where nothing
        is missing.  Units and meanings in the attributes.
    verdicts
        Of each, with its proof or its motion.
    traces
        By scheme: `press` and `stroke`.
    """

    _FORMAT: ClassVar[str] = "zwidth pairs 1"

    scores: xr.Dataset
    verdicts: Mapping[str, PairVerdict]
    traces: Mapping[str, Mapping[str, xr.Dataset]]

    def to_dict(self) -> dict[str, Any]:
        """The scores by scheme, a unit in every key of a physical quantity."""
        schemes = {
            name: {
                "outcome": verdict.outcome,
                **{
                    f"{key}_{unit_suffix(self.scores[key].attrs['units'])}": finite(
                        float(self.scores[key].sel(scheme=name))
                    )
                    for key in _SCORES
                },
                "motion_energy_J": None if verdict.witness is None else verdict.witness.energy,
                "motion_duration_s": None if verdict.witness is None else verdict.witness.duration,
            }
            for name, verdict in self.verdicts.items()
        }
        return {"format": self._FORMAT, "schemes": schemes}

    def report(self) -> Iterable[Part]:
        """Which are passive, and a table, a row for each."""
        passive = [name for name, verdict in self.verdicts.items() if verdict.passive]
        yield f"passive with every two hands: {', '.join(passive) or 'none'}"
        yield ""
        told = [self.scores[key].attrs for key in _SCORES]
        heads = [
            ("", "two hands", *(about["long_name"] for about in told), "the worst hands take"),
            ("", "", *(unit_text(about["units"]) for about in told), ""),
        ]
        rows = [(name, *self._cells(name)) for name in self.verdicts]
        yield Table(heads=heads, rows=rows, lefts=2)

    def _cells(self, name: str) -> list[str]:
        verdict = self.verdicts[name]
        numbers = [finite(float(self.scores[key].sel(scheme=name))) for key in _SCORES]
        worst = "nothing"
        if verdict.outcome != "passive":
            witness = verdict.witness
            worst = "?"
            if witness is not None:
                worst = f"{shown(witness.energy, 'J')} in {shown(witness.duration, 's')}"
        return [verdict.outcome, *("" if v is None else f"{v:.4g}" for v in numbers), worst]


_SCORES = {
    "largest_stiffness": ("stiffness", "passive up to"),
    "felt_stiffness": ("stiffness", "felt at the leader"),
    "tracking_error": ("position", "arms apart, rms"),
    "missing_damping": ("damping", "damping missing"),
}
"""Of each number what it is, and its meaning in a few words."""


def schemes(pair: Pair) -> dict[str, Pair]:
    """A pair as it is, and joined by positions, by a force, by both, the stiffness at the leader the same.

    Of the follower's force as much is sent as the leader's spring is of its own.
    """
    felt, ratio = pair.felt_stiffness, pair.power_ratio
    none = {"reflection": 0, "follower_reflection": 0}
    ways: dict[str, dict[str, Any]] = {
        "position–position": {**none, "stiffness": felt, "follower_stiffness": felt / ratio},
        "position–force": {**none, "stiffness": 0, "follower_stiffness": felt / ratio, "reflection": ratio},
        "four channels": {
            "stiffness": felt / 2,
            "follower_stiffness": felt / ratio / 2,
            "reflection": ratio,
            "follower_reflection": 1 / ratio,
        },
    }
    found = {name: pair.replace(**changes) for name, changes in ways.items()}
    is_one = pair.sides in [other.sides for other in found.values()]
    return found if is_one else {"as given": pair, **found}


def compare_pairs(
    pairs: Mapping[str, Pair], *, progress: Callable[[int, int], None] | None = None
) -> PairComparison:
    """Decide each pair, press the follower against a hard real wall, and lead both arms to and fro.

    Parameters
    ----------
    pairs
        By name, such as ``{"positions": pair, "forces": pair.replace(stiffness=0, …)}``; arms with a mass.
    progress
        Told (pairs done, pairs in all).

    Raises
    ------
    InputError
        If there is none, they do not move alike, or an arm has no mass.
    """
    if not pairs or not all(isinstance(pair, Pair) for pair in pairs.values()):
        raise InputError('pairs are compared by name: {"positions": zwidth.Pair(…), …}, one at least')
    motions = {pair.motion for pair in pairs.values()}
    if len(motions) > 1:
        raise InputError("linear and rotary pairs have no common unit: compare them apart")
    verdicts, traces = {}, {}
    for done, (name, pair) in enumerate(pairs.items()):
        if progress is not None:
            progress(done, len(pairs))
        verdicts[name] = check_pair(pair)
        traces[name] = {"press": _press(pair), "stroke": _stroke(pair)}
    return PairComparison(_dataset(verdicts, traces), verdicts, traces)


def _press(pair: Pair) -> xr.Dataset:
    """The leader is pushed slowly harder, the follower meets a wall that is there."""
    tick = float(pair.sample_period) / pair.own_readings
    time = np.arange(round(_PRESS / tick)) * tick
    most = float(pair.felt_stiffness) * _FAR[pair.motion]
    push = RecordedForce(most * np.minimum(time / _RISE, 1.0))
    wall = Wall(float(pair.felt_stiffness) * HARD)
    return simulate(pair, push, wall, len(time) * pair.sample_period / pair.own_readings)


def _stroke(pair: Pair) -> xr.Dataset:
    """The leader is led to and fro, smoothly; nobody holds the follower."""
    far = _FAR[pair.motion]
    path = PrescribedMotion(lambda t: far * float(np.sin(np.pi * t / _STROKE)) ** 2)
    return simulate(pair, path, None, _STROKE)


def missing_damping(pair: Pair) -> float:
    """−min λ(M(θ)): what both arms lack of damping at the worst frequency [N·s/m; N·m·s/rad]; or 0."""
    criterion = PairCriterion(pair)
    least = min(float(np.linalg.eigvalsh(criterion.at(theta))[0]) for theta in _ANGLES)
    return max(0.0, -least)


def _dataset(
    verdicts: Mapping[str, PairVerdict], traces: Mapping[str, Mapping[str, xr.Dataset]]
) -> xr.Dataset:
    import xarray as xr

    pairs = {name: verdict.pair for name, verdict in verdicts.items()}
    values: dict[str, list[float]] = {
        "largest_stiffness": [verdict.largest_stiffness or 0.0 for verdict in verdicts.values()],
        "felt_stiffness": [_felt(own["press"]) for own in traces.values()],
        "tracking_error": [tracking_error(own["stroke"]) for own in traces.values()],
        "missing_damping": [missing_damping(pair) for pair in pairs.values()],
    }
    motion = next(iter(pairs.values())).motion
    variables = {
        key: (
            "scheme",
            np.array(values[key]),
            {"units": GLOSSARY[quantity].unit_for(motion), "long_name": meaning},
        )
        for key, (quantity, meaning) in _SCORES.items()
    }
    outcomes = ("scheme", [verdict.outcome for verdict in verdicts.values()])
    return xr.Dataset({"outcome": outcomes, **variables}, coords={"scheme": list(pairs)})


def _felt(trace: xr.Dataset) -> float:
    """nan where the press does not come to rest."""
    leader = trace.sel(arm="leader")
    found = static_stiffness(leader)
    speed = np.abs(leader["velocity"].values[-leader.sizes["time"] // 10 :]).max()
    swings = speed > 0.1 * np.abs(leader["velocity"].values).max()
    return float("nan") if swings or "diverged_at_s" in trace.attrs else found
