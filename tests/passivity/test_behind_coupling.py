"""A scene without H(z) is decided by the coupling before it: exactly there, and never beyond its proof."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.model.scene import Contact, CoulombFriction, Mass, Spring
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.verdict import Verdict

WALL, RUBBING = Contact("handle", "ground", 2000, 1, "0.005"), CoulombFriction("handle", "ground", "0.1")
SCENE = zw.Scene([Mass("handle", "0.05"), WALL, RUBBING])
DEVICE = zw.Device(damping="0.5", rate=1000, resolution=0)


def verdict(k: object, b: object, need: object, delay: object = 0, **more: object) -> Verdict:
    """On a device at 1 kHz with so much damping."""
    device = zw.Device(damping=need, rate=1000, delay=delay, **{"resolution": 0, **more})  # type: ignore[arg-type]
    answer = zw.check(device, zw.VirtualCoupling(k, b, SCENE))  # type: ignore[arg-type]
    assert isinstance(answer, Verdict)
    return answer


@pytest.mark.parametrize(
    ("k", "b", "delay", "need"),
    [
        (740, "0.13", 0, "0.5"),  # K T/2 + B
        (0, "0.4", 0, "0.4"),
        (300, 0, "0.001", "0.6"),  # (d + 1)² K T/2
        (300, 0, "0.002", "1.35"),
        (400, "-0.1", 0, "0.4"),  # (K T)²/(2 (K T − 2 |B|))
    ],
)
def test_the_closed_forms_of_the_theorem_are_the_limit(
    k: object, b: object, delay: object, need: str
) -> None:
    """Passive there, with a proof; a part in 10⁹ below nothing is said."""
    there = verdict(k, b, need, delay)
    assert there.outcome == "passive"
    assert there.at_limit
    assert there.certificate is not None
    assert there.certificate.verify()
    assert there.needs[0].needed == pytest.approx(float(need))
    below = verdict(k, b, Fraction(need) * (1 - Fraction(1, 10**9)), delay)
    assert below.outcome == "undecided"
    assert below.certificate is None


def test_the_verdict_says_what_it_rests_on(tmp_path: Path) -> None:
    """In its assumptions and its data; and by what it was decided; its certificate is in its file."""
    found = verdict(740, "0.13", 1)
    found.save(tmp_path / "scene.json")
    assert verify_document(read_document(tmp_path / "scene.json")).valid
    assert found.scope.law == ("behind a coupling",)
    assert any("gives out no energy" in line for line in found.assumptions)
    assert "coupling" in found.decided_by
    assert found.scope.contact == "made and broken"


def test_with_an_encoder_it_is_proved_without_its_steps() -> None:
    for friction in (0, 10):
        found = verdict(740, "0.13", 1, resolution="1e-5", coulomb_friction=friction)
        assert found.outcome == "passive without encoder steps"
        assert found.scope.encoder == "not counted"
        assert not found.is_proved


def test_no_coupling_and_one_that_loses_nothing_are_undecided() -> None:
    bare = zw.check(zw.Device(damping=1, rate=1000, resolution=0), SCENE)
    assert bare.outcome == "undecided"
    assert "VirtualCoupling" in bare.claim
    lossless = verdict(100, "-0.2", 5)
    assert lossless.outcome == "undecided"
    assert "no damping" in lossless.claim


def test_a_large_linear_scene_is_decided_by_its_coupling() -> None:
    """61 masses: passive where a small one is, without a word of H(z)."""
    chain = [Spring(f"m{i}", f"m{i + 1}", 300) for i in range(61)]
    scene = zw.Scene([*chain, *(Mass(f"m{i + 1}", "0.01") for i in range(61))], port="m0")
    found = zw.check(DEVICE, zw.VirtualCoupling(740, "0.13", scene))
    assert (found.outcome, found.scope.law) == ("passive", ("behind a coupling",))


def test_intervals_of_the_device_are_taken_at_their_worst() -> None:
    assert verdict(740, "0.13", ("0.5", "0.7")).outcome == "passive"
    assert verdict(740, "0.13", ("0.49", "0.7")).outcome == "undecided"


def test_couplings_one_behind_the_other() -> None:
    """The hand's decides, and what lies behind it is passive if no damping in it is below 0."""
    for damping, outcome in ((1, "passive"), ("-0.1", "undecided")):
        inner = zw.VirtualCoupling(5000, damping, SCENE)
        assert zw.check(DEVICE, zw.VirtualCoupling(740, "0.13", inner)).outcome == outcome


def test_a_limit_is_found_on_one_side() -> None:
    bracket = zw.limit(DEVICE, zw.VirtualCoupling(100, "0.13", SCENE))
    assert bracket.proved_passive == pytest.approx(740, rel=0.01)
    assert float(bracket.proved_passive or 0) <= 740
    assert bracket.proved_active is None
    with pytest.raises(zw.InputError, match="without encoder steps"):
        zw.limit(DEVICE.replace(resolution="1e-5"), zw.VirtualCoupling(100, "0.13", SCENE))
