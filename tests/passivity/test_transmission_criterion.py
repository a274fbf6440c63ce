"""The criterion of motor, transmission and hand, against time domain, replay, and its independent checker."""

from __future__ import annotations

import time
from fractions import Fraction

import numpy as np
import pytest
from transmission_lifted import Lifted, Plant, put_in

import zwidth as zw
from zwidth import checker
from zwidth.passivity.linear.transmission import Elastic, ElasticProof, ElasticRefutation, decide_elastic
from zwidth.passivity.transmission import elastic_of
from zwidth.quantity.text import to_json

NEAR, CLEAR = 1e-6, 1e-3


def cable(hertz: float = 220, mass: str = "0.03", damping: str = "0.06", **more: object) -> zw.Device:
    """Two masses of 30 g that swing against one another at so many Hz."""
    between = {name: more.pop(name) for name in ("damping", "encoder") if name in more}
    inside = {"damping": more.pop("inside", 0), "encoder": more.pop("encoder", "motor"), **between}
    stiffness = f"{float(mass) / 2 * (2 * np.pi * hertz) ** 2:.9g}"
    given = zw.Transmission(stiffness=stiffness, handle_damping="0.09", **inside)
    return zw.Device(mass=mass, damping=damping, rate=1000, transmission=given, **more)


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


def limit(device: zw.Device, law: object) -> float:
    """Up to which there is a proof."""
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
    found = limit(device, law)
    assert known is None or found == pytest.approx(known, rel=NEAR)
    below, above = (
        zw.check(device, law(found * (1 + side)), contact="kept", iterate=False) for side in (-NEAR, NEAR)
    )
    assert (below.outcome, above.outcome) == ("passive", "active")
    assert below.certificate.verify()
    assert above.violation.verify()
    assert Plant.of(needed(device, law(found))).growth < 1
    for side in (-CLEAR, CLEAR):
        form = Lifted(Plant.of(needed(device, law(found * (1 + side)))), 32)
        assert (form.worst(24)[0] < 0) is (side > 0)


@pytest.mark.parametrize(
    "name", ["220 Hz", "3 kHz", "a sample and a part", "at the handle, late", "a solid that relaxes"]
)
def test_a_motion_gains_above_and_none_below(name):
    """By forces on a handle of any mass: in each period at 1.01 of the limit; at 0.99 neither the worst motion
    nor any of 200 at random."""
    device, law, _ = LOOPS[name]
    found, rng = limit(device, law), np.random.default_rng(1)
    above, below = (Plant.of(needed(device, law(found * side))) for side in (1.01, 0.99))
    form = Lifted(above, 32)
    angle = form.worst(24)[1]
    worst = form.worst_speeds(angle)[:, None]
    for handle_mass in (0.2, 1, 50):
        gained = put_in(above, handle_mass * above.mass, angle, worst, 40)
        assert (np.diff(gained, axis=0) < 0).all()
    noise = rng.normal(size=(2, 25, 49)) * 10 ** rng.uniform(-3, 1, 49) * abs(worst)
    motions = np.hstack([worst, worst + noise[0] + 1j * noise[1]])
    for turn in (angle, *rng.uniform(0.05, np.pi, 3)):
        assert (np.diff(put_in(below, below.mass, turn, motions, 10), axis=0) > 0).all()
