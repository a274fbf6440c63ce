"""Force bounding with a certificate: accepted at its limits, refused just past them, and why that matters."""

from __future__ import annotations

import copy
import json
from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth import checker
from zwidth.model.rendering import Damper, ForceBounding, Saturation
from zwidth.passivity.bounding import check_bounding
from zwidth.passivity.certificate import read_document, verify_document

PADDLE = zw.catalogue.device("haptic-paddle")
TINY = Fraction(1, 10**9)
U = Fraction(1, 2**53)


def bounded(stiffness=5000, **how):
    """A wall far too stiff, behind force bounding."""
    return zw.render(zw.Wall(stiffness), ForceBounding(**how))


def document(device=PADDLE):
    """The proof as plain data, apart from the one that was made."""
    certificate = check_bounding(device, bounded()).certificate
    return copy.deepcopy(certificate.to_dict())


class Crediting(ForceBounding):
    """Force bounding that credits other numbers than it should."""

    factors = (1.0, 1.0, 1.0, 1.0)

    def numbers(self, at):
        """Credit, friction, count and half step, each so many times what they are."""
        own = super().numbers(at)
        return [n * f for n, f in zip(own, (*self.factors, 1.0, 1.0), strict=True)]


def crediting(*factors):
    """A law with these factors."""
    return type("Law", (Crediting,), {"factors": factors})()


def energy_out(device, stage, positions, stiffness=1e5):
    """What a motion takes out, in rational arithmetic, from the forces that the simulator gives it."""
    loop = zw.render(zw.Wall(stiffness), stage)
    b, fc, period = (device.exact(key) for key in ("damping", "coulomb_friction", "sample_period"))
    motion = zw.operators.PrescribedMotion(positions)
    trace = zw.simulate(device, loop, motion, (len(positions) - 1) * period)
    forces = [Fraction(float(f)) for f in trace.commanded_force.values]
    x = [Fraction(float(p)) for p in positions]
    moves = [after - before for before, after in zip(x, x[1:], strict=False)]
    return -sum(f * d + fc * abs(d) + b / period * d * d for f, d in zip(forces, moves, strict=False)), forces


def plain(friction=0, resolution=0, **more):
    """A device of 0.15 N·s/m at 1 kHz."""
    return zw.Device(
        mass="0.04",
        damping="0.15",
        coulomb_friction=friction,
        resolution=resolution,
        sample_period="0.001",
        **more,
    )


def test_whatever_comes_before_it_is_proved():
    """Other environments, other laws, resets, no encoder, other devices: the same proof."""
    for law in (bounded(), bounded(10**9, resets=True), zw.render(zw.Maxwell(3000, 20), ForceBounding())):
        assert check_bounding(PADDLE, law).outcome == "passive"
    row = zw.render(zw.Wall(5000), Damper(3), Saturation(2), ForceBounding())
    assert check_bounding(PADDLE, row).certificate.verify()
    assert check_bounding(plain(), bounded(encoder="ideal")).outcome == "passive"
    rng = np.random.default_rng(3)
    for _ in range(200):  # numbers that no double hits
        b, fc, size, period, step = (str(v) for v in 10 ** rng.uniform(-6, 1, 5))
        device = zw.Device(
            damping=b, coulomb_friction=fc, resolution=size, sample_period=period, force_resolution=step
        )
        assert check_bounding(device, bounded()).outcome == "passive"


def test_the_verdict_says_what_it_supposes():
    """Contact made and broken, any environment, counts, rounding; a late force is not proved."""
    found = check_bounding(PADDLE, bounded())
    assert found.certificate.kind == "force bounding"
    assert found.certificate.covered().contact == "made and broken"
    told = " ".join(found.assumptions)
    assert all(
        words in told for words in ("made and broken", "any environment", "counts", "rounding", "b = 0.15")
    )
    assert "passive" in repr(found)
    late = check_bounding(PADDLE.replace(delay="0.0001"), bounded())
    assert (late.outcome, late.certificate) == ("undecided", None)
    assert "late" in late.claim
    assert "count" in check_bounding(PADDLE, bounded(encoder="ideal")).claim


@pytest.mark.parametrize(
    ("key", "limit", "beyond"),
    [
        ("credit_N_per_m", 150, 1 + TINY),
        ("friction_N", Fraction("0.12") / (1 + U), 1 + TINY),
        ("count_m", Fraction("0.0000224"), 1 - TINY),
        ("half_step_N", PADDLE.exact("force_resolution") / 2, 1 - TINY),
        ("roundoff", 3 * U, Fraction(4, 3)),
        ("hair", 10 * U, Fraction(9, 10)),
    ],
)
def test_accepted_at_each_limit_and_refused_just_past_it(key, limit, beyond):
    """Each number of the law by itself; credited more, or covering less, by a billionth."""
    proof = document()
    proof["law"][key] = str(limit)
    assert checker.verify(proof).valid
    proof["law"][key] = str(limit * beyond)
    refused = checker.verify(proof)
    assert not refused.valid
    assert "malformed" not in refused.reason


@pytest.mark.parametrize(
    ("key", "factor"),
    [
        ("damping_N_s_per_m", 1 - TINY),
        ("coulomb_friction_N", 1 - TINY),
        ("resolution_m", 1 + TINY),
        ("sample_period_s", 1 + TINY),
        ("force_resolution_N", 1 + TINY),
    ],
)
def test_another_device_is_not_covered(key, factor):
    """A billionth less friction, or coarser: the law as it is credits too much."""
    proof = document()
    proof["loop"][key] = str(Fraction(proof["loop"][key]) * factor)
    assert not checker.verify(proof).valid


