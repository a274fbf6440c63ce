"""How long the pulses are, and whether the force was recorded late: decided on the first samples.

Short pulses are many, but the encoder's counts show in them; long ones do not fit into a stroke.
What a pulse twice as long changes is taken for the error of the method itself, and the length is
the one with the shortest intervals.

A force that is recorded τ late is f(t − τ).  Where −τ df/dt is seen in what is left over, the forces
are read later until nothing is seen.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

import numpy as np

from zwidth.data.identification.device.estimate import FEWEST, Regression, regress
from zwidth.data.identification.device.moments import Moments, Piece, pieces
from zwidth.data.identification.device.pulses import pulse
from zwidth.data.logs import Log
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import shown

LENGTHS = (4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128, 192, 256)
"""Samples h of a piece of a pulse that are tried."""

LONGER = 2
"""Times the length of the other pulses, which show what the length matters."""

SAFETY = 4 / 3
"""Times that change which is taken for the error of the method: an error that falls as h⁻² needs
1/(1 − 2⁻²); those of counts and curves fall faster."""

SHARE = 0.5
"""Part of the strokes that the longer pulses must still fit into."""

PILOT = 300_000
"""Samples of the beginning on which this is decided."""

SURE = 0.999
"""Confidence above which a further term is believed to be there."""

KNEE = 0.6
"""Times the mean speed of the strokes: where friction may begin to be larger, the slower (Stribeck)."""

LATENESS = 0.05
"""Parts of a sample below which a force is in time."""

ROUNDS = 4
"""Steps of the secants."""

Zero = Literal["drifts", "constant", "exact"]


class Choice(NamedTuple):
    piece: int
    """h, samples of a piece of a pulse."""
    late: float
    """Samples by which forces were recorded late."""
    knee: float
    """Speed below which friction may be larger than its curve [m/s; rad/s]."""
    shares: tuple[float, float] = (1.0, 1.0)
    """Of these pulses and of the longer ones, the part of the variance of df/dt that is motion; the rest
    is noise, which makes the coefficient of −df/dt too small."""


def choose(log: Log, names: tuple[str, ...], mass: float | None, delay: float, zero: Zero) -> Choice:
    """Decide, for a fit of the named parameters and a delay of the actuator's force [samples]."""
    beginning = list(_first(pieces(log)))
    knee = KNEE * _mean_speed(beginning, log.sample_period)
    pilot = _Pilot(beginning, log.sample_period, knee, names, mass, delay, zero)
    piece = pilot.best_piece(0.0)
    if piece is None:
        raise InputError(too_little(log, zero))
    if not log.channels:
        return Choice(piece, 0.0, pilot.knee)
    late, longer = pilot.lateness(piece), pilot.lateness(LONGER * piece)
    if abs(late) <= SAFETY * abs(late - longer):  # counts of a coarse encoder look late too, to short pulses
        return Choice(piece, 0.0, pilot.knee)
    piece = pilot.best_piece(late) or piece
    return Choice(piece, late, pilot.knee, (pilot.share(piece, late), pilot.share(LONGER * piece, late)))


def shifts(fit: Regression, longer: Regression) -> Array:
    """What the method may be off, by the change with longer pulses."""
    change: Array = np.abs(fit.values - longer.values)
    return SAFETY * change


def too_little(log: Log, zero: Zero) -> str:
    """The message where nothing can be told."""
    pilot = list(_first(pieces(log)))
    strokes = sum(p.strokes.first.size for p in pilot)
    seconds = sum(p.position.size for p in pilot) * log.sample_period
    counted = f"{strokes} stroke{'' if strokes == 1 else 's'}"
    if zero != "exact" and FEWEST < strokes < 2 * len(pilot):
        return (
            f"{log.source}: {counted} in {len(pilot)} runs, of each of which the zero of the force is fitted "
            "too, and too little is left; where nothing but friction slows the handle (level, no spring) say "
            "so, --zero exact or zero='exact', else record several strokes in a row"
        )
    return (
        f"{log.source}: too little motion to tell mass, damping and friction apart: {counted} in "
        f"{shown(seconds, 's', 3)}, too few long ones, or all alike; move to and fro for a minute, over most "
        "of the workspace, slowly and quickly, and do not rest"
    )


class _Pilot(NamedTuple):
    pieces: list[Piece]
    period: float
    knee: float
    names: tuple[str, ...]
    mass: float | None
    delay: float
    zero: Zero

    def sums(self, piece: int, late: float) -> Moments:
        shape, found = pulse(piece, self.delay, late), Moments(self.knee)
        for stretch in self.pieces:
            found.add(stretch.pulses(shape, self.period), self.zero)
        return found

    def best_piece(self, late: float) -> int | None:
        sums: dict[int, Moments] = {}
        halves: dict[int, Array] = {}
        for piece in LENGTHS:
            for h in (piece, LONGER * piece):
                if h not in sums:
                    sums[h] = self.sums(h, late)
            short, long = sums[piece], sums[LONGER * piece]
            fit, longer = (regress(m, self.names, self.mass) for m in (short, long))
            if fit is None or longer is None or long.strokes < SHARE * short.strokes:
                break
            halves[piece] = fit.reach(0.95) * np.sqrt(np.diag(fit.covariance)) + shifts(fit, longer)
        if not halves:
            return None
        best = np.min(list(halves.values()), axis=0)
        return min(halves, key=lambda h: float((halves[h] / best).sum()))

    def lateness(self, piece: int) -> float:
        """The τ at which nothing of −τ df/dt is left, by secants [samples]; 0 where nothing is seen."""
        fit = self.lag(piece, 0.0)
        if fit is None or abs(fit.value("force_lag")) < max(
            LATENESS * self.period, fit.reach(SURE) * fit.error("force_lag")
        ):
            return 0.0
        late = 0.0
        for _ in range(ROUNDS):
            fit, share = self.lag(piece, late), self.share(piece, late)
            if fit is None or share <= 0:
                break
            late += fit.value("force_lag") / (share * self.period)
        return late

    def share(self, piece: int, late: float) -> float:
        """By how much the coefficient of −df/dt falls where forces are read later: 1 without noise."""
        before, after = self.lag(piece, late - 1.0), self.lag(piece, late + 1.0)
        if before is None or after is None:
            return 1.0
        return (before.value("force_lag") - after.value("force_lag")) / (2 * self.period)

    def lag(self, piece: int, late: float) -> Regression | None:
        return regress(self.sums(piece, late), (*self.names, "force_lag"), self.mass)


def _mean_speed(stretches: Iterable[Piece], period: float) -> float:
    """Way by time of all strokes [m/s; rad/s]; 1 where there are none."""
    way = samples = 0.0
    for position, strokes, _ in stretches:
        way += float(np.abs(position[strokes.last] - position[strokes.first]).sum())
        samples += float((strokes.last - strokes.first).sum())
    return way / (samples * period) if way > 0 else 1.0


def _first(stream: Iterable[Piece]) -> Iterable[Piece]:
    held = 0
    for piece in stream:
        yield piece
        held += piece.position.size
        if held >= PILOT:
            return
