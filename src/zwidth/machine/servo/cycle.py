"""One sample of a served loop: from what a device answered to the force that it is given.

    x  = sense (reading − origin)
    f  = law(x)                         what the simulator computes, to the last bit
    f  = f_0 ± S T,  |f| ≤ F            where the safety cuts it

Beside it runs the ledger, as the encoder sees it: the energy that the actuator gave to the handle, and what
the device's friction took at least,

    W_a = −Σ f_k (x_{k+1} − x_k),   E ≥ Σ b (x_{k+1} − x_k)²/(t_{k+1} − t_k) + f_c |x_{k+1} − x_k|

since (∫v)² ≤ t ∫v².  So the hand has put in E − W_a at least, but for the device's kinetic energy and the
encoder's steps.

A law begins, and takes the place of another, only where both forces are near 0, and at rest there, as if the
hand had been at this position for ever.  The force does not jump.  What the old law had stored is lost.  The
new one begins with what it holds at rest there, F²/(2K) of a spring at most, with F the force up to which a
law may begin; so much a change can give to the hand, each time.  A spring with several zeros, such as a
detent at whose top the force is 0 as well, begins around its lowest rest alone.
"""

from __future__ import annotations

from math import isfinite, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.errors import InputError
from zwidth.loop.kernel import commanded
from zwidth.loop.law import CHAIN, REMEMBERED
from zwidth.loop.setup import prepare, resting_lines
from zwidth.loop.start import unloaded_range
from zwidth.machine.servo.connection import GOOD, MOST_TOLD, READING, TOLD
from zwidth.machine.servo.ring import (
    AT,
    ENDED,
    ENERGY_OUT,
    EXCHANGE,
    FORCE_LIMITED,
    FRICTION_LOSS,
    GIVEN,
    LATE,
    LAW,
    LIMITED,
    MEASURING,
    PHASE,
    POSITION,
    SAMPLE,
    SERVING,
    SLEW_LIMITED,
    STATUS,
    TELLS,
    WAITING,
    WISHED,
    count,
)
from zwidth.machine.servo.safety import (
    HOST_GONE,
    NO_FORCE,
    RUNNING,
    bad_in_a_row,
    judged_answer,
    judged_gap,
    judged_reading,
)
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import PrescribedMotion
from zwidth.native.compiled import Array, compiled

Words = NDArray[np.int64]

# Between the loop and the program around it: whole numbers.
STOP, HEARTBEAT, WANTED, SERVED, ROWS, REASON, MISSED, CHANGES, HELD, CUT, LATER = range(11)
CONTROL = 11
NONE = -1
"""In WANTED and SERVED: no law."""

# What does not change, and after it what the loop remembers of the sample before.
(
    PERIOD, SENSE, ORIGIN, FORCE_MOST, CHANGE_MOST, NEAR, JUMP_MOST, BAD_MOST, GAP_MOST, HOST_MOST,
    DAMPING, COULOMB, SETTLED, LATE_MOST, EXCHANGE_MOST, AWAKE_MOST,
    BEGINS,
) = range(17)  # fmt: skip
# from BEGINS on, for each of the two laws, between which positions it may begin
X, FORCE_BEFORE, T_BEFORE, K_BEFORE, SEEN, BAD, QUIET, WORK, LOSS, WISH, LEAST = range(20, 31)
NUMBERS = 31


@compiled
def answer(
    status: int,
    k: int,
    t: float,
    beaten: int,
    memory: Array,
    laws: Array,
    memories: Array,
    rests: Array,
    control: Words,
    n: Array,
    counts: Array,
    row: Array,
) -> float:
    """The force of sample k, positive out of the wall; the row of the sample but for its times.

    Parameters ---------- status What became of the question for the position. t, beaten Time of the sample
    [s]; the clock, to compare with the heartbeat of the program around [ns]. memory Of the connection: the
    reading, and what it tells. laws, memories, rests Two places for a packed law, what it remembers, and what
    it does at rest, see `loop.setup.resting_lines`: one is served, the other may be waiting. control, n See
    above; both are changed. counts Where the law counts its samples, a state of `loop.plant`.
    """
    x, wish, limited = n[X], 0.0, 0.0
    f = n[FORCE_BEFORE]
    law = control[SERVED]
    if control[REASON] == RUNNING:
        _look_around(control, n, t, beaten)
        n[BAD] = bad_in_a_row(status, n[BAD])
    if control[REASON] == RUNNING:
        control[REASON] = judged_answer(status, n[BAD], n[BAD_MOST])
    if control[REASON] == RUNNING and status == GOOD:
        x = n[SENSE] * (memory[READING] - n[ORIGIN])
        before = n[X] if n[SEEN] > 0.0 else nan
        control[REASON] = judged_reading(x, before, n[JUMP_MOST] * (k - n[K_BEFORE]))
    if control[REASON] != RUNNING:
        f = 0.0
    elif status == GOOD:
        _measure_energy(x, t, n)
        law = _change_law(x, laws, memories, rests, control, n, counts)
        if law != NONE:
            wish = commanded(counts, laws[law, :], memories[law, :], x)
        if isfinite(wish):
            f, limited = _cut(wish, n)
        else:
            control[REASON] = NO_FORCE
            f = 0.0
        if law != NONE and laws[law, CHAIN] > 0.0:
            memories[law, int(laws[law, REMEMBERED])] = f
        n[X], n[T_BEFORE], n[K_BEFORE], n[SEEN] = x, t, k, 1.0
    else:
        control[HELD] += 1
        wish = n[WISH]
    n[QUIET] = n[QUIET] + 1.0 if abs(f) <= n[NEAR] else 0.0
    n[FORCE_BEFORE], n[WISH] = f, wish
    if limited > 0.0:
        control[CUT] += 1
    row[SAMPLE], row[AT] = k, t
    row[POSITION], row[WISHED], row[GIVEN] = x, wish, f
    row[ENERGY_OUT], row[FRICTION_LOSS] = n[WORK], n[LOSS]
    row[STATUS], row[LAW], row[LIMITED] = status, control[CHANGES] - 1, limited
    row[PHASE] = _phase(control)
    row[TELLS : TELLS + MOST_TOLD] = memory[TOLD : TOLD + MOST_TOLD]
    return f