def test_a_credit_of_a_billionth_too_much_is_refused_and_taken_out():
    """The best leap after a touch: out of the law as it is comes nothing, out of the other a billionth."""
    rest = np.linspace(-1e-3, 4e-4, 9)
    for stage, gains in ((ForceBounding(), False), (crediting(1 + 1e-9, 1, 1, 1), True)):
        _, forces = energy_out(plain(), stage, rest)
        leap = [*rest, rest[-1] - float(forces[-1]) * 1e-3 / 0.3]
        out, _ = energy_out(plain(), stage, leap)
        stored = -energy_out(plain(), stage, rest)[0]
        assert (check_bounding(plain(), zw.render(zw.Wall(5000), stage)).outcome == "passive") is not gains
        assert (out > 0) is gains
        if gains:
            assert 5e-10 * stored < out < 2e-9 * stored


def test_a_friction_of_a_billionth_too_much_is_refused_and_taken_out():
    """A hand that creeps out against no more than the friction that was credited."""
    device = plain(friction="0.12")
    creep = np.array([1e-3, *(1e-3 - 4e-13 * np.arange(1, 200))])
    for stage, gains in ((ForceBounding(), False), (crediting(1, 1 + 1e-9, 1, 1), True)):
        out, forces = energy_out(device, stage, creep)
        assert float(forces[-1]) == pytest.approx(0.12, rel=1e-6)
        assert (out > 0) is gains
        assert (check_bounding(device, zw.render(zw.Wall(5000), stage)).outcome == "passive") is not gains


def test_without_its_counts_it_is_refused_and_refuted():
    """A law that takes the counts for a hundredth of what they are: to and fro over an edge, then a leap."""
    device = plain(friction="0.0001", resolution="0.00005")
    jitter = -5e-5 + 5e-11 * np.where(np.arange(400) % 2, 1, -1)
    force = 2 * 150 * 5e-5 * 20
    motion = np.array([*jitter, 1.25e-4, 1.25e-4 - force / 300])
    for stage, gains in ((ForceBounding(), False), (crediting(1, 1, 0.01, 1), True)):
        out, _ = energy_out(device, stage, motion)
        assert (out > 0) is gains
        assert (check_bounding(device, zw.render(zw.Wall(5000), stage)).outcome == "passive") is not gains


def test_tampered_documents_are_rejected_with_a_reason():
    """Whatever is missing, no number, or of the wrong sign; never an exception."""
    for table in ("loop", "law"):
        for key in document()[table]:
            for value in (None, "x", "", [], {}, "1/0", True, -1, "1e999999"):
                proof = document()
                proof[table][key] = value
                found = checker.verify(proof)
                assert not found.valid, (table, key, value)
                assert found.reason
            proof = document()
            proof[table][f"{key}_more"] = proof[table][key]
            if table == "law":
                assert not checker.verify(proof).valid
            proof = document()
            del proof[table][key]
            assert not checker.verify(proof).valid
        for value in (None, [], "x"):
            assert not checker.verify({**document(), table: value}).valid


def test_it_is_saved_and_verified(tmp_path):
    """As JSON, by the same door as every certificate; a changed digit is seen."""
    check_bounding(PADDLE, bounded()).save(tmp_path / "proof.json")
    saved = read_document(tmp_path / "proof.json")
    assert verify_document(saved).valid
    assert saved["outcome"] == "passive"
    saved["certificate"]["law"]["credit_N_per_m"] = "150.0000001"
    assert not verify_document(saved).valid
    rotary = zw.Device(
        damping="0.01", coulomb_friction="0.01", rate=1000, resolution="0.001", motion="rotary"
    )
    keys = {k for t in ("loop", "law") for k in check_bounding(rotary, bounded()).to_dict()["certificate"][t]}
    assert {"damping_N_m_s_per_rad", "credit_N_m_per_rad", "count_rad", "friction_N_m"} <= keys


def test_every_key_is_on_its_page():
    """Whoever reads a certificate by program finds each of them explained."""
    from pathlib import Path

    page = (Path(__file__).parents[2] / "docs" / "json.md").read_text(encoding="utf-8")
    report = json.loads(json.dumps(check_bounding(PADDLE, bounded()).to_dict()))
    proof = report["certificate"]
    assert not [key for key in (*report, *proof, *proof["loop"], *proof["law"]) if f"`{key}`" not in page]


def test_what_it_refuses():
    """One clear line for another law, no law, and numbers that are not one number."""
    with pytest.raises(zw.InputError, match=r"ForceBounding\(\) is the last of them, got wall"):
        check_bounding(PADDLE, zw.Wall(300))
    with pytest.raises(zw.InputError, match="is the last of them"):
        check_bounding(PADDLE, zw.render(zw.Wall(300), ForceBounding(), Damper(1)))
    with pytest.raises(zw.InputError, match="damping has no single value"):
        check_bounding(PADDLE.replace(damping=("0.1", "0.2")), bounded())
    with pytest.raises(zw.InputError, match="pays for the force with the device's damping"):
        check_bounding(plain().replace(damping=0), bounded())
