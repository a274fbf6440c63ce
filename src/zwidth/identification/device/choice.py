"""How long the pulses are, and whether the force was recorded late: decided on the first samples.

Short pulses are many, but the encoder's counts show in them; long ones do not fit into a stroke.
What a pulse twice as long changes is taken for the error of the method itself, and the length is
the one with the shortest intervals.

A force that is recorded τ late is f(t − τ).  Where −τ df/dt is seen in what is left over, the forces
are read so much later, again and again until nothing is seen.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

import numpy as np

from zwidth.compiled import Array
from zwidth.errors import InputError
from zwidth.identification.device.moments import Moments
from zwidth.identification.device.pieces import Piece, pieces
from zwidth.identification.device.pulses import pulse
from zwidth.identification.device.regression import Regression, regress
from zwidth.identification.logs import Log

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

LATENESS = 0.05
"""Parts of a sample below which a force is in time."""

ROUNDS = 20
"""Times that the forces are moved at most."""

Zero = Literal["drifts", "constant", "exact"]


class Choice(NamedTuple):
    """What was decided.

    Parameters
    ----------
    piece
        h, samples of a piece of a pulse.
    late
        Samples by which forces were recorded late.
    """

    piece: int
    late: float


def choose(log: Log, names: tuple[str, ...], mass: float | None, delay: float, zero: Zero) -> Choice:
    """Decide, for a fit of the named parameters and a delay of the actuator's force [samples].

    Raises
    ------
    InputError
        If the motion shows too little.
    """
    pilot = _Pilot(list(_first(pieces(log))), log.sample_period, names, mass, delay, zero)
    piece = pilot.best_piece(0.0)
    if piece is None:
        raise InputError(too_little(log))
    if not log.channels:
        return Choice(piece, 0.0)
    late = pilot.lateness(piece)
    return Choice(pilot.best_piece(late) or piece, late)


def shifts(fit: Regression, longer: Regression) -> Array:
    """What the method may be off, by the change with longer pulses."""
    change: Array = np.abs(fit.values - longer.values)
    return SAFETY * change


def too_little(log: Log) -> str:
    """The message where nothing can be told."""
    pilot = list(_first(pieces(log)))
    strokes = sum(p.strokes.first.size for p in pilot)
    seconds = sum(p.position.size for p in pilot) * log.sample_period
    return (
        f"{log.source}: the motion shows too little to tell mass, damping and friction apart: {strokes} "
        f"strokes in {seconds:.3g} s, too few of them long enough, or all too much alike; move to and fro "
        "for a minute, over most of the workspace, slowly and quickly, and do not rest"
    )


class _Pilot(NamedTuple):
    pieces: list[Piece]
    period: float
    names: tuple[str, ...]
    mass: float | None
    delay: float
    zero: Zero

    def sums(self, piece: int, late: float) -> Moments:
        shape, found = pulse(piece, self.delay, late), Moments()
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
        late = 0.0
        for _ in range(ROUNDS):
            fit = regress(self.sums(piece, late), (*self.names, "force_lag"), self.mass)
            if fit is None:
                return late
            more, error = (x / self.period for x in (fit.value("force_lag"), fit.error("force_lag")))
            if abs(more) < max(LATENESS, (fit.reach(SURE) if late == 0.0 else 1.0) * error):
                return late
            late += more
        return late


def _first(stream: Iterable[Piece]) -> Iterable[Piece]:
    held = 0
    for piece in stream:
        yield piece
        held += piece.position.size
        if held >= PILOT:
            return
