"""What is said over the ranges of a device holds for every device in them, and its ends are ends."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import zwidth as zw
from zwidth.model.device.catalogue import DeviceInRange, Range
from zwidth.passivity.interval_devices import OverRanges, over_ranges
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.spoken import answers_in

WIDE = {
    "damping": (0.013, 0.21),
    "coulomb_friction": (0.03, 0.4),
    "resolution": (1e-5, 7e-5),
    "sample_period": (0.0009, 0.0017),
    "delay": (0.0002, 0.0031),
}


def device_in(**bounds: tuple[float, float]) -> DeviceInRange:
    """With intervals of these ends, the rest certain."""
    numbers: dict[str, Any] = {k: zw.Interval(*bounds[k]) if k in bounds else v[0] for k, v in WIDE.items()}
    ranges = {
        k: Range(Exact(low), Exact(high), "1", "chosen for a test") for k, (low, high) in bounds.items()
    }
    return DeviceInRange(zw.Device(name="in range", **numbers), ranges)


def said(found: DeviceInRange, wall: zw.Wall) -> OverRanges:
    return over_ranges(found, wall, zw.check(found.device, wall))


def drawn(found: DeviceInRange, seed: int) -> zw.Device:
    draw = np.random.default_rng(seed)
    picks = {k: Exact(float(draw.uniform(*map(float, ends(getattr(found.device, k)))))) for k in found.ranges}
    return found.device.replace(**picks)


@pytest.mark.parametrize("law", [zw.Wall(3.0), zw.Wall(3.0, 0.004)])
def test_the_stiffness_for_every_device(law: zw.Wall) -> None:
    """It is passive for devices drawn from the ranges, and a few percent more is not for the worst."""
    timing = ("sample_period", "delay") if law.damping else ()
    bounds = {k: v for k, v in WIDE.items() if k not in timing}
    found = device_in(**bounds)
    if law.damping:  # with a delay between whole samples nothing is proved of it, contact made and broken
        found = DeviceInRange(found.device.replace(delay=0), found.ranges)
    over = said(found, law)
    assert over.every is not None
    assert over.best is not None
    assert 0 < over.every < over.best
    for seed in range(12):
        verdict = zw.check(drawn(found, seed), law.replace(stiffness=Exact(over.every)))
        assert verdict.outcome == "passive"
        assert verdict.scope.contact == "made and broken"
    for limit, is_best in ((over.every, False), (over.best, True)):
        more = {k: (k in ("damping", "coulomb_friction")) is is_best for k in bounds}
        device = found.device.replace(**{k: Exact(ends(getattr(found.device, k))[more[k]]) for k in bounds})
        assert zw.check(device, law.replace(stiffness=Exact(limit))).outcome == "passive"
        assert zw.check(device, law.replace(stiffness=Exact(1.03 * limit))).outcome != "passive"


def test_a_transmission_leaves_what_the_motor_feels() -> None:
    """As of a device without one, with c b₂/(c + b₂) more; nothing with the encoder at the handle."""
    bounds = {k: WIDE[k] for k in ("damping", "coulomb_friction", "delay")}
    rigid, wall = device_in(**bounds), zw.Wall(3.0)

    def over(given: zw.Transmission) -> OverRanges:
        return said(DeviceInRange(rigid.device.replace(transmission=given), rigid.ranges), wall)

    loose = over(zw.Transmission(handle_damping=5))
    assert loose.every == said(rigid, wall).every
    assert loose.best == said(rigid, wall).best
    stiff = over(zw.Transmission(damping="0.1", handle_damping="0.1"))
    more = device_in(**{**bounds, "damping": (0.063, 0.26)})
    assert stiff.every == said(more, wall).every
    assert over(zw.Transmission(encoder="handle")).every is None


def test_the_number_to_measure_first() -> None:
    """The one that binds; from the value that is told on nothing else need be known, just before it is."""
    found = device_in(
        damping=WIDE["damping"], coulomb_friction=WIDE["coulomb_friction"], delay=(0.0002, 0.0004)
    )
    wall = zw.Wall(60)
    over = said(found, wall)
    assert over.first is not None
    assert over.first.key == "damping"
    assert over.first.enough is not None
    enough = over.first.enough
    assert zw.check(found.device.replace(damping=zw.Interval(enough, 0.21)), wall).outcome == "passive"
    assert zw.check(found.device.replace(damping=Exact(0.98 * enough)), wall).outcome != "passive"
    friction = said(device_in(coulomb_friction=(1e-6, 0.4), damping=(0.2, 0.21)), wall).first
    assert friction is not None
    assert friction.key == "coulomb_friction"


@pytest.mark.parametrize(
    ("name", "stiffness"),
    [("moza-r9", "5"), ("omega.3", "300"), ("feetech-sts3215", "5"), ("dynamixel-mx-64", "1")],
)
def test_a_bound_is_the_same_number_at_both_places(name: str, stiffness: str) -> None:
    """What to measure first, and the largest stiffness, as the advice rounds them: to the safe side."""
    found = zw.catalogue.in_range(name)
    verdict = zw.check(found.device, zw.Wall(stiffness))
    rows = dict(over_ranges(found, zw.Wall(stiffness), verdict).rows())
    advised = " ".join(advice.text for advice in verdict.advice)
    ((first, least),) = re.findall(r"(\w+): if it is at least (.+?), this is", rows["measure first"])
    (most,) = re.findall(r"every device in the ranges: up to (.+?);", rows["stiffness"])
    assert re.search(rf"raise the (device )?{first} from \S+ \S+ to {least}( |$)", advised)
    assert f" to {most} " in f"{advised} "


def test_no_single_number_may_be_enough() -> None:
    """Then it is the one over whose range the stiffness grows most, and no value is told."""
    first = said(device_in(**WIDE), zw.Wall(150)).first
    assert first is not None
    assert (first.key, first.enough) == ("damping", None)
    assert first.times == pytest.approx(0.21 / 0.013, rel=0.01)


def test_nothing_is_left_to_measure() -> None:
    for stiffness, outcome in ((1, "passive"), (1e5, "active")):
        found, wall = device_in(**WIDE), zw.Wall(stiffness)
        assert zw.check(found.device, wall).outcome == outcome
        assert said(found, wall).first is None


def test_the_corner_that_is_told_is_the_worst() -> None:
    """Advice and numbers of an undecided verdict are those of the corner that asks for most."""
    verdict = zw.check(device_in(**WIDE).device, zw.Wall(60))
    assert verdict.outcome == "undecided"
    assert [float(verdict.device.exact(key)) for key in ("delay", "sample_period")] == [0.0031, 0.0017]
    advised = {a.parameter: a.to for a in verdict.advice}
    assert zw.check(device_in(**WIDE).device, zw.Wall(advised["stiffness"])).outcome == "passive"


def test_laws_without_a_stiffness() -> None:
    found = device_in(damping=WIDE["damping"])
    law = zw.PulseTransferFunction((3,), (1,))
    over = over_ranges(found, law, zw.check(found.device, law))
    assert (over.every, over.best, over.first) == (None, None, None)
    assert [name for name, _ in over.rows()] == ["ranges"]


def test_what_is_read_and_what_is_written() -> None:
    """Rows in the unit that was typed, a rate as one; the document in SI, with the reasons."""
    found = zw.catalogue.in_range("feetech-sts3215")
    wall = zw.Wall(5)
    with answers_in("deg"):
        rows = dict(said(found, wall).rows())
    assert "N·m/deg" in rows["stiffness"]
    assert "rate 50 … 1000 Hz" in rows["ranges"]
    document = said(found, wall).to_dict()
    assert document["stated"]["rate_Hz"]["low"] == 50
    assert "m1.json" in document["stated"]["damping_N_m_s_per_rad"]["why"]
    assert document["passive_for_every_device_stiffness_N_m_per_rad"] == pytest.approx(1.94, rel=0.01)
    assert document["measure_first"]["parameter"] == "damping"


def test_more_friction_never_hurts_whatever_the_law() -> None:
    """The same motion gives the same readings and forces: the hand pays Δb v² and Δf_c |v| more."""
    wall = zw.Wall(220, 0.06)
    laws = [wall, zw.render(wall, zw.rendering.FrictionCompensation(coulomb=0.02, viscous=0.01))]
    laws.append(zw.render(wall, zw.rendering.PassivityController(largest_damping="0.05")))
    draw = np.random.default_rng(5)
    path = zw.operators.PrescribedMotion(np.cumsum(draw.normal(0, 2e-4, 200)) + 0.0005)
    less = zw.Device(
        mass=0.05, damping=0.1, coulomb_friction=0.02, resolution=3e-5, rate="1 kHz", delay=0.0013
    )
    more = less.replace(damping=0.17, coulomb_friction=0.05)
    for law in laws:
        before, after = (zw.simulate(device, law, path, 0.199) for device in (less, more))
        np.testing.assert_array_equal(before["actuator_force"].values, after["actuator_force"].values)
        v = np.diff(path.positions) / 0.001
        paid = np.sum((0.07 * v**2 + 0.03 * np.abs(v)) * 0.001)
        gained = float(after["hand_work"].values[-1] - before["hand_work"].values[-1])
        assert gained == pytest.approx(paid, rel=1e-9)
