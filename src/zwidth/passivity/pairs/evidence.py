"""Proofs and motions about a pair, as documents that the independent checker reads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zwidth.checker import verify
from zwidth.model.pairs import Pair, Side
from zwidth.passivity.certificate import positivity_document
from zwidth.passivity.linear.criterion import frequency
from zwidth.passivity.linear.positivity import Positivity
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import unit_key
from zwidth.passivity.witness.motion import Motion, Repeat
from zwidth.quantity.text import exact_text, quantity_unit, shown

CERTIFICATE = "zwidth certificate 1"
VIOLATION = "zwidth violation 1"
WITNESS = "zwidth witness 1"

_WEIGHTED = (1, 1, 2)
"""How often 2 − 2c is a factor of what the checker looks at."""


_TOLD = (
    "damping",
    "coulomb_friction",
    "resolution",
    "delay",
    "stiffness",
    "virtual_damping",
    "local_damping",
    "link_delay",
)
"""What a document says of a side."""


def pair_document(pair: Pair) -> dict[str, Any]:
    """The loop that a proof or a motion speaks of."""
    sides = zip(("leader", "follower"), pair.sides, strict=True)
    return {
        unit_key("sample_period"): exact_text(pair.sample_period),
        **({"own_readings": pair.own_readings} if pair.own_readings > 1 else {}),
        **{
            name: {
                **_side(side, pair.motion),
                **({} if often == pair.own_readings else {"own_readings": often}),
            }
            for (name, side), often in zip(sides, pair.readings, strict=True)
        },
    }


def _side(side: Side, motion: str) -> dict[str, Any]:
    told: dict[str, Any] = {unit_key(name, motion): exact_text(getattr(side, name)) for name in _TOLD}
    if side.reflection:
        told["reflection"] = exact_text(side.reflection)
    law = side.compensation
    if law:
        numbers = {
            "compensated_coulomb_friction": law.coulomb,
            "compensated_damping": law.viscous,
            "compensation_speed": law.speed,
        }
        told["compensation"] = {
            unit_key(name, motion): exact_text(value.fraction) for name, value in numbers.items()
        }
    return told


@dataclass(frozen=True, repr=False)
class PairCertificate(Evidence):
    """A proof that no motion of two hands takes energy out of a pair.

    `signs` say why M_ll, M_ff and det M are nowhere negative; the rest is as of `PairCriterion`.
    """

    pair: Pair
    signs: tuple[Positivity, Positivity, Positivity]
    tangents: tuple[Fraction, Fraction] = (Fraction(1), Fraction(1))
    any_mean: bool = False
    losses: tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]] | None = None

    def to_dict(self) -> dict[str, Any]:
        """The proof as plain data."""
        names = zip(("leader", "follower", "both"), self.signs, _WEIGHTED, strict=True)
        proof: dict[str, Any] = {
            name: {**positivity_document(sign), "at_one": sign.at_one + more} for name, sign, more in names
        }
        if any(self.pair.compensations):
            arms = zip(("leader", "follower"), self.tangents, strict=True)
            proof["tangents"] = {name: exact_text(r) for name, r in arms}
            if self.any_mean:
                proof["tangents"]["speed"] = "any mean"
        if self.losses is not None:
            keys = [unit_key(name, self.pair.motion) for name in ("damping", "local_damping")]
            both = zip(("leader", "follower"), self.losses, strict=True)
            proof["losses"] = {
                name: {key: exact_text(value) for key, value in zip(keys, least, strict=True)}
                for name, least in both
            }
        return {"format": CERTIFICATE, "kind": "pair", "loop": pair_document(self.pair), "proof": proof}

    def describe(self) -> str:
        """What was proved, in words."""
        return "the work of both hands is nowhere negative"


@dataclass(frozen=True, repr=False)
class PairViolation(Evidence):
    """A frequency, cos ωT, at which some motion of two hands takes energy out in every round.

    None where the drive of an arm lets it gain between two samples, by itself.
    """

    pair: Pair
    cosine: Fraction | None

    @property
    def frequency(self) -> float | None:
        """Where [Hz]."""
        return None if self.cosine is None else frequency(self.cosine, self.pair.sample_period)

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        proof = {} if self.cosine is None else {"proof": {"cosine": exact_text(self.cosine)}}
        return {"format": VIOLATION, "kind": "pair violation", "loop": pair_document(self.pair), **proof}

    def describe(self) -> str:
        """What is violated, in words."""
        if self.frequency is None:
            return "the drive of an arm alone lets it gain, from one reading of its own to the next"
        return f"at {shown(self.frequency, 'Hz', 6)} some motion of both hands gains in every round"


@dataclass(frozen=True, repr=False)
class PairWitness(Evidence):
    """A motion of both hands, from rest at 0 and repeated alike, that takes energy out of the pair.

    `exact_energy` comes out [J]; of the follower's hand `pair.power_ratio` times as much.
    """

    pair: Pair
    leader: Motion
    follower: Motion
    exact_energy: Fraction

    @property
    def energy(self) -> float:
        """What comes out by the whole motion [J]."""
        return float(self.exact_energy)

    @property
    def samples(self) -> int:
        """How long it takes, in readings of one's own."""
        return self.leader.samples

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.samples * self.pair.sample_period / self.pair.own_readings)

    @property
    def positions(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of leader and follower at the samples [m; rad]; each repeated part once."""
        first, second = (np.array([float(v) for v in m.positions]) for m in (self.leader, self.follower))
        return first, second

    @property
    def paths(self) -> dict[str, NDArray[np.float64]]:
        """The same by the name of the arm."""
        return dict(zip(("leader", "follower"), self.positions, strict=True))

    @property
    def repeats(self) -> tuple[Repeat, ...]:
        """What both hands do more than once."""
        return tuple(part for part in self.leader.repeats if part.times > 1)

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        return motion_document(self.pair, self.leader, self.follower, self.exact_energy)

    def describe(self) -> str:
        """What comes out, in words."""
        far = quantity_unit("position", self.pair.motion)
        spans = [float(max(m.positions) - min(m.positions)) for m in (self.leader, self.follower)]
        rounds = f", {self.leader.rounds} rounds" if self.leader.rounds > 1 else ""
        leader, follower = (shown(span, far, 3) for span in spans)
        return (
            f"a motion of {self.samples} samples{rounds} takes {shown(self.energy, 'J')} out, the "
            f"leader over {leader}, the follower over {follower} in a round"
        )


def motion_document(pair: Pair, leader: Motion, follower: Motion, energy: Fraction) -> dict[str, Any]:
    """A motion of both hands as a document for the checker."""
    suffix = unit_key("position", pair.motion).removeprefix("position_")
    document: dict[str, Any] = {
        "format": WITNESS,
        "kind": "pair motion",
        "loop": pair_document(pair),
        unit_key("sample_period"): pair.sample_period,
        "energy_J": energy,
        "repeats": [part._asdict() for part in leader.repeats if part.times > 1],
    }
    for name, path in (("leader", leader), ("follower", follower)):
        document[f"{name}_positions_{suffix}"] = list(path.positions)
        if path.switch_positions:
            document[f"{name}_switch_positions_{suffix}"] = list(path.switch_positions)
    return document


def energy_of(pair: Pair, leader: Motion, follower: Motion) -> Fraction | None:
    """What comes out by the checker's reckoning [J]; None if the motion is not admitted."""
    return verify(motion_document(pair, leader, follower, Fraction(0))).energy


MOST, LEAST = 48, 6
"""Beginnings of each part."""

_EFFORT = 300_000
"""Samples listed in all the beginnings together."""


def energy_in_time(witness: PairWitness) -> tuple[list[Fraction], list[Fraction]]:
    """Times [s] from 0 to the end, and what has come out by then [J], by the checker's reckoning."""
    pair, step = witness.pair, witness.pair.sample_period / witness.pair.own_readings
    most = max(LEAST, min(MOST, _EFFORT // len(witness.leader.positions)))
    times, energies = [Fraction(0)], [Fraction(0)]
    for last, rounds in _ends(witness.leader, most):
        leader, follower = (_until(motion, last, rounds) for motion in (witness.leader, witness.follower))
        energy = energy_of(pair, leader, follower)
        if energy is not None:
            times.append(leader.samples * step)
            energies.append(energy)
    return times, energies


def _ends(motion: Motion, most: int) -> Iterator[tuple[int, int]]:
    """Samples of the list at which a beginning ends, and how often the part that ends there was done."""
    size, before = len(motion.positions) - 1, 0
    for part in (*(p for p in motion.repeats if p.times > 1), Repeat(size, size, 0)):
        yield from ((k, 1) for k in _some(before + 1, part.first, most))
        yield from ((part.last, n) for n in _some(1, part.times, most))
        before = part.last


def _some(first: int, last: int, most: int) -> list[int]:
    """Whole numbers from the first to the last, at about equal distances."""
    count = min(most, last - first + 1)
    return [] if count < 1 else sorted({round(v) for v in np.linspace(first, last, count).tolist()} | {last})


def _until(motion: Motion, last: int, rounds: int) -> Motion:
    """Its beginning; of the part that ends there so many rounds."""
    parts = [part for part in motion.repeats if part.last <= last]
    return replace(
        motion,
        positions=motion.positions[: last + 1],
        switch_positions=motion.switch_positions[:last],
        repeats=tuple(part._replace(times=rounds) if part.last == last else part for part in parts),
    )
