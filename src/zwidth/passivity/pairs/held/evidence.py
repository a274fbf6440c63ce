"""Proofs and motions about a pair of which a known hand holds one arm, as documents for the checker.

They hold the pair, and arm and hand together; the checker forms the law that is felt by itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import acos, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.checker import verify
from zwidth.loop.sampled_plant import Motion
from zwidth.model.pairs import Pair
from zwidth.passivity.linear.criterion import frequency, tightest
from zwidth.passivity.pairs.evidence import CERTIFICATE, VIOLATION, WITNESS, pair_document
from zwidth.passivity.pairs.held.law import HeldPair, felt_loop
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import unit_key
from zwidth.passivity.witness.motion import Repeat, forces_of
from zwidth.quantity.text import exact_text, shown, told_quantity


@dataclass(frozen=True, repr=False)
class HeldCertificate(Evidence):
    """A proof that the hand on the free arm takes no energy out, for every hand within the intervals."""

    question: HeldPair

    def to_dict(self) -> dict[str, Any]:
        """The proof as plain data."""
        return {
            "format": CERTIFICATE,
            "kind": "held pair",
            **held_document(self.question, self.question.motion),
        }

    def describe(self) -> str:
        """What was proved, in words."""
        return f"with the {self.question.held} held, the work of the other hand is nowhere negative"


@dataclass(frozen=True, repr=False)
class HeldViolation(Evidence):
    """A frequency, cos ωT, at which some motion of the free arm takes energy out in every round.

    `motion` is arm and hand together, certain: one of those within the intervals.
    """

    question: HeldPair
    motion: Motion
    cosine: Fraction

    @property
    def frequency(self) -> float:
        """Where [Hz]."""
        return frequency(self.cosine, self.question.pair.sample_period)

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        return {
            "format": VIOLATION,
            "kind": "held pair violation",
            **held_document(self.question, self.motion),
            "proof": {"cosine": exact_text(self.cosine)},
        }

    def describe(self) -> str:
        """What is violated, in words."""
        at = shown(self.frequency, "Hz")
        return f"at {at} some motion of the {self.question.free} gains in every round"


def held_document(question: HeldPair, motion: Motion) -> dict[str, Any]:
    """The pair, and arm and hand together."""
    return {
        "loop": pair_document(question.pair),
        "held": {"arm": question.held, **motion.told(question.pair.motion)},
    }


# A wave that swells and dies away:
#
#     x(k) = X sin²(πk/n) sin θk
#
# At the frequency where the criterion is most violated; the longer it is the less its beginning and end cost.
# It is found with the law that is felt, in doubles; what counts is what the independent checker finds.


Floats = NDArray[np.float64]

_LENGTHS = (100, 300, 1000, 3000)
"""Samples of a wave, one after the other."""

_SIZE = 0.01
"""X [m; rad], where Coulomb friction asks for no more."""

_GRAIN = 1 << 40
"""Positions are whole parts of X."""


@dataclass(frozen=True, repr=False)
class HeldWitness(Evidence):
    """A motion of the free arm, from rest at 0, that takes energy out.

    Attributes
    ----------
    violation
        The pair, the hand, and the frequency.
    path
        Positions at the samples [m; rad], straight between them.
    exact_energy
        What comes out at least [J].
    """

    violation: HeldViolation
    path: tuple[Fraction, ...]
    exact_energy: Fraction = Fraction(0)

    @property
    def pair(self) -> Pair:
        """The two arms."""
        return self.violation.question.pair

    @property
    def energy(self) -> float:
        """What comes out by the whole motion, at least [J]."""
        return float(self.exact_energy)

    @property
    def positions(self) -> Floats:
        """Of the free arm at the samples [m; rad]."""
        return np.array([float(x) for x in self.path])

    @property
    def paths(self) -> dict[str, Floats]:
        """The same by the name of the arm."""
        return {self.violation.question.free: self.positions}

    @property
    def repeats(self) -> tuple[Repeat, ...]:
        """Nothing is done more than once."""
        return ()

    @property
    def samples(self) -> int:
        """How long it takes, in samples."""
        return len(self.path) - 1

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.samples * self.pair.sample_period)

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        pair = self.pair
        return {
            "format": WITNESS,
            "kind": "held pair motion",
            **held_document(self.violation.question, self.violation.motion),
            unit_key("sample_period"): pair.sample_period,
            "energy_J": self.exact_energy,
            unit_key("position", pair.motion).replace("position", "positions"): list(self.path),
        }

    def describe(self) -> str:
        """What comes out, in words."""
        question = self.violation.question
        far = told_quantity(float(np.ptp(self.positions)), "position", question.pair.motion, 3)
        return (
            f"a wave of {self.samples} samples takes {shown(self.energy, 'J')} out, the "
            f"{question.free} over {far}"
        )


def gaining_wave(violation: HeldViolation) -> HeldWitness | None:
    """A wave that the checker finds to gain; None if none is short, or friction or steps are in its way."""
    question = violation.question
    free, held = (arm.side for arm in question.arms)
    if held.coulomb_friction or held.resolution or free.resolution:
        return None
    law, _ = felt_loop(question, violation.motion)
    theta = acos(max(-1.0, min(1.0, float(tightest(law)[1]))))
    for samples in _LENGTHS:
        path = _wave(samples, max(theta, 8 * pi / samples))
        gained, rubbed = _gained(violation, path)
        if gained <= 0:
            continue
        least = 2 * float(free.coulomb_friction) * rubbed / gained
        size = Fraction(max(_SIZE, least)).limit_denominator(10**6)
        exact = tuple(size * round(x * _GRAIN) / _GRAIN for x in path.tolist())
        tried = HeldWitness(violation, exact)
        energy = verify(tried.to_dict()).energy
        if energy is not None and energy > 0:
            return HeldWitness(violation, exact, energy)
    return None


def _wave(samples: int, theta: float) -> Floats:
    k = np.arange(samples + 1)
    path = np.sin(pi * k / samples) ** 2 * np.sin(theta * k)
    path[0] = path[-1] = 0
    return np.asarray(path)


def _gained(violation: HeldViolation, path: Floats) -> tuple[float, float]:
    """What it takes out, Coulomb friction aside [J/m²; J/rad²], and how far it goes."""
    question = violation.question
    arm, period = question.arms[0], float(question.pair.sample_period)
    law, _ = felt_loop(question, violation.motion)
    forces, steps, part = forces_of(law, path.tolist()), np.diff(path), float(arm.part)
    late, later = (np.concatenate([np.zeros(n), forces])[: len(steps)] for n in (arm.whole, arm.whole + 1))
    work = ((1 - part) * late + part * later) @ steps + float(arm.damping) / period * (steps @ steps)
    return -float(work), float(np.abs(steps).sum())
