"""The criterion of motor, transmission and hand, against time domain, replay, and its independent checker."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from transmission_lifted import Lifted, Plant, put_in

import zwidth as zw
from zwidth.passivity.linear.transmission import Elastic, ElasticProof, ElasticRefutation, decide_elastic
from zwidth.passivity.transmission import elastic_of

NEAR, CLEAR = 1e-6, 1e-3


def cable(hertz: float = 220, **more: object) -> zw.Device:
    """Two masses of 30 g that swing against one another at so many Hz."""
    between = {"damping": more.pop("inside", 0), "encoder": more.pop("encoder", "motor")}
    stiffness = f"{0.015 * (2 * np.pi * hertz) ** 2:.9g}"
    given = zw.Transmission(stiffness=stiffness, handle_damping="0.09", **between)
    return zw.Device(mass="0.03", damping="0.06", rate=1000, transmission=given, **more)


def spring(stiffness: float) -> zw.Wall:
    return zw.Wall(f"{stiffness:.12g}")


def damped(damping: float) -> object:
    return lambda stiffness: zw.Wall(f"{stiffness:.12g}", damping=damping)


def filtered(stiffness: float) -> zw.PulseTransferFunction:
    return zw.PulseTransferFunction([f"{stiffness / 2:.12g}", 0], [1, "-0.5"])


def solid(stiffness: float) -> zw.StandardLinearSolid:
    return zw.StandardLinearSolid(f"{stiffness:.12g}", 20, 0.05)


def decided(device: zw.Device, law: object) -> ElasticProof | ElasticRefutation:
    return decide_elastic(needed(device, law))


def needed(device: zw.Device, law: object) -> Elastic:
    found = elastic_of(device, law)
    assert found is not None
    return found


LOOPS = {
    "60 Hz": (cable(60), spring, 120.75278),
    "220 Hz": (cable(220), spring, 129.92691),
    "3 kHz": (cable(3000), spring, 271.25121),
    "friction inside": (cable(inside="0.02"), spring, 162.96000),
    "part of a sample": (cable(delay="0.3 ms"), spring, 86.34794),
    "a sample and a part": (cable(delay="1.3 ms", inside="0.02"), spring, 64.66888),
    "at the handle": (cable(encoder="handle"), spring, 257.27337),
    "at the handle, late": (cable(encoder="handle", delay="0.3 ms", inside="0.02"), spring, 178.59210),
    "virtual damping": (cable(60), damped(0.03), 178.47538),
    "less damping than none": (cable(inside="0.02"), damped(-0.01), None),
    "a filter": (cable(), filtered, None),
    "a solid that relaxes": (cable(), solid, 123.79499),
}


@cache
def limit(name: str) -> float:
    """Up to which there is a proof."""
    device, law, _ = LOOPS[name]
    low, high = 1.0, 1000.0
    while high - low > 1e-8 * low:
        middle = (low + high) / 2
        low, high = (
            (middle, high) if isinstance(decided(device, law(middle)), ElasticProof) else (low, middle)
        )
    return low


@pytest.mark.parametrize("name", LOOPS)
def test_both_sides_of_a_limit(name):
    """Proved and refuted at (1 ∓ 1e-6), and so by speeds in the time domain at (1 ∓ 1e-3)."""
    device, law, known = LOOPS[name]
    found = limit(name)
    assert known is None or found == pytest.approx(known, rel=NEAR)
    below, above = (
        zw.check(device, law(found * (1 + side)), contact="kept", iterate=False) for side in (-NEAR, NEAR)
    )
    assert (below.outcome, above.outcome) == ("passive", "active")
    assert below.certificate.verify()
    assert above.violation.verify()
    assert Plant.of(needed(device, law(found))).growth < 1
    for side in (-CLEAR, CLEAR):
        form = Lifted(Plant.of(needed(device, law(found * (1 + side)))), 24)
        assert (form.worst(16)[0] < 0) is (side > 0)


@pytest.mark.parametrize(
    "name", ["220 Hz", "3 kHz", "a sample and a part", "at the handle, late", "a solid that relaxes"]
)
def test_a_motion_gains_above_and_none_below(name):
    """By forces on a handle of any mass: in each period at 1.01 of the limit; at 0.99 neither the worst one
    nor any of 100 at random."""
    device, law, _ = LOOPS[name]
    found, rng = limit(name), np.random.default_rng(1)
    above, below = (Plant.of(needed(device, law(found * side))) for side in (1.01, 0.99))
    form = Lifted(above, 24)
    angle = form.worst(16)[1]
    worst = form.worst_speeds(angle)[:, None]
    for handle_mass in (0.2, 1, 50):
        gained = put_in(above, handle_mass * above.mass, angle, worst, 40)
        assert (np.diff(gained, axis=0) < 0).all()
    noise = rng.normal(size=(2, 25, 49)) * 10 ** rng.uniform(-3, 1, 49) * abs(worst)
    motions = np.hstack([worst, worst + noise[0] + 1j * noise[1]])
    for turn in (angle, *rng.uniform(0.05, np.pi, 3)):
        assert (np.diff(put_in(below, below.mass, turn, motions, 10), axis=0) > 0).all()


def plain(numerator: str, denominator: list[str], device: zw.Device) -> tuple[object, Plant]:
    """What is decided of a law, and the plant."""
    law = zw.PulseTransferFunction([numerator, 0], denominator)
    return decided(device, law), Plant.of(needed(device, law))


UNIT = zw.Transmission(stiffness=1, damping=3, handle_damping=1)


@pytest.mark.parametrize(
    ("damping", "transmission"),
    [
        (0, UNIT.replace(handle_damping=zw.Exact(Fraction(4, 15)))),  # n has two equal roots
        (0, UNIT.replace(handle_damping=zw.Exact(Fraction(4, 15) * (1 + Fraction(1, 10**60))))),
        (1, UNIT.replace(damping=1)),  # held still, the motor creeps as fast as it can without swinging
    ],
)
def test_roots_that_are_equal(damping, transmission):
    """Of n, or of the motor while the hand holds still: decided as their neighbours are."""
    device = zw.Device(mass=1, damping=damping, sample_period=1, transmission=transmission)
    neighbour = device.replace(damping=float(device.damping) + 1e-9)
    for one in (device, neighbour):
        found = [decided(one, spring(stiffness)) for stiffness in (0.1, 10)]
        assert isinstance(found[0], ElasticProof)
        assert found[1].reason in ("criterion", "unstable")


def test_nothing_rubs_on_the_motor():
    """A spring shakes it; a damper in the law is what it lacks."""
    bare = zw.Transmission(stiffness=1, handle_damping=1)
    device = zw.Device(mass=1, damping=0, sample_period=1, transmission=bare)
    assert decided(device, spring(0.1)).reason == "criterion"
    assert isinstance(decided(device, zw.Wall("0.01", damping="0.1")), ElasticProof)


def test_a_law_with_a_pole_outside_that_the_motor_steadies():
    """H(1) < −k: at rest the hand feels kH/(k + H) > 0, and with enough friction on its side it is passive;
    with the encoder at the handle nothing steadies it."""
    between = UNIT.replace(damping="0.1")
    seen = {}
    for rubs in (1, 3):
        device = zw.Device(
            mass="0.01", damping="0.3", sample_period=1, transmission=between.replace(handle_damping=rubs)
        )
        seen[rubs], plant = plain("0.5", [1, "-1.05"], device)
        assert (plant.growth < 1, plant.at_rest) == (True, pytest.approx(10 / 9))
        assert (Lifted(plant, 24).worst(24)[0] < 0) is (rubs == 1)
    assert seen[1].reason == "criterion"
    assert isinstance(seen[3], ElasticProof)
    there = device.replace(transmission=between.replace(encoder="handle"))
    assert plain("0.5", [1, "-1.05"], there)[0].reason in ("criterion", "unstable")
    assert plain("-0.01", [1, 0], device)[0].reason == "negative static stiffness"


@pytest.mark.parametrize("hertz", [20, 400, 20_000])
@pytest.mark.parametrize("inside", ["0", "0.02", "5"])
def test_what_the_motor_feels_is_enough_for_every_cable(hertz, inside):
    """Up to 2 (b₁ + c b₂/(c + b₂))/T there is a proof."""
    b, c, h = 0.06, float(inside), 0.09
    enough = 2000 * (b + c * h / (c + h))
    assert isinstance(decided(cable(hertz, inside=inside), spring(enough * (1 - NEAR))), ElasticProof)


def test_a_rod_is_no_cable():
    """Said so, and not computed with."""
    verdict = zw.check(cable(1e6), spring(200))
    assert (verdict.outcome, verdict.elastic) == ("undecided", None)
    assert "so stiff" in verdict.claim
