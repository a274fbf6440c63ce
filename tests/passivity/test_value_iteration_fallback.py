"""`check` beyond the closed forms: the game settles what they leave open, and says for which hands."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import zwidth as zw
from zwidth import checker
from zwidth.checker import judge
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.outcome_evidence import claim
from zwidth.passivity.storage.gain import Gain, peak_force, settled_round
from zwidth.passivity.value_iteration_fallback import has_gap
from zwidth.passivity.wording import describe_hands
from zwidth.quantity.text import shown

PADDLE = zw.catalogue.device("haptic-paddle")
STIFF = zw.Wall(stiffness=1500, damping=0.05, clamped=True)
WINDOW = zw.Wall(stiffness=120, damping=0.2, velocity_filter=zw.rendering.Window(3))
CLAMPED = WINDOW.replace(clamped=True)
SMOOTH = PADDLE.replace(coulomb_friction="0.002")
SOFT = zw.Wall(stiffness=150, damping=0.05, clamped=True)
"""With so little friction straddling an edge of the encoder gains; deep inside nothing is clamped."""


def test_a_motion_of_the_game_refutes_what_was_undecided() -> None:
    """A clamped wall, of which the linear criterion says nothing; a real hand replays the motion."""
    assert check_by_closed_forms(SMOOTH, SOFT).outcome == "undecided"
    verdict = zw.check(SMOOTH, SOFT)
    assert verdict.outcome == "active"
    assert isinstance(verdict.witness, Gain)
    assert verdict.certificate is None
    assert verdict.available_storage.witness is verdict.witness
    assert f"takes {shown(verdict.witness.energy, 'J')} out of this loop in" in verdict.claim
    assert checker.verify(verdict.witness.to_dict()).energy == verdict.witness.exact_energy
    assert verdict.scope.contact == "made and broken"
    replayed = zw.replay(verdict)
    assert replayed.replayed == pytest.approx(replayed.claimed, rel=1e-9)


def test_a_proof_of_bounded_hands_decides_nothing_of_every_hand() -> None:
    verdict = zw.check(PADDLE, CLAMPED)
    assert verdict.outcome == "undecided"
    assert verdict.certificate is None
    assert verdict.available_storage.outcome == "passive"
    hands = describe_hands(verdict.available_storage.scope.hands, "linear")
    assert f"Contact made and broken: proved passive for {hands}." in verdict.claim
    assert verdict.claim.startswith(claim(check_by_closed_forms(PADDLE, CLAMPED)))


def test_a_proof_of_sustained_contact_says_for_whom_contact_is_covered() -> None:
    """The outcome, the claim and the certificate are those of the closed forms."""
    before, verdict = check_by_closed_forms(PADDLE, WINDOW), zw.check(PADDLE, WINDOW)
    assert verdict.outcome == before.outcome == "passive in contact"
    assert verdict.certificate == before.certificate
    assert verdict.scope == before.scope
    assert not verdict.available_storage.scope.hands.every
    assert "nothing is proved or refuted" in before.claim
    assert "Contact made and broken: proved passive for hands of up to" in verdict.claim


@pytest.mark.parametrize(
    ("device", "law"),
    [
        (PADDLE, zw.Wall(stiffness=300)),
        (PADDLE, zw.Wall(stiffness=770)),
        (PADDLE, zw.Wall(stiffness=100, damping=0.05)),
        (PADDLE.replace(resolution=0), CLAMPED),
        (PADDLE.replace(delay="0.0003"), CLAMPED),
        (PADDLE.replace(damping=(0.1, 0.2)), CLAMPED),
        (PADDLE, CLAMPED.replace(stiffness=(200, 300))),
    ],
    ids=["spring", "active", "contact", "ideal encoder", "part of a sample", "interval", "interval of law"],
)
def test_no_game_where_there_is_no_gap(device: zw.Device, law: zw.Wall) -> None:
    assert not has_gap(device, law, check_by_closed_forms(device, law))
    assert zw.check(device, law).available_storage is None


def test_a_law_that_cannot_be_played_keeps_its_verdict() -> None:
    """A window of more readings than the game remembers."""
    law = WINDOW.replace(velocity_filter=zw.rendering.Window(20), damping=0.27)
    assert has_gap(PADDLE, law, check_by_closed_forms(PADDLE, law))
    verdict = zw.check(PADDLE, law)
    assert verdict.available_storage is None
    assert verdict == check_by_closed_forms(PADDLE, law)


def test_limits_and_advice_play_no_games(monkeypatch: pytest.MonkeyPatch) -> None:
    verdict = zw.check(PADDLE, STIFF)

    def never(*_: object, **__: object) -> None:
        raise AssertionError("a game was played")

    monkeypatch.setattr("zwidth.passivity.storage.solution.available_storage", never)
    assert verdict.max_stiffness == 200
    assert verdict.required_damping == pytest.approx(0.8)
    assert any(a.to for a in verdict.advice)


def test_a_check_without_a_gap_loads_no_numerical_library() -> None:
    code = (
        "import sys, zwidth as zw; p = zw.catalogue.device('haptic-paddle');"
        "v = zw.check(p, zw.Wall(stiffness=100, damping=0.05)); assert v.outcome == 'passive';"
        "print({'numpy', 'xarray'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_a_motion_that_must_touch_and_leave_is_told_from_the_others() -> None:
    """Where a hand that stays inside gains nothing, the numbers are those proved with contact."""
    gain = zw.check(SMOOTH, SOFT).witness
    verdict = replace(check_by_closed_forms(PADDLE, WINDOW), outcome="active", certificate=None, motion=gain)
    assert verdict.limit == "contact made and broken"
    assert verdict.mode is None
    need = float(decide(PADDLE, WINDOW).contact_damping)
    assert 0.15 < need < 0.12 / 2 + 0.2
    assert verdict.required_damping == pytest.approx(need)
    assert verdict.max_stiffness == pytest.approx(120 - 2 * (need - 0.15) * 1000)
    assert verdict.margins["damping"] == pytest.approx(0.15 - need)
    (damping,) = [a for a in verdict.advice if a.parameter == "damping"]
    assert damping.to == pytest.approx(need, rel=1e-3)


@pytest.mark.parametrize(
    ("device", "law"),
    [(SMOOTH, SOFT), (PADDLE, CLAMPED), (PADDLE, WINDOW)],
    ids=["active", "undecided", "passive"],
)
def test_the_json_names_the_game_and_a_saved_file_holds_its_proof(
    device: zw.Device, law: zw.Wall, tmp_path: Path
) -> None:
    verdict = zw.check(device, law)
    told = json.loads(verdict.to_json())
    assert set(told["worst_hand"]) == {"format", "outcome", "claim", "scope", "assumptions"}
    verdict.save(tmp_path / "verdict.json")
    saved = json.loads((tmp_path / "verdict.json").read_text(encoding="utf-8"))
    parts = judge(saved).parts
    assert all(part.verification.valid for part in parts)
    kinds = {"active": ["contact motion"], "passive in contact": ["quantized", "slow hands"]}
    assert [part.evidence["kind"] for part in parts] == kinds.get(verdict.outcome, ["slow hands"])


@pytest.mark.parametrize("delay", [0, "0.001", "0.0003"])
def test_the_prescribed_motion_takes_out_what_it_claims(delay: float | str) -> None:
    """In the simulator, with an ideal amplifier and the encoder's edges where the game has them.

    The forces of a settled round, which are drawn, are those that the checker multiplies.
    """
    device, wall = PADDLE.replace(delay=delay), zw.Wall(700, 0.05)
    gain = zw.available_storage(device, wall, penetration="0.002", speed="0.5").witness
    hand = zw.operators.WitnessMotion(gain)
    seconds = (hand.intervals + 1) * device.exact("sample_period")
    trace = zw.simulate(device, wall, hand, seconds, amplifier=zw.amplifiers.Ideal(), encoder_phase=0)
    assert -float(trace.hand_work[-1]) == pytest.approx(gain.energy, rel=1e-9)
    once = settled_round(gain)
    assert once.energies[-1] == pytest.approx(gain.energy_per_cycle, rel=1e-9)
    assert len(once.forces) + 1 == len(once.positions) == len(once.energies)
    assert peak_force(gain) >= max(once.forces) > 0


def test_the_actuator_that_the_motion_asks_for_is_named() -> None:
    (line,) = zw.check(PADDLE.replace(force_limit="0.5"), STIFF).demand
    assert "more than the actuator's 0.5 N" in line
    (line,) = zw.check(PADDLE.replace(force_limit=20), STIFF).demand
    assert "stays within" in line
