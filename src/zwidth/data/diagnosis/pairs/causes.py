"""Why two arms may shake: each reason with what happens, and how likely it is.

The energy of a cycle comes apart into terms W_i (`energy`), and

    p_i = W_i^γ / Σ_j W_j^γ        over what they give beyond what pays for them

with γ fitted to simulated pairs that shake for one reason (`benchmarks/diagnosis_pairs.py`).  Viscous
friction and terms that take pay for what grows with the square of the motion, Coulomb friction pays for its
compensation, as far as the devices are known; p is the mean over what an owner may be wrong by.  Where
nothing is left over, something that is not in the file feeds the motion, and nothing is named.
"""

from __future__ import annotations

from collections.abc import Mapping

from zwidth.data.diagnosis.causes import SURE
from zwidth.data.diagnosis.pairs.energy import PairEvidence

PAIR_CAUSES: Mapping[str, str] = {
    "link delay": "each arm is pulled to where the other one was when its reading was sent",
    "sampling": "the spring is held from sample to sample and so pushes out harder than it was pressed in",
    "delay": "the forces come late after the arms' own readings",
    "damping": "damping against the other arm's speed comes so late that it drives the motion",
    "local damping": "damping of each arm's own speed comes so late, or has such a sign, that it drives",
    "friction compensation": "more friction is compensated than there is: the compensation drives the motion",
    "actuator limit": "a motor cannot follow: its force comes late because it changes no faster",
}
"""The terms of `energy`, in words."""

STEEPNESS = 6.1
"""γ."""

STATED = (0.85, 1.0, 1.15)
"""What friction takes, over what the stated numbers say: owners may be wrong by so much."""

MOST_UNEXPLAINED = 0.01
"""Share of a force's variance that its law may leave over."""

_DRY = "friction compensation"


def likelihoods(seen: PairEvidence) -> dict[str, float]:
    """p of each cause, the mean over what friction may take; empty where no term ever gives more."""
    mean = dict.fromkeys(PAIR_CAUSES, 0.0)
    for viscous in STATED:
        for dry in STATED:
            gives = _beyond(seen, viscous, dry)
            most = max(gives.values())
            if most > 0:
                odds = {name: (max(0.0, work) / most) ** STEEPNESS for name, work in gives.items()}
                for name, p in odds.items():
                    mean[name] += p / sum(odds.values()) / len(STATED) ** 2
    return mean if any(mean.values()) else {}


MOST_BEHIND = 0.1
"""Share of a motor's force that a delay or a limit of rate behind its command may leave over."""


def is_named(cause: str, p: float, seen: PairEvidence) -> bool:
    """Whether a cause is likely enough and the file shows it.  Where a motor cannot follow, how much that
    gives depends on how far the arms swing: what else gives more at this swing is not named then.
    """
    limited = any(rate is not None for rate in seen.rates)
    alone = not limited or cause == "actuator limit"
    return p >= SURE and alone and seen.behind < MOST_BEHIND and followed(seen)


def followed(seen: PairEvidence) -> bool:
    """Whether both forces are known as laws of both arms, and nothing unseen need feed the motion: the forces
    of the motors are in the file, or at least it is known what friction takes.
    """
    known = all(law is not None and law.unexplained < MOST_UNEXPLAINED for law in seen.laws)
    return known and (seen.rubs is not None or None not in seen.delays)


def _beyond(seen: PairEvidence, viscous_share: float, dry_share: float) -> dict[str, float]:
    """[J] of each term beyond what pays for it: viscous friction, and the terms that take, for all that grow
    with the motion's square; Coulomb friction for the force along the motion.
    """
    viscous, dry = seen.rubs or (0.0, 0.0)
    gives = {name: work for name, work in seen.supplied.items() if work > 0 and name != _DRY}
    pays = viscous_share * viscous - sum(
        work for name, work in seen.supplied.items() if work < 0 and name != _DRY
    )
    share = max(0.0, 1 - pays / sum(gives.values())) if gives else 0.0
    return {name: share * work for name, work in gives.items()} | {
        _DRY: seen.supplied[_DRY] - dry_share * dry
    }
