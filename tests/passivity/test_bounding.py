"""Force bounding with a certificate: accepted at its limits, refused just past them, and why that matters."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from json_page import json_page
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.model.rendering import Damper, ForceBounding, Saturation
from zwidth.passivity.bounding import check_bounding

PADDLE = zw.catalogue.device("haptic-paddle")
TINY = Fraction(1, 10**9)


def bounded(stiffness=5000, **how):
    return zw.render(zw.Wall(stiffness), ForceBounding(**how))


def crediting(*factors):
    """Force bounding with credit, friction, count and half step each so many times what they are."""

    class Law(ForceBounding):
        def numbers(self, at):
            return [n * f for n, f in zip(super().numbers(at), (*factors, 1.0, 1.0), strict=True)]

    return Law()


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


def plain(friction=0, resolution=0):
    loss = {"damping": "0.15", "coulomb_friction": friction}
    return zw.Device(mass="0.04", **loss, resolution=resolution, sample_period="0.001")


def test_whatever_comes_before_it_is_proved():
    """Other environments, other laws, resets, no encoder, other devices: the same proof."""
    for law in (bounded(), bounded(10**9, resets=True), zw.render(zw.Maxwell(3000, 20), ForceBounding())):
        assert check_bounding(PADDLE, law).outcome == "passive"
    row = zw.render(zw.Wall(5000), Damper(3), Saturation(2), ForceBounding())
    assert check_bounding(PADDLE, row).certificate.verify()
    assert check_bounding(plain(), bounded(encoder="ideal")).outcome == "passive"
    rng = np.random.default_rng(3)
    keys = ("damping", "coulomb_friction", "resolution", "sample_period", "force_resolution")
    for _ in range(200):  # numbers that no double hits
        numbers = (str(v) for v in 10 ** rng.uniform(-6, 1, 5))
        device = zw.Device(**dict(zip(keys, numbers, strict=True)))
        assert check_bounding(device, bounded()).outcome == "passive"


def test_the_verdict_says_what_it_supposes():
    """Contact made and broken, any environment, counts, rounding; a late force is not proved."""
    found = check_bounding(PADDLE, bounded())
    assert found.certificate.kind == "force bounding"
    assert found.certificate.covered().contact == "made and broken"
    told = " ".join(found.assumptions)
    for words in ("made and broken", "any environment", "counts", "rounding", "b = 0.15"):
        assert words in told
    assert "passive" in repr(found)
    late = check_bounding(PADDLE.replace(delay="0.0001"), bounded())
    assert (late.outcome, late.certificate) == ("undecided", None)
    assert "late" in late.claim
    assert "count" in check_bounding(PADDLE, bounded(encoder="ideal")).claim


@pytest.mark.parametrize(
    "key", ["damping", "coulomb_friction", "resolution", "sample_period", "force_resolution"]
)
def test_no_more_is_credited_than_the_device_has(key):
    """A billionth less friction, or coarser: the law as it is credits too much."""
    proof = check_bounding(PADDLE, bounded()).certificate.to_dict()
    (name,) = (name for name in proof["loop"] if name.startswith(f"{key}_"))
    worse = Fraction(proof["loop"][name]) * (1 - TINY if key in ("damping", "coulomb_friction") else 1 + TINY)
    assert not checker.verify(tampered(proof, ("loop", name), str(worse))).valid


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


ROUGH = plain(friction="0.0001", resolution="0.00005")
EDGE = -5e-5 + 5e-11 * np.where(np.arange(400) % 2, 1, -1)


@pytest.mark.parametrize(
    ("device", "wrong", "motion"),
    [
        # a hand that creeps out against no more than the friction that was credited
        (
            plain(friction="0.12"),
            crediting(1, 1 + 1e-9, 1, 1),
            [1e-3, *(1e-3 - 4e-13 * np.arange(1, 200))],
        ),
        # counts taken for a hundredth of what they are: to and fro over an edge, then a leap
        (ROUGH, crediting(1, 1, 0.01, 1), [*EDGE, 1.25e-4, 1.25e-4 - 2 * 150 * 5e-5 * 20 / 300]),
    ],
    ids=["friction", "counts"],
)
def test_what_is_credited_too_much_is_refused_and_taken_out(device, wrong, motion):
    for stage, gains in ((ForceBounding(), False), (wrong, True)):
        out, forces = energy_out(device, stage, np.array(motion))
        assert device == ROUGH or float(forces[-1]) == pytest.approx(0.12, rel=1e-6)
        assert (out > 0) is gains
        assert (check_bounding(device, zw.render(zw.Wall(5000), stage)).outcome == "passive") is not gains


def test_a_rotary_device_has_its_units():
    knob = zw.Device(damping="0.01", coulomb_friction="0.01", rate=1000, resolution="0.001", motion="rotary")
    proof = check_bounding(knob, bounded()).to_dict()["certificate"]
    keys = {"damping_N_m_s_per_rad", "credit_N_m_per_rad", "count_rad", "friction_N_m"}
    assert keys <= {*proof["loop"], *proof["law"]}


def test_every_key_is_on_its_page():
    report = check_bounding(PADDLE, bounded()).to_dict()
    proof = report["certificate"]
    keys = (*report, *proof, *proof["loop"], *proof["law"])
    assert not [key for key in keys if f"`{key}`" not in json_page()]


@pytest.mark.parametrize(
    ("device", "law", "words"),
    [
        (PADDLE, zw.Wall(300), r"ForceBounding\(\) is the last of them, got wall"),
        (PADDLE, zw.render(zw.Wall(300), ForceBounding(), Damper(1)), "is the last of them"),
        (PADDLE.replace(damping=("0.1", "0.2")), bounded(), "damping has no single value"),
        (plain().replace(damping=0), bounded(), "pays for the force with the device's damping"),
    ],
)
def test_what_it_refuses(device, law, words):
    with pytest.raises(zw.InputError, match=words):
        check_bounding(device, law)
