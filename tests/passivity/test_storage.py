"""Soundness by another road: hands that learn to extract energy find none in a wall proved passive.

Greedy searches over motions, simulated plainly: from rest outside a spring wall
they never bring out a joule; a little below the limit they do.
"""

from __future__ import annotations

from itertools import pairwise
from math import floor, sqrt
from random import Random

import plain_loop
import pytest

import zwidth as zw

K, T = 300.0, 1e-3


class Hand:
    """A wall and a motion in it that is changed step by step for more energy."""

    def __init__(self, random, whole, part, damping, friction, resolution, force=None):
        self.random, self.whole, self.part = random, whole, part
        self.damping, self.friction, self.resolution = damping, friction, resolution
        self.force = force or (lambda x: K * max(x, 0.0))

    def energy(self, x):
        """Energy out at the end, each instant inside a sample chosen as well as can be."""
        resolution = self.resolution
        f = [self.force(resolution * floor(v / resolution) if resolution else v) for v in x]
        total = 0.0
        for k, (here, there) in enumerate(pairwise(x)):
            early = f[k - self.whole - 1] if k > self.whole else 0.0
            late = f[k - self.whole] if k >= self.whole else 0.0
            viscous = {"damping": self.damping, "friction": self.friction, "period": T}
            y = here
            if self.part:
                y = plain_loop.best_switch(here, there, early, late, part=self.part, **viscous)
            for force, step, share in ((early, y - here, self.part), (late, there - y, 1 - self.part)):
                if share:
                    drag = self.friction * abs(step) + self.damping / T * step * step / share
                    total -= force * step + drag
        return total

    def changed(self, x, size):
        i, other, chance = self.random.randrange(1, len(x)), list(x), self.random.random()
        if chance < 0.1:
            stretch = self.random.uniform(0.5, 1.5)
            return [v * stretch for v in x]
        if chance < 0.2 and self.resolution:
            edge = self.resolution * round(x[i] / self.resolution)
            other[i] = edge - self.random.choice([0.0, 1e-9])
        else:
            other[i] += self.random.gauss(0, size)
        return other

    def score(self, x):
        """Energy out over K Σ Δx²: it does not reward a hand for doing nothing."""
        return self.energy(x) / (K * sum((b - a) ** 2 for a, b in pairwise(x)) + 1e-40)

    def best(self, samples, tries):
        swing = self.random.choice([1, -1])  # to and fro every sample is where a spring gains most
        x = [0.0] + [6e-3 + 2e-3 * swing ** (k % 2) + self.random.gauss(0, 1e-3) for k in range(samples)]
        most, size = self.score(x), 2e-3
        for turn in range(tries):
            size = 2e-3 if turn % 200 == 0 else size * 0.98
            other = self.changed(x, size)
            found = self.score(other)
            if found >= most:
                x, most = other, found
        return most


def limit(whole, part):
    """b* = (KT/4)[2d + 1 + 2α + √((2d+1)² + 8α(d+1))]."""
    return K * T / 4 * (2 * whole + 1 + 2 * part + sqrt((2 * whole + 1) ** 2 + 8 * part * (whole + 1)))


def piecewise(random):
    places = sorted(random.uniform(0, 5e-3) for _ in range(3))
    slopes = [random.choice([0.0, K]) for _ in range(4)]

    def force(x):
        total, before = 0.0, 0.0
        for place, slope in zip([*places, float("inf")], slopes, strict=True):
            total += slope * max(min(x, place) - before, 0.0)
            before = place
        return total

    return force


CASES = [(d, a, r) for d in (0, 1, 2) for a in (0.0, 0.2, 0.5, 0.9) for r in (0.0, 1e-3)]


@pytest.mark.parametrize(("whole", "part", "resolution"), CASES)
def test_no_hand_extracts_energy_at_the_limit(whole, part, resolution):
    """At b* and f_c = KΔ/2 zwidth proves the wall, and no motion found extracts energy from rest outside."""
    damping, friction = limit(whole, part) * (1 + 1e-12), K * resolution / 2
    delay = (whole + part) * T
    device = zw.Device(
        damping=damping, coulomb_friction=friction, resolution=resolution, sample_period=T, delay=delay
    )
    assert zw.check(device, zw.Wall(K)).outcome == "passive"
    random = Random(repr((whole, part, resolution)))
    for law in (None, piecewise(random)):
        hand = Hand(random, whole, part, damping, friction, resolution, law)
        assert hand.best(random.randint(3, 16), 1500) <= 1e-12


@pytest.mark.parametrize(("whole", "part"), [(0, 0.0), (0, 0.5), (1, 0.0), (1, 0.3)])
def test_the_same_hand_extracts_energy_below_the_limit(whole, part):
    """The search is not blind: with a little less damping it finds energy, and zwidth says active."""
    damping = limit(whole, part) * 0.7
    device = zw.Device(damping=damping, sample_period=T, delay=(whole + part) * T)
    assert zw.check(device, zw.Wall(K)).outcome == "active"
    random = Random(whole)
    hand = Hand(random, whole, part, damping, 0.0, 0.0)
    assert max(hand.best(24, 1500) for _ in range(3)) > 1e-3


def test_the_same_hand_straddles_an_edge():
    """With Coulomb friction below KΔ/2 the search finds the tiny step over an edge; zwidth says active."""
    step, friction = 1e-3, 0.3 * K * 1e-3
    device = zw.Device(damping=0.16, coulomb_friction=friction, resolution=step, sample_period=T)
    assert zw.check(device, zw.Wall(K)).outcome == "active"
    hand = Hand(Random(5), 0, 0.0, 0.16, friction, step)
    lead = [0.0, step - 1e-9]
    rounds = [step + 2e-4, step - 1e-9] * 100
    assert hand.energy(lead + rounds) > 0


@pytest.mark.parametrize("seed", range(5))
def test_random_hands_in_a_filtered_wall(seed):
    """A damped, filtered wall proved with its encoder: in contact, no motion brings out more than KΔ²/8."""
    random = Random(seed)
    k, b, step = random.uniform(50, 200), random.uniform(0.005, 0.05), 1e-4
    device = zw.Device(
        damping="0.4", coulomb_friction="0.05", resolution=step, sample_period=T, delay="0.0004"
    )
    law = zw.Wall(k, b, zw.rendering.OnePole("0.003"))
    assert zw.check(device, law, contact="kept").outcome == "passive"
    num, den = ([float(c) for c in part] for part in law.pulse_transfer_function(zw.Exact(T).fraction))
    loop = {"damping": 0.4, "friction": 0.05, "period": T, "resolution": step, "part": 0.4}
    for _ in range(150):
        x = [0.0]
        size = random.choice([2e-5, 1e-4, 1e-3])
        for _ in range(random.randint(3, 60)):
            x.append(x[-1] + random.choice([random.gauss(0, size), 0.0, step * random.randint(-1, 1)]))
        f = plain_loop.forces(num, den, x, step)
        y = [
            plain_loop.best_switch(a, c, early, late, damping=0.4, friction=0.05, period=T, part=0.4)
            for a, c, early, late in zip(x, x[1:], [0.0, *f], f, strict=False)
        ]
        assert plain_loop.energy_out((num, den), x, switches=y, **loop) <= k * step**2 / 8 + 1e-15
