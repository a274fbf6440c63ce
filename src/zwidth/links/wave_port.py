"""Waves with a ledger: passive whatever the link does to the packets.

The device is its own matched damper.  In each period, with a the wave received in metres and r = w/T,

    f = 2 r a,    u = Δx − a,    r u² = r a² − f Δx + r Δx²

so that the hand puts in f Δx less than the damping b Δx²/T takes, if w ≤ b.  A packet does not carry the
wave but the sums of all u and of their energies: what is lost on the way comes with the next one.
(Niemeyer and Slotine 1998 send both integrals over a link of varying delay.)  What has come and is not
yet used, d [m] and R [J], is used as

    a = min(|d|, R/(r |d|)) sgn d

which is the wave of a link that loses nothing; or T/(T + τ_s) of d at most, to smooth the force over τ_s.
An encoder of resolution Δ reads Δx no better than ± Δ, so

    R ← R − f Δx − c + b s²/T + f_c s,   s = max(0, |Δx| − Δ),   c = ½ Δ (|f| − |f⁻| + |f − f⁻|)

and |f| is kept so small that R ≥ 0 for every Δx; what that takes is held back until the force has acted.
The proof is in docs/theory/pairs.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from zwidth.links.memory import (
    ACTING,
    COULOMB,
    COUNTED,
    DAMPING,
    ENERGY,
    FORCE,
    HEARD_ENERGY,
    HEARD_POSITION,
    LOSSES,
    MOST_LATE,
    NUMBER,
    OWN_NUMBERS,
    OWN_STATE,
    PERIOD,
    POSITION,
    RESOLUTION,
    USED,
    WAVE,
    apply,
    queued,
)
from zwidth.links.waves import Waves
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import Quantity
from zwidth.quantity.parameter import Certain, parameter

# What friction has surely taken, from the counts of an encoder.
#
# Over n periods in which the reading changes by N counts the device has gone s = (|N| − 1)₊ Δ at least, so
# that
#
#     b s²/(n T) + f_c s
#
# is lost at least: b ∫v² ≥ b s²/(n T) by Cauchy and Schwarz.  Losses of periods that do not overlap add, so
#
#     V_k = max over n of V_{k−n} + b s²/(n T) + f_c s
#
# is lost by sample k at least: slow motion is seen in long windows, quick motion in short ones.  n is a power
# of two here.  Where Δ = 0 one period is the best window.


ROUNDING = 2.0**-48
"""Of sums of a few terms, and of the device's numbers: all is rounded to the side of less energy."""

WINDOW = 64
_AT, _SINCE = LOSSES, LOSSES + 1
"""Sample, in the ring; how many samples there are behind it."""
_COUNTS = LOSSES + 2
_LOST = _COUNTS + WINDOW
SIZE = 2 + 2 * WINDOW


@compiled
def newly_lost(p: Array, s: Array, moved: float) -> float:
    """V_k − V_{k−1} [J], for the displacement that was read over the period."""
    step = p[RESOLUTION]
    if step == 0.0:
        return at_least(p, abs(moved), 1.0)
    before = int(s[_AT])
    now = (before + 1) % WINDOW
    if now == 0:  # told from here: sums of much energy would lose the digits of little
        base = s[_LOST + before]
        for k in range(WINDOW):
            s[_LOST + k] -= base
    counts = s[_COUNTS + before] + np.floor(moved / step + 0.5)
    lost, n = s[_LOST + before], 1
    while n < WINDOW and n <= s[_SINCE] + 1.0:
        then = (now + WINDOW - n) % WINDOW
        sure = (abs(counts - s[_COUNTS + then]) - 1.0) * step
        more, base = at_least(p, max(sure, 0.0), float(n)), s[_LOST + then]
        lost = max(lost, base + more - ROUNDING * (abs(base) + more))
        n *= 2
    gain: float = lost - s[_LOST + before]
    s[_COUNTS + now], s[_LOST + now], s[_AT] = counts, lost, float(now)
    s[_SINCE] = min(s[_SINCE] + 1.0, float(WINDOW))
    return gain


@compiled
def at_least(p: Array, way: float, n: float) -> float:
    """b s²/(n T) + f_c s."""
    lost: float = (p[DAMPING] * way / (n * p[PERIOD]) + p[COULOMB]) * way
    return lost


WAVE_PORT = 1.0

IMPEDANCE, SMOOTHING = OWN_NUMBERS, OWN_NUMBERS + 1
RESERVE, OWED, HELD, CHARGE = range(OWN_STATE, OWN_STATE + 4)
"""R [J]; energy still to be sent [J]; of the force that acts in this period what is held back for it and
c [J]."""
_HELD = OWN_STATE + 4
_CHARGES = _HELD + MOST_LATE + 1

_DOWN = 1.0 - ROUNDING
MARGIN = 1.0 - 1e-12
_SMOOTHING = Quantity("smoothing", "τ_s", "s", "s", "time constant that smooths the force")


