"""What one way through a log leaves, and the parameters that follow from it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.data.identification.device import pulses
from zwidth.data.identification.device.choice import LONGER, SAFETY, SURE, Choice, Zero, shifts
from zwidth.data.identification.device.estimate import Directions, Estimate, Regression, regress, unit_of
from zwidth.data.identification.device.moments import REGRESSORS, Moments, halves, line, pieces
from zwidth.data.identification.device.pulses import Pulse, pulse
from zwidth.data.logs import Log
from zwidth.loop.trace import Labelled, Trace
from zwidth.native.compiled import Array
from zwidth.quantity.glossary import GLOSSARY

if TYPE_CHECKING:
    from numpy.typing import NDArray

HINT = 0.8
"""Confidence above which a bend that differs by direction is fitted, not only believed: it costs width."""


class Found(NamedTuple):
    shape: Pulse
    late: float
    """By which the forces were recorded late [s]."""
    shares: tuple[float, float]
    moments: Moments
    longer: Moments
    """Of the pulses, and of those twice as long."""
    points: Points
    """Some pulses, for pictures."""
    mass: float | None
    """Where it is given, and not fitted [kg; kg·m²]."""
    motion: str

    def regression(self, names: tuple[str, ...]) -> Regression | None:
        """The named parameters by the pulses."""
        return regress(self.moments, names, self.mass, self.shares[0])

    def estimates(self, names: tuple[str, ...]) -> dict[str, Estimate] | None:
        """The named parameters with all their uncertainty; None where there are too few strokes."""
        fit = self.regression(names)
        longer = regress(self.longer, names, self.mass, self.shares[1])
        if fit is None or longer is None:
            return None
        offsets = {"force_lag": self.late}
        return {
            name: Estimate(
                fit.value(name) + offsets.get(name, 0.0),
                fit.error(name),
                float(shift),
                fit.degrees,
                unit_of(name, self.motion),
            )
            for name, shift in zip(names, shifts(fit, longer), strict=True)
        }

    def directions(self, names: tuple[str, ...]) -> Directions | None:
        """Damping into the wall, b + a, and out of it, b − a; None where the strokes do not tell."""
        return self._directions((*names, "asymmetry"), 0.0)

    def slopes(self, names: tuple[str, ...], speed: float) -> Directions | None:
        """Slope of friction by speed, at this speed and in each direction, of a friction that is bent.

            f = f_c + (b ± a) |v| + (c ± e) v² + s max(1 − |v|/v_s, 0),     f' = b ± a + 2 (c ± e) |v|

        e, by which the bend differs, is fitted where there is a sign of it, s where slow pulses are long
        enough; None where the strokes do not tell.
        """
        bent = (*names, "asymmetry", "quadratic")
        for friction in dict.fromkeys(((*bent, *({"slow"} - {*names})), bent)):
            fit = self.regression((*friction, "quadratic_asymmetry"))
            differs = fit is not None and fit.sees("quadratic_asymmetry", HINT)
            found = self._directions(fit.names if fit is not None and differs else friction, speed)
            if found is not None:
                return found
        return None

    def _directions(self, names: tuple[str, ...], speed: float) -> Directions | None:
        fit, longer = self.regression(names), regress(self.longer, names, self.mass, self.shares[1])
        if fit is None or longer is None:
            return None
        unit = unit_of("damping", self.motion)

        def slope(both: float, side: float) -> Estimate:
            of = {"damping": both, "asymmetry": side}
            of |= {"quadratic": 2 * speed * both, "quadratic_asymmetry": 2 * speed * side}
            weights = np.array([of.get(name, 0.0) for name in names])
            shift = SAFETY * abs(float(weights @ (fit.values - longer.values)))
            error = float(np.sqrt(weights @ fit.covariance @ weights))
            return Estimate(float(weights @ fit.values), error, shift, fit.degrees, unit)

        return Directions(slope(1.0, 1.0), slope(1.0, -1.0), slope(0.0, 1.0))

    def sees(self, names: tuple[str, ...], term: str) -> bool:
        """True where one term more is larger than its uncertainty, that of the method included."""
        estimates = self.estimates((*names, term))
        return estimates is not None and estimates[term].beyond(SURE)


def gather(
    log: Log,
    choice: Choice,
    *,
    mass: float | None,
    delay: float,
    zero: Zero,
    progress: Callable[[int, int], None] | None,
) -> Found:
    """Go through the log once; `delay` of the actuator's force in samples."""
    shape, other = (pulse(h, delay, choice.late) for h in (choice.piece, LONGER * choice.piece))
    late = choice.late * log.sample_period
    sums, longer, points = Moments(choice.knee), Moments(choice.knee), Points(choice.knee)
    found = Found(shape, late, choice.shares, sums, longer, points, mass, log.motion)
    done = 0
    for piece in pieces(log):
        rows = piece.pulses(shape, log.sample_period)
        found.moments.add(rows, zero)
        found.points.add(rows, zero)
        found.longer.add(piece.pulses(other, log.sample_period), zero)
        done += piece.position.size
        if progress is not None:
            progress(done, log.samples)
    return found


