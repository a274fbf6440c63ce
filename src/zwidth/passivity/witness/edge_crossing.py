"""The motion that refutes Coulomb friction against the encoder: a tiny step to and fro over one edge.

Moving by ε over an edge changes the count by one, and with it the force by
Δ · (step response); Coulomb friction costs f_c ε each way and viscous friction
only ε² b/T, so a small enough ε gains (Abbott & Okamura 2005, section III-C).
The hand may wait at either side for the force to be as it likes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from zwidth.passivity.linear.loop import LinearLoop
from zwidth.passivity.witness.motion import Motion, Repeat, round_up

LONGEST_WAIT = 12
"""Samples the hand may wait on one side of an edge, beyond the delay."""

_APPROACH = 64
_HORIZON = 400


@dataclass(frozen=True)
class Waits:
    """How many samples to stay above and below the edge, and the force gained per count."""

    above: int
    below: int
    gain: float


def best_waits(loop: LinearLoop) -> Waits:
    """The waits that gain most force between going out and coming in [N/m], to rounding.

    Twice the Coulomb friction per resolution below this gain is too little.
    """
    response = _impulse_response(loop)
    extra = loop.whole_delay + (1 if loop.part_delay else 0)
    best = Waits(1 + extra, 1 + extra, float("-inf"))
    periods = range(2 * (1 + extra), 2 * (LONGEST_WAIT + extra) + 1)
    turns = {period: [sum(response[r::period]) for r in range(period)] for period in periods}
    for above in range(1, LONGEST_WAIT + 1):
        for below in range(1, LONGEST_WAIT + 1):
            gain = _gain(turns[above + below + 2 * extra], above + extra, loop)
            if gain > best.gain * (1 + 1e-12) + 1e-300:
                best = Waits(above + extra, below + extra, gain)
    return best


def _impulse_response(loop: LinearLoop) -> list[float]:
    """h(k) to rounding, from whole numbers: clustered poles cancel many digits."""
    d, n = loop.denominator, loop.numerator
    bits = 64 + 16 * len(d)
    h: list[int] = []
    for k in range(_HORIZON):
        value = (n[k] << bits) if k < len(n) else 0
        value -= sum(d[i] * h[k - i] for i in range(1, min(k, len(d) - 1) + 1))
        h.append(value // d[0])
    return [float(Fraction(v, 1 << bits)) if abs(v) >> bits < 10**100 else 0.0 for v in h]


def _gain(turn: list[float], above: int, loop: LinearLoop) -> float:
    """Force going out minus force coming in over one settled cycle, per count.

    `turn` is h summed over all cycles that came before, for each sample of a cycle.
    """
    period, d, alpha = len(turn), loop.whole_delay, float(loop.part_delay)

    def force(phase: int) -> float:
        """Computed `phase` samples after coming above."""
        return sum(turn[(phase - k) % period] for k in range(above))

    def applied(phase: int) -> float:
        return alpha * force(phase - d - 1) + (1 - alpha) * force(phase - d)

    return applied(above - 1) - applied(period - 1)


def edge_crossing(
    loop: LinearLoop, coulomb_friction: Fraction, resolution: Fraction, waits: Waits, edge: int
) -> Motion | None:
    """To and fro over the edge `edge` counts from x = 0, going there first; None if that gains nothing."""
    surplus = Fraction(waits.gain) * resolution - 2 * coulomb_friction
    if surplus <= 0:
        return None
    step = resolution / 4
    if loop.damping > 0:
        step = min(step, round_up(surplus * loop.period / (4 * loop.damping)) / 2)
    at = edge * resolution
    below, above = at - step, at  # the floor is taken at the edge itself
    if edge:
        below, above = at - step / 2, at + step / 2
    approach = [below * k / _APPROACH for k in range(_APPROACH + 1)] if edge else [above]
    lead = approach + [below] * (loop.whole_delay + 2)
    cycle = [above] * waits.above + [below] * waits.below
    x = tuple(lead + cycle * 2)
    first = len(lead) + len(cycle) - 1
    switches = tuple(a + loop.part_delay * (b - a) for a, b in zip(x, x[1:], strict=False))
    return Motion(x, switches if loop.part_delay else (), (Repeat(first, len(x) - 1, 1),))