@compiled
def force(p: Array, s: Array) -> float:
    """The force on the device for the coming period [N; N·m], positive along x."""
    told = s[HEARD_ENERGY] * _DOWN
    reserve = s[RESERVE]
    if told > s[COUNTED]:
        reserve += told - s[COUNTED]
        s[COUNTED] = told
    reserve -= ROUNDING * abs(reserve)
    r = p[IMPEDANCE] / p[PERIOD]
    missing = s[HEARD_POSITION] - s[USED]
    size = abs(missing)
    wanted = 0.0
    if reserve > 0.0 and size > 0.0:
        share = p[PERIOD] / (p[PERIOD] + p[SMOOTHING])
        wanted = 2.0 * r * min(share * size, reserve / (r * size))
    if missing < 0.0:
        wanted = -wanted
    before = s[FORCE]
    same = abs(before) if before * wanted > 0.0 else 0.0
    size = min(abs(wanted), affordable(p, reserve, same))
    f = apply(p, s, size if wanted >= 0.0 else -size)
    charge = 0.5 * p[RESOLUTION] * (abs(f) - abs(before) + abs(f - before))
    held = (1.0 + ROUNDING) * at_worst(p, abs(f)) + charge
    s[RESERVE] = reserve - held
    s[HELD], s[CHARGE] = queued(p, s, _HELD, held), queued(p, s, _CHARGES, charge)
    s[USED] += f / (2.0 * r)
    return f


@compiled
def at_worst(p: Array, size: float) -> float:
    """The most that a force of this size costs, but for c: max (f Δx − b s²/T − f_c s) over all readings [J].

    (|f| − f_c)₊² T/(4b) + |f| Δ; without damping |f| is at most f_c.
    """
    more = max(0.0, size - p[COULOMB])
    bend = p[PERIOD] / (4.0 * p[DAMPING]) if p[DAMPING] > 0.0 else 0.0
    cost: float = bend * more * more + p[RESOLUTION] * size
    return cost


@compiled
def affordable(p: Array, reserve: float, before: float) -> float:
    """The largest |f| that R pays for in every case; `before` is that of the last period, of the same sign.

    max (f Δx − b s²/T − f_c s) + c = (|f| − f_c)₊² T/(4b) + |f| Δ + Δ (|f| − |f⁻|)₊ ≤ R; by rounding R may be
    a little below 0.
    """
    if reserve <= 0.0:
        return 0.0
    step = p[RESOLUTION]
    size = _pays(p, reserve, step)
    if size > before:
        size = _pays(p, reserve + step * before, 2.0 * step)
    return size * MARGIN


@compiled
def _pays(p: Array, reserve: float, slope: float) -> float:
    """The largest f with (f − f_c)₊² T/(4b) + slope f ≤ R."""
    coulomb: float = p[COULOMB]
    left = reserve - slope * coulomb
    if left <= 0.0:
        return reserve / slope if slope > 0.0 else coulomb
    if p[DAMPING] == 0.0:
        return coulomb
    bend = p[PERIOD] / (4.0 * p[DAMPING])
    return coulomb + 2.0 * left / (slope + sqrt(slope * slope + 4.0 * bend * left))


@compiled
def send(p: Array, s: Array, moved: float) -> None:
    """Book the displacement that was read over the period, and make the next packet."""
    f, charge, reserve = s[ACTING], s[CHARGE], s[RESERVE] + s[HELD]
    r = p[IMPEDANCE] / p[PERIOD]
    paid = reserve + newly_lost(p, s, moved)
    work = f * moved
    left = paid - work - charge - ROUNDING * (abs(paid) + abs(work) + charge)
    wave = moved - f / (2.0 * r)
    owed = s[OWED] + r * wave * wave
    total = s[ENERGY] + max(0.0, min(owed, left - ROUNDING * s[ENERGY]))
    gone = total - s[ENERGY]
    s[OWED] = max(0.0, owed - gone)
    s[RESERVE], s[ENERGY] = left - gone, total
    s[WAVE] = sqrt(gone) if wave > 0.0 else -sqrt(gone)
    s[POSITION] += wave
    s[NUMBER] += 1.0


@dataclass(frozen=True)
class WavePort(Waves):
    """Waves with a ledger: passive whatever the link does to the packets, encoder and all.

    ``f = 2 (w/T) a``, where a is the wave received [m], and ``u = Δx − a`` is sent: the device's own damping
    b takes what the hold feeds. The ledger counts what has come, what the force does at worst between two
    counts, and what friction surely takes; the force is never more than it pays for.

    Parameters
    ----------
    device
        What the port drives; its b and f_c are counted on, so give no more than is sure.
    impedance
        w > 0 [N·s/m; N·m·s/rad]; None: the device's damping. The same at both ends, at most the smaller
        damping for waves that are never cut; larger is passive too, and cut at high speeds.
    smoothing
        τ_s ≥ 0, a time constant: against the chatter that jitter and encoder counts make, as much delay [s].
    """

    title: ClassVar[str] = "waves with a ledger"
    code: ClassVar[float] = WAVE_PORT
    has_ledger: ClassVar[bool] = True
    steps: ClassVar = (force, send)

    smoothing: Certain = parameter(
        _SMOOTHING, 0, kept=Exact, bound="≥ 0", why="a force cannot be smoothed over what is still to come"
    )
