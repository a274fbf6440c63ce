"""Laws that bound the force by what the hand has put in: force bounding, energy bounding.

Force bounding: never more force than the energy at hand can pay, wherever the hand goes next.

    E ← E + (b/T) Δx² + f Δx             the hand has put in at least this; f was held
    |f| ≤ 2 √(b E/T)                     for then (b/T) Δx² + f Δx ≥ −f² T/(4b) ≥ −E

so E ≥ 0 for ever, E(0) = 0.  That is the public law, for an ideal encoder.  Counts of size Δ break it: a hand
that stands at an edge is credited with (b/T) Δ² per sample for moves that it does not make.

Counted, derived for this project: the hand has put in at least V(x) = E + g (x − c) when it
is at x, anywhere in the count around c.  A move of D between the middles of two counts leaves

    E ← E + g' D − ((|g' − f| − f_c)₊)² T/(4b) − |g' − g| Δ/2,   g ← g'      for every g'

of which the best is taken, and the force is bounded by

    |f| ≤ f_c + 2 √(b S/T),   S = E − |g| Δ/2 ≥ 0, the least of V in the count.

At Δ = f_c = 0 it is the public law.  Proofs: docs, "Laws that bound the force".

Numbers are rounded, so each line is kept a hair below the one that was computed: ε = 2⁻⁴⁸ of
all that was summed, which is more than what rounding can add, for ever.  A hand that stays pays none.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import ClassVar, Literal

from zwidth.model.rendering.reading import above, below, damping_per_sample, half_step
from zwidth.model.rendering.rendering_law import LoopContext, RenderingLaw, Theorem
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.parameter import flag, word

FORCE_BOUNDING = 20.0

HAIR, SINGLE_HAIR = 2.0**-48, 2.0**-19
"""ε, relative: 32 roundings of a double, of a float."""

_PAID, _FRICTION, _COUNT, _FORCE_HALF_STEP, _RESETS, _HAIR = range(6)
_FORCE_BEFORE, _ENERGY, _SLOPE = range(3)


@dataclass(frozen=True, kw_only=True)
class ForceBounding(RenderingLaw):
    """``|f| ≤ 2 √(b E/T)``, E what the hand has put in, device damping counted.

    Proved, with a certificate from `zwidth.check`: no motion of any hand takes energy out, whatever the
    environment.  Hypotheses: the device takes at least b and, counted, f_c; no delay, regular samples, no law
    behind this one, an amplifier without lag.  "ideal" needs an encoder without counts as well.

    Parameters
    ----------
    encoder
        "counted": with the counts of the device's encoder, f_c counted as paying.  "ideal": the public
        law, as if readings were positions and f_c = 0.
    resets
        True to forget the energy where the force was 0, as the public code does: the hand then begins
        each contact without credit for what its free motion dissipated.

    Raises
    ------
    InputError
        If an argument is not one of these; when it is simulated, if the device has no damping.

    Notes
    -----
    A public implementation; the law for an encoder is derived for this project.
    """

    code: ClassVar[float] = FORCE_BOUNDING
    state_size: ClassVar[int] = 3
    bounds_the_force: ClassVar[bool] = True

    encoder: Literal["counted", "ideal"] = word("counted", "ideal")
    resets: bool = flag("to forget the energy where there was no force", False)

    def numbers(self, at: LoopContext) -> list[float]:
        friction, size = 0.0, 0.0
        hair = SINGLE_HAIR if at.single else HAIR
        if self.encoder == "counted":
            friction = below(at.device.exact("coulomb_friction") * (1 - Fraction(hair)), at.single)
            size = above(at.device.exact("resolution"), at.single)
        paid = damping_per_sample(at, "force bounding")
        return [paid, friction, size, half_step(at), float(self.resets), hair]

    def describe(self, motion: str = "linear") -> str:
        return f"force bounding ({self.encoder} encoder{', resets' if self.resets else ''})"


@compiled
def force_bounding_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    paid, friction, half = p[i + _PAID], p[i + _FRICTION], p[i + _COUNT] / 2
    hair = p[i + _HAIR]
    less, more = 1.0 - hair, 1.0 + hair
    energy, slope = s[j + _ENERGY], s[j + _SLOPE]
    if p[i + _RESETS] > 0.0 and applied == 0.0:
        energy, slope = 0.0, 0.0
    before = s[j + _FORCE_BEFORE]
    moved = x - before
    # the slopes between which the best is found: where the friction's own slope is that of a move
    # half a count shorter, or longer, than the reading's
    low, high = applied - friction, applied + friction
    if moved != 0.0:
        middle = applied + (friction if moved > 0.0 else -friction) + 2 * paid * moved
        low, high = middle - 2 * paid * half, middle + 2 * paid * half
    new = min(max(slope, low), high)
    swing = abs(new - applied)
    beyond = max(swing - friction, 0.0)
    if moved != 0.0 or new != slope or beyond > 0.0:
        reach, turn = swing + friction, abs(new - slope) * half
        size = abs(energy) + abs(new) * (abs(x) + abs(before)) + reach * reach / (4 * paid) + turn
        energy = energy + new * moved - beyond * beyond / (4 * paid) - turn - hair * size
    spare = less * energy - more * abs(new) * half
    if spare < 0.0:  # it was proved to be at least 0: V = 0 is as true, and better
        energy, new, spare = 0.0, 0.0, 0.0
    s[j + _FORCE_BEFORE], s[j + _ENERGY], s[j + _SLOPE] = x, energy, new
    room = max(less * (friction + 2 * sqrt(paid * spare)) - p[i + _FORCE_HALF_STEP], 0.0)
    bounded: float = min(max(force, -room), room)
    return bounded


# Energy bounding: the force changes by a stiffness times the move, and that stiffness is bounded.
#
#     f_k = f_{k−1} + β_k Δx_k,   β_k between 2b/T and −2b/T − 2 f_{k−1}/Δx_k
#     that is                     |f_k| ≤ |f_{k−1} + (2b/T) Δx_k|
#
# Kim & Ryu (2010) published the form; their constants are not known here, and these are derived for this
# project.  With c = 2b/T the energy S = f²/(2c) = f² T/(4b) is what the next move can take out at most, and
#
#     S_k ≤ (f_{k−1} + c Δx)²/(2c) = S_{k−1} + f_{k−1} Δx + (b/T) Δx²
#
# is the bound: what is stored grows by no more than what came in.  It is the tightest for
# this S, and no law that knows f alone has a smaller S.  Energy bounding is force bounding
# that keeps no credit: E is set to f² T/(4b) in each sample.

ENERGY_BOUNDING = 22.0

_STIFFEST, _ENERGY_HALF_STEP = range(2)
_ENERGY_BEFORE = 0


@dataclass(frozen=True, kw_only=True)
class EnergyBounding(RenderingLaw):
    """``|f_k| ≤ |f_{k−1} + (2b/T) Δx_k|``: the wall is nowhere stiffer than the device can pay.

    Proved: no motion of any hand takes energy out, whatever the environment.  Hypotheses: the device
    takes at least b; an encoder without counts; no delay, regular samples, no law behind this one, an
    amplifier without lag.  With counts it fails where f_c < b Δ/(2T): docs, "Laws that bound the force".

    Raises
    ------
    InputError
        When it is simulated, if the device has no damping.
    """

    code: ClassVar[float] = ENERGY_BOUNDING
    state_size: ClassVar[int] = 1

    def numbers(self, at: LoopContext) -> list[float]:
        return [2 * damping_per_sample(at, "energy bounding"), half_step(at)]

    def theorem(self, at: LoopContext) -> Theorem:
        """Half a step of the converter is kept below the bound, and the law is told what was applied."""
        return Theorem(
            statement="energy bounding: what the next move can take out grows by no more than what came in",
            counts_force_steps=True,
            counts_force_limit=True,
        )

    def describe(self, motion: str = "linear") -> str:
        return "energy bounding"


@compiled
def energy_bounding_step(p: Array, i: int, s: Array, j: int, x: float, force: float, applied: float) -> float:
    """One sample; p from i and s from j on are this law's, `applied` is the force that was held."""
    moved = x - s[j + _ENERGY_BEFORE]
    s[j + _ENERGY_BEFORE] = x
    room = max(abs(applied + p[i + _STIFFEST] * moved) - p[i + _ENERGY_HALF_STEP], 0.0)
    bounded: float = min(max(force, -room), room)
    return bounded