@compiled
def noted(row: Array, late: float, exchange: float, control: Words, n: Array, spread: Words) -> None:
    """Finish the row and count it, and whether it was later than the verdict supposes."""
    row[LATE], row[EXCHANGE] = late, exchange
    if control[REASON] == RUNNING:
        count(spread, late * 1e9)
        if late > n[LATE_MOST] or exchange > n[EXCHANGE_MOST]:
            control[LATER] += 1
    control[ROWS] += 1


@compiled
def _look_around(control: Words, n: Array, t: float, beaten: int) -> None:
    """Has somebody asked to end; do the loop and the program around it run?"""
    if control[STOP] != 0:
        control[REASON] = control[STOP]
    elif n[SEEN] > 0.0 and control[SERVED] != NONE:
        control[REASON] = judged_gap(t - n[T_BEFORE], n[GAP_MOST])
    if control[REASON] == RUNNING and (beaten - control[HEARTBEAT]) * 1e-9 > n[HOST_MOST]:
        control[REASON] = HOST_GONE


@compiled
def _measure_energy(x: float, t: float, n: Array) -> None:
    """The ledger up to this sample."""
    if n[SEEN] > 0.0:
        moved, took = x - n[X], t - n[T_BEFORE]
        n[WORK] -= n[FORCE_BEFORE] * moved
        n[LOSS] += n[DAMPING] * moved * moved / took + n[COULOMB] * abs(moved)
        n[LEAST] = min(n[LEAST], n[LOSS] - n[WORK])


@compiled
def _change_law(
    x: float, laws: Array, memories: Array, rests: Array, control: Words, n: Array, counts: Array
) -> int:
    """The law that is served at this sample: another one, if it is wanted and may begin."""
    wanted, served = control[WANTED], control[SERVED]
    if wanted in (NONE, served):
        return served
    if served != NONE and n[QUIET] < n[SETTLED]:
        return served
    put_at_rest(memories[wanted, :], rests[wanted, :, :, :], x)
    begins = commanded(counts, laws[wanted, :], memories[wanted, :], x)
    low, high = n[BEGINS + 2 * wanted], n[BEGINS + 2 * wanted + 1]
    if abs(begins) > n[NEAR] or x < low or x > high:
        return served
    put_at_rest(memories[wanted, :], rests[wanted, :, :, :], x)
    control[SERVED] = wanted
    control[CHANGES] += 1
    return wanted


@compiled
def put_at_rest(memory: Array, lines: Array, x: float) -> None:
    """As if the hand had been at x for ever: one line outside, another inside."""
    side = 1 if x > 0.0 else 0
    for i in range(memory.shape[0]):
        memory[i] = lines[side, 0, i] + lines[side, 1, i] * x


@compiled
def _cut(wish: float, n: Array) -> tuple[float, float]:
    """The force within what it may change, then within its limit; and which of them cut it."""
    f, limited = wish, 0.0
    change = f - n[FORCE_BEFORE]
    if abs(change) > n[CHANGE_MOST]:
        f = n[FORCE_BEFORE] + (n[CHANGE_MOST] if change > 0.0 else -n[CHANGE_MOST])
        limited += SLEW_LIMITED
    if abs(f) > n[FORCE_MOST]:
        f = n[FORCE_MOST] if f > 0.0 else -n[FORCE_MOST]
        limited += FORCE_LIMITED
    return f, limited


@compiled
def _phase(control: Words) -> float:
    if control[REASON] != RUNNING:
        return ENDED
    if control[SERVED] != NONE:
        return SERVING
    return MEASURING if control[WANTED] == NONE else WAITING


class Packed(NamedTuple):
    """A law for `cycle.answer`."""

    law: Array
    rest: Array
    """What it remembers at rest, see `loop.setup.resting_lines`; 2 × 2 × n."""
    begins: tuple[float, float]
    """Between which positions it holds little where it pushes little, see `loop.start.unloaded_range`."""


def pack(
    device: Device, environment: Environment, here: float, force: float, *, single: bool = False
) -> Packed:
    """Lay out a law for the encoder, the converter and the period of a device; its mass is not needed.

    `here` is the reading now [m; rad], `force` up to which it may begin [N; N·m]; `single` where the machine
    keeps numbers in 24 bits.
    """
    begins = unloaded_range(environment, force, here)
    if begins[0] > begins[1]:
        raise InputError(
            "this law pulls away at one of its ends and is at rest nowhere: a hand would be given all it "
            "holds where it begins; let it push back at both ends"
        )
    still = PrescribedMotion([0.0, 0.0])
    setup = prepare(device, environment, still, device.exact("sample_period"), single=single)
    return Packed(setup.law, resting_lines(setup), begins)
