"""What a motion has taken out by and by, against sums of all that is listed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

import zwidth as zw
from zwidth.passivity.pairs.evidence import MOST, energy_in_time, energy_of

ARM = zw.Device(damping="0.5", coulomb_friction="0.1", resolution="1e-4", delay=0, rate="1 kHz")
LATE = ARM.replace(delay="0.4 ms", resolution=0)
SLOW = zw.Pair(ARM, ARM, stiffness=300, delay="4 ms")


@pytest.mark.parametrize(
    "pair",
    [
        SLOW,
        zw.Pair(LATE, ARM, stiffness=300, delay="2 ms"),
        zw.Pair(ARM, ARM, stiffness=90, damping="0.3", delay="2 ms"),
        zw.Pair(ARM.replace(coulomb_friction="0.004"), ARM, stiffness=50, delay="2 ms"),
        zw.Pair(ARM, ARM, stiffness=300, local_damping="0.6", delay="1 ms", drive_rate="3 kHz"),
    ],
)
def test_every_beginning_is_a_motion_of_its_own(pair):
    """Without any repeated part, sample by sample; to the end, where it is the energy of the whole."""
    witness = zw.check(pair).witness
    times, energies = energy_in_time(witness)
    listed = [motion.listed() for motion in (witness.leader, witness.follower)]
    step = pair.sample_period / pair.own_readings
    assert len(times) > 3
    assert times[-1] == witness.samples * step
    assert energies[-1] == witness.exact_energy
    for time, energy in list(zip(times, energies, strict=True))[1:]:
        last = int(time / step)
        parts = [
            replace(m, positions=m.positions[: last + 1], switch_positions=m.switch_positions[:last])
            for m in listed
        ]
        assert energy_of(pair, *parts) == energy


def test_of_many_rounds_some_are_told():
    """The first and the last, and others between them, as many as are seen."""
    witness = zw.check(SLOW).witness
    many = replace(witness, leader=witness.leader.repeated(10**6), follower=witness.follower.repeated(10**6))
    times, energies = energy_in_time(many)
    assert len(times) == len(energies) == 1 + 2 * (1 + MOST)
    assert times == sorted(set(times))
    assert times[-1] == Fraction(2 + 2 * 10**6, 1000)