MOST = 50_000
"""Pulses that are kept."""

_ABOUT = {
    "force": ("force", "force, without its zero"),
    "friction": ("force", "friction"),
    "residual": ("force", "left over"),
    "speed": ("speed", "velocity"),
    "time": ("s", "time in the piece"),
    "stroke": ("1", "number of the stroke"),
    "piece": ("1", "number of the piece"),
}
"""What is told of each pulse: its unit or the kind of it, its name."""


class Points:
    """Pieces of pulses, every one at first, then every second, every fourth, …"""

    def __init__(self, knee: float) -> None:
        self._knee = knee
        self._kept: list[tuple[Array, Array]] = []
        self._seen, self._stride = 0, 1

    def add(self, rows: Array, zero: str) -> None:
        if self._seen % self._stride == 0 and len(rows):
            self._kept.append((rows, line(rows, zero)))
            if sum(len(kept) for kept, _ in self._kept) > MOST:
                self._kept = self._kept[::2]
                self._stride *= 2
        self._seen += 1

    def labelled(self, fit: Regression, mass: float | None, motion: str) -> Trace:
        """Force, friction and what the fit leaves, along `pulse`; with speed, time, stroke and piece."""
        found: dict[str, list[NDArray[Any]]] = {key: [] for key in _ABOUT}
        strokes = 0
        for piece, (rows, basis) in enumerate(self._kept):
            even, odd = halves(rows, self._knee)
            columns = (even + odd) / 2
            terms = {name: fit.value(name) * columns[:, REGRESSORS.index(name)] for name in fit.names}
            if mass is not None:
                terms["mass"] = mass * columns[:, 0]
            explained = sum(terms.values(), np.zeros(len(rows)))
            left = columns[:, -1] - explained
            left = left - basis @ (basis.T @ left)
            _, stroke = np.unique(rows[:, pulses.STROKE], return_inverse=True)
            found["force"].append(explained + left)
            found["friction"].append(
                sum((terms[n] for n in ("damping", "coulomb_friction", "slow") if n in terms), left)
            )
            found["residual"].append(left)
            found["speed"].append(columns[:, 1])
            found["time"].append(rows[:, pulses.TIME])
            found["stroke"].append(stroke + strokes)
            found["piece"].append(np.full(len(rows), piece))
            strokes += int(stroke[-1]) + 1
        units = {
            "force": GLOSSARY["force"].unit_for(motion),
            "speed": GLOSSARY["friction_speed"].unit_for(motion),
        }
        data = {
            key: Labelled(
                ("pulse",),
                np.concatenate(parts),
                {"units": units.get(_ABOUT[key][0], _ABOUT[key][0]), "long_name": _ABOUT[key][1]},
            )
            for key, parts in found.items()
        }
        along = {key: data.pop(key) for key in ("speed", "time", "stroke", "piece")}
        return Trace(data, along, {})
