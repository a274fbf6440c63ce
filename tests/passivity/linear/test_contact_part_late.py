"""Damped walls touched and left, part of a sample late: proved at the bound, and no hand gets energy out."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import sqrt
from random import Random

import pytest
from plain_loop import best_switch

import zwidth as zw
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.check import check_by_closed_forms

T = Fraction(1, 1000)
ESTIMATES = {
    "backward difference": (zw.rendering.BackwardDifference(), [1.0], 2),
    "window": (zw.rendering.Window(4), [0.25] * 4, Fraction(1, 2)),
    "finite response": (zw.rendering.VelocityFilter([3, -1], [2, 0, 0]), [0.0, 1.5, -0.5], 4),
}
"""An estimate of velocity, its weights w_j and T ‖h_v‖₁ by hand."""
DELAYS = [Fraction(1, 2), Fraction(1, 10), Fraction("1.4"), Fraction("2.75")]


def need(k, b, name, late):
    """½ (Q + √(Q² + α(1 − α) S²)), Q = (2d + 1 + 2α) K T/2 + |B| Σ|w|, S = K T + 2 |B| Σ|w|."""
    asked, alpha = abs(b) * sum(map(abs, ESTIMATES[name][1])), float(late % 1)
    linear = float(2 * late + 1) * k * float(T) / 2 + asked
    return (linear + sqrt(linear**2 + alpha * (1 - alpha) * (k * float(T) + 2 * asked) ** 2)) / 2


def wall(seed, name):
    """K, B, the encoder's step and the Coulomb friction that pays for it."""
    random = Random(f"{seed} {name}")
    k, b = random.uniform(10, 900), random.choice([-1, 1]) * random.uniform(0.01, 1)
    step = random.choice([0, 2e-4])
    return k, b, step, (k + abs(b) * float(ESTIMATES[name][2] / T)) * step / 2 * (1 + 1e-12)


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("late", DELAYS)
@pytest.mark.parametrize("name", ESTIMATES)
def test_proved_from_the_bound_on(name, late, clamped):
    """A billionth above the root the checker accepts contact made and broken; a billionth below, nothing."""
    k, b, step, friction = wall(late, name)
    law = zw.Wall(k, b, ESTIMATES[name][0], clamped=clamped)
    for share, proved in ((1 + 1e-9, True), (1 - 1e-9, False)):
        device = zw.Device(
            damping=need(k, b, name, late) * share,
            coulomb_friction=friction,
            resolution=step,
            sample_period=T,
            delay=late * T,
        )
        verdict = check_by_closed_forms(device, law)
        assert (verdict.outcome == "passive") is proved
        if proved:
            assert verdict.certificate.kind == "contact"
            assert verify_document(verdict.certificate.to_dict()).valid


def forces(x, k, b, weights, step, surface):
    """f(k) of a wall that acts inside only, or never pulls, or whatever |r| ≤ |B v| allows; in floats."""
    out = []
    random = Random(len(x))
    read = [x[0]] * len(weights) + [step * (v // step) if step else v for v in x]
    for place in range(len(weights), len(read)):
        moves = [read[place - j] - read[place - j - 1] for j in range(len(weights))]
        damper = b * sum(w * move for w, move in zip(weights, moves, strict=True)) / float(T)
        q = read[place]
        if surface == "anything allowed":
            out.append(k * max(q, 0) + damper * random.choice([-1, 0, 1]))
        else:
            force = k * q + damper if q > 0 else 0.0
            out.append(max(force, 0.0) if surface == "clamped" else force)
    return out


def motion(random, samples=60):
    """From rest outside: in and out in a rhythm, with some chance, and out again."""
    size = random.choice([1e-3, 3e-2, 1.0])
    centre, rhythm = random.uniform(-1, 1) * size, random.choice([[1, -1], [1, 1, -1, -1], [1, 0, -1]])
    inside = [
        centre + size * rhythm[n % len(rhythm)] * random.uniform(0.7, 1) + random.gauss(0, size / 9)
        for n in range(samples)
    ]
    return [-2 * size] * 3 + inside + [-2 * size] * 9


def got(seed, surface, share):
    """What a hand gets out along a motion at `share` of the damping of the theorem, and its largest work."""
    random = Random(f"{seed} {surface}")
    name, late = random.choice(list(ESTIMATES)), random.choice(DELAYS)
    k, b, step, friction = wall(seed, name)
    damping, part, whole = need(k, b, name, late) * share, float(late % 1), int(late)
    x = motion(random)
    f = forces(x, k, b, ESTIMATES[name][1], step, surface)
    device = {"damping": damping, "friction": friction, "period": float(T)}
    early = [0.0] * (whole + 1) + f
    switches = [
        best_switch(here, there, early[n], early[n + 1], part=part, **device)
        for n, (here, there) in enumerate(pairwise(x))
    ]
    return work_out(early, x, switches, part, **device)


def work_out(early, x, switches, part, *, damping, friction, period):
    """Energy that the hand takes out, and the largest work among the moves."""
    total, most = 0.0, 0.0
    for n, (here, there) in enumerate(pairwise(x)):
        for force, step, share in (
            (early[n], switches[n] - here, part),
            (early[n + 1], there - switches[n], 1 - part),
        ):
            work = force * step + friction * abs(step) + damping * step * step / (share * period)
            total, most = total - work, max(most, abs(work))
    return total, most


@pytest.mark.parametrize("surface", ["masked", "clamped", "anything allowed"])
def test_no_hand_gets_energy_out_at_the_bound(surface):
    for seed in range(60):
        energy, most = got(seed, surface, 1.0)
        assert energy <= 1e-12 * most


@pytest.mark.parametrize("surface", ["masked", "clamped", "anything allowed"])
def test_the_same_hands_are_not_blind(surface):
    """With a third of the damping some of them do."""
    assert max(energy - 1e-9 * most for energy, most in (got(seed, surface, 0.33) for seed in range(60))) > 0
