"""Available storage and the closed forms on random walls near their limits: never a contradiction."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from random import Random

import pytest

BENCHMARKS = Path(__file__).resolve().parents[3] / "benchmarks"

sys.path.insert(0, str(BENCHMARKS))
try:
    import random_walls
finally:
    sys.path.pop(0)


def tallied(seed, loops, replay):
    """What came out of so many loops."""
    tally = random_walls.Tally()
    for number in range(loops):
        random_walls.compare(random_walls.random_loop(Random(f"{seed} {number}")), tally, replay)
    return tally


def wrong(tally):
    """Findings that may not be; in brackets stands what may."""
    return {kind: found for kind, found in tally.findings.items() if not kind.startswith("(")}


@pytest.mark.parametrize("seed", ["a", "b"])
def test_no_contradiction(seed):
    """30 loops each; both verdicts occur, proofs of every kind among them."""
    tally = tallied(seed, 30, replay=False)
    assert not wrong(tally)
    outcomes = Counter(text.split(", storage ")[1] for text in tally.outcomes.elements())
    assert min(outcomes["passive"], outcomes["active"]) > 5
    assert any(text.startswith("check passive contact") for text in tally.outcomes)


def test_motions_replayed():
    """The same energy in the simulator, and stiff hands with the mass of the device get some of it."""
    tally = tallied("replayed", 10, replay=True)
    assert not wrong(tally)
    assert tally.rounds["motions replayed in the simulator"] > 2
    assert tally.rounds["of these, followed by stiff hands with the device's mass"] > 1


def test_a_contradiction_would_be_seen(monkeypatch):
    """With the friction taken out of the program's device only, proofs of the check meet motions."""
    honest = random_walls.losses_of

    def without_friction(device):
        return honest(device.replace(coulomb_friction=device.exact("coulomb_friction") / 3))

    monkeypatch.setattr(random_walls, "losses_of", without_friction)
    assert "proof against motion" in wrong(tallied("a", 20, replay=False))
