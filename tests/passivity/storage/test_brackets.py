"""`passive_limit`: proved on one side, refuted on the other, as close as asked for; and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from counted_device import device

import zwidth as zw
from zwidth import checker
from zwidth.passivity.bracket import passive_limit
from zwidth.passivity.storage import available_storage

BOUNDS = {"penetration": "0.001", "speed": "0.5"}


SPRING = device("0.16", "0.0165"), zw.Wall(300)
DAMPED = device("0.27", "0.027"), zw.Wall(300, "0.1")
DELAYED = device("0.46", "0.017", 1), zw.Wall(300)
LATE = device("0.46", "0.017", "0.3"), zw.Wall(300)
CONTACT = device("2.2", "0.24"), zw.HuntCrossley(20000, "1.5", 2)
DETENT = device("0.16", "0.0165"), zw.NonlinearSpring.detents(2, "0.001", "0.07")
SAMPLED = zw.PulseTransferFunction([30], [1, "-0.9"], "0.001")

LIMITS = {
    "stiffness": (SPRING, "stiffness", "N/m"),
    "stiffness beside damping": (DAMPED, "stiffness", "N/m"),
    "stiffness, delayed": (DELAYED, "stiffness", "N/m"),
    "stiffness, delayed by part of a sample": (LATE, "stiffness", "N/m"),
    "virtual damping": (DAMPED, "damping", "N*s/m"),
    "virtual damping, by its full name": (DAMPED, "environment.damping", "N*s/m"),
    "device damping": (DAMPED, "device.damping", "N*s/m"),
    "friction": (DAMPED, "coulomb_friction", "N"),
    "friction, delayed": (DELAYED, "device.coulomb_friction", "N"),
    "resolution": (DAMPED, "resolution", "m"),
    "sample period": (DAMPED, "sample_period", "s"),
    "rate": (DAMPED, "rate", "Hz"),
    "gain": (DETENT, "gain", "1"),
    "contact": (CONTACT, "stiffness", "N/m^1.5"),
    "dissipation": (CONTACT, "dissipation", "s/m"),
    "friction of a contact": (CONTACT, "coulomb_friction", "N"),
}


def at(loop, parameter, value):
    """The loop with the parameter at a value, written out by hand."""
    held, law = loop
    key = parameter.rpartition(".")[2]
    if key == "gain":
        forces = [Fraction(str(value)) * f.fraction for f in law.forces]
        return held, zw.NonlinearSpring(law.positions, forces)
    if key == "rate":
        return held.replace(sample_period=1 / Fraction(str(value))), law
    if parameter in ("stiffness", "damping", "environment.damping", "dissipation"):
        return held, law.replace(**{key: str(value)})
    return held.replace(**{key: str(value)}), law


@pytest.mark.parametrize("bounds", [BOUNDS, {"penetration": "0.0005", "speed": "0.2"}])
@pytest.mark.parametrize("name", LIMITS)
def test_both_sides_are_evidence(name, bounds):
    """At the first value the loop is proved passive again, at the other a motion gains from it."""
    loop, parameter, unit = LIMITS[name]
    bracket = passive_limit(*loop, parameter, **bounds, tolerance=0.02)
    assert bracket.unit == unit
    assert bracket.parameter.endswith(parameter)
    assert bracket.relative_width <= 0.02
    safer = parameter.endswith(("coulomb_friction", "device.damping", "rate"))
    assert (bracket.proved_passive > bracket.proved_active) is safer
    assert bracket.certificate.verify()
    assert bracket.witness.verify()
    if parameter not in ("resolution", "sample_period", "rate"):  # they change how many counts the bounds are
        passive, active = (
            available_storage(*at(loop, parameter, v), **bounds)
            for v in (bracket.proved_passive, bracket.proved_active)
        )
        assert (passive.outcome, active.outcome) == ("passive", "active")
    held, law = at(loop, parameter, bracket.proved_passive)
    proof = bracket.certificate.to_dict()
    units = {"damping": "N_s_per_m", "coulomb_friction": "N", "resolution": "m", "sample_period": "s"}
    for key, written in units.items():
        assert Fraction(proof["loop"][f"{key}_{written}"]) == held.exact(key)
    if proof["kind"] != "storage":  # no worse than what covers every hand
        assert proof["kind"] in ("spring", "contact")
        assert bracket.proved_passive == bracket.every_hand[0]
    elif law.linear:
        taps = sum(Fraction(c) for c in proof["law"]["taps_N_per_m"])
        assert taps == law.stiffness.fraction
        motion = bracket.witness.to_dict()
        other = at(loop, parameter, bracket.proved_active)[1]
        assert sum(Fraction(c) for c in motion["law"]["taps_N_per_m"]) == other.stiffness.fraction


@pytest.mark.parametrize("tolerance", [0.1, 0.004])
@pytest.mark.parametrize("name", ["stiffness", "stiffness beside damping", "friction", "virtual damping"])
def test_as_close_as_asked_for(name, tolerance):
    """The closed form, for every hand, lies within; and the bracket is no wider than the tolerance."""
    (held, law), parameter, _ = LIMITS[name]
    b, f, step, t = (held.exact(k) for k in ("damping", "coulomb_friction", "resolution", "sample_period"))
    k, v = law.stiffness.fraction, law.damping.fraction
    exact = {
        "stiffness": min(2 * (b - v) / t, 2 * (f / step - v / t)),
        "coulomb_friction": (k / 2 + v / t) * step,
        "damping": min(b - k * t / 2, (f / step - k / 2) * t),
    }[parameter]
    bracket = passive_limit(held, law, parameter, tolerance=tolerance)
    assert bracket.hand == "every hand"
    assert bracket.relative_width <= tolerance
    low, high = sorted((bracket.proved_passive, bracket.proved_active))
    assert low <= exact <= high
    assert bracket.every_hand == (bracket.proved_passive, bracket.proved_active)


@pytest.mark.parametrize("effort", [0, 0.01, 0.05, 0.2])
@pytest.mark.parametrize("name", ["stiffness, delayed", "stiffness beside damping", "friction"])
def test_little_effort(name, effort):
    """What was found so far is returned, each side with its evidence or missing altogether."""
    loop, parameter, _ = LIMITS[name]
    bracket = passive_limit(*loop, parameter, penetration="0.002", speed="0.9", effort=effort)
    assert (bracket.proved_passive is None) is (bracket.certificate is None)
    assert (bracket.proved_active is None) is (bracket.witness is None)
    assert bracket.certificate is None or bracket.certificate.verify()
    assert bracket.witness is None or bracket.witness.verify()
    assert bracket.describe()
    assert bracket.to_dict()["evaluations"] == bracket.evaluations


def test_no_effort_with_a_law_without_a_transfer_function():
    """One that no closed form decides: nothing decided is an answer."""
    assert passive_limit(*CONTACT, "stiffness", **BOUNDS, effort=0).proved_passive is None


CLOSED = {
    "stiffness": {
        "spring": zw.Wall(200),
        "damped": zw.Wall(150, "0.1"),
        "clamped": zw.Wall(150, "0.1", clamped=True),
        "solid": zw.StandardLinearSolid(100, 100, 1),
        "window": zw.Wall(100, "0.05", zw.rendering.Window(4)),
        "behind a force bounding": zw.render(zw.Wall(100), zw.rendering.ForceBounding()),
    },
    "gain": {
        "detents": zw.NonlinearSpring.detents(4, "0.004", "0.2"),
        "stop": zw.NonlinearSpring([0, "0.01", "0.02"], [0, 1, 4]),
        "pulling in its middle": zw.NonlinearSpring(["-0.01", 0, "0.01", "0.02"], [-1, 1, "-0.2", 1]),
    },
}


@pytest.mark.parametrize("delay", ["0", "0.3", "1"])
@pytest.mark.parametrize(
    ("parameter", "name"), [(key, name) for key, laws in CLOSED.items() for name in laws]
)
def test_what_check_proves_in_closed_form_is_on_the_proved_side(parameter, name, delay):
    """Whatever law and delay, without work to speak of; and the other side is no nearer."""
    loop, law = device("0.6", "0.03", delay), CLOSED[parameter][name]
    if zw.check(loop, law, iterate=False).outcome != "passive":
        return
    bracket = passive_limit(loop, law, parameter, effort=0.01)
    now = 1.0 if parameter == "gain" else float(law.met.stiffness)
    assert bracket.every_hand[0] >= now
    assert bracket.proved_passive >= now
    assert bracket.certificate.verify()
    assert bracket.proved_active is None or bracket.proved_active > now


GROWING = {
    "faster": [{"penetration": "0.001", "speed": s} for s in ("0.1", "0.3", "0.6", "0.9")],
    "deeper": [{"penetration": p, "speed": "0.3"} for p in ("0.0002", "0.0005", "0.001", "0.002")],
}


@pytest.mark.parametrize("way", GROWING)
@pytest.mark.parametrize(
    "loop",
    [
        (device("0.1", "0.04"), zw.Wall(300)),
        DAMPED,
        (device("0.2", "0.05"), zw.Wall(200, "0.1", clamped=True)),
        (device("0.4", "0.05", 1), zw.Wall(200)),
    ],
    ids=["spring", "damped", "clamped", "delayed"],
)
def test_a_faster_or_deeper_hand_never_admits_more(loop, way):
    """A hand with wider bounds can do all that one with narrower bounds can."""
    brackets = [passive_limit(*loop, **bounds) for bounds in GROWING[way]]
    for narrow, wide in pairwise(brackets):
        assert wide.proved_passive < narrow.proved_active
        assert wide.proved_passive <= narrow.proved_passive * 1.01
    everyone = brackets[0].every_hand[0]
    assert all(bracket.proved_active > everyone for bracket in brackets)


def test_progress_is_told():
    told = []
    bracket = passive_limit(*SPRING, **BOUNDS, progress=lambda done, total: told.append((done, total)))
    counts = [done for done, _ in told]
    assert counts == sorted(counts)
    assert counts[-1] == bracket.evaluations
    assert all(done <= total for done, total in told)


PADDLE = zw.catalogue.device("haptic-paddle"), zw.Wall(200)
IIR = zw.rendering.VelocityFilter([1, 0, 0], [1, "-0.5", "0.06"])


@pytest.mark.parametrize(
    ("loop", "arguments", "said"),
    [
        ((device(1, 1, resolution=0), zw.Wall(300)), BOUNDS, "ideal encoder"),
        ((device(1, 1, "0.4"), zw.StandardLinearSolid(100, 200, 0.5)), BOUNDS, "whole samples"),
        ((device(1, 1), zw.Wall(300, 1, IIR)), BOUNDS, "remember"),
        ((device(1, 1), zw.Wall(300, 1, zw.rendering.Window(9))), BOUNDS, "remembers 9 readings"),
        ((device(1, 1), zw.Wall((200, 300))), BOUNDS, "not one number"),
        ((device((1, 2), 1), zw.Wall(300)), BOUNDS, "no single value"),
        ((device(1, (1, 2)), zw.Wall(300)), BOUNDS, "no single value"),
        (SPRING, {"penetration": 0, "speed": 1}, "penetration must be > 0"),
        (SPRING, {"penetration": "-0.001", "speed": 1}, "penetration must be > 0"),
        (SPRING, {"penetration": "1 s", "speed": 1}, "penetration is in m; got"),
        (SPRING, {"penetration": "0.001", "speed": 0}, "speed must be > 0"),
        (SPRING, {"penetration": "0.001", "speed": float("nan")}, "finite"),
        (CONTACT, {"penetration": "0.8", "speed": 100, "effort": 0}, "too many"),
        (SPRING, {"tolerance": 0}, "tolerance must be"),
        (SPRING, {"tolerance": 1}, "tolerance must be"),
        (SPRING, {"tolerance": float("nan")}, "tolerance must be"),
        (SPRING, {"tolerance": "fine"}, "tolerance"),
        (SPRING, {"seconds": "60"}, "seconds"),
        (SPRING, {"effort": -1}, "effort must be a number ≥ 0"),
        (SPRING, {"force_limit": True}, "no force_limit"),
        (SPRING, {"force_resolution": True}, "no force_resolution"),
        (
            (device(1, 1, force_resolution=1), zw.Maxwell(300, 1)),
            {"force_resolution": True},
            "converter steps cannot be counted in",
        ),
        (SPRING, {"parameter": "colour"}, "no parameter 'colour'"),
        (SPRING, {"parameter": "device.stiffness"}, "no parameter"),
        (SPRING, {"parameter": ""}, "no parameter"),
        (CONTACT, {"parameter": "exponent"}, "no parameter 'exponent'"),
        (CONTACT, {"penetration": 1, "speed": "0.1"}, "9000 counts deep"),
        (SPRING, {"parameter": "clamped"}, "not one number"),
        ((SPRING[0], SAMPLED), {"parameter": "rate"}, "made for one sample period, so no other rate"),
        ((SPRING[0], SAMPLED), {"parameter": "sample_period"}, "so no other sample period can be asked for"),
        (SPRING, {"parameter": "velocity_filter"}, "not one number"),
        (SPRING, {"parameter": "motion"}, "no parameter"),
        (SPRING, {"parameter": None}, "parameter"),
        (PADDLE, {"parameter": "mass"}, "mass plays no part.*moves every mass"),
        (PADDLE, {"parameter": "device.mass", "penetration": "1e-3", "speed": "0.1"}, "mass plays no part"),
        (PADDLE, {"parameter": "current_limit"}, "every force at once"),
        (PADDLE, {"parameter": "force_limit"}, "counted in: give force_limit=True, --count-force-limit"),
        (("paddle", zw.Wall(300)), {}, "Device"),
        ((device(1, 1), "wall"), {}, "an environment is"),
    ],
)
def test_what_it_refuses(loop, arguments, said):
    with pytest.raises(zw.InputError, match=said) as error:
        passive_limit(*loop, **arguments)
    assert "\n" not in str(error.value)


def test_virtual_damping_below_zero():
    bracket = passive_limit(device("0.3", "0.03"), zw.Wall(300, "-0.05"), "damping", **BOUNDS)
    assert bracket.proved_active > bracket.proved_passive > 0


@pytest.mark.parametrize("name", ["stiffness", "stiffness beside damping", "friction", "virtual damping"])
@pytest.mark.parametrize("speed", ["0.123", "0.237", "0.4599"])
def test_a_speed_between_two_counts_is_bounded_as_given(name, speed):
    """The proof is of this speed, not of the next whole count a sample: both sides meet as closely."""
    loop, parameter = LIMITS[name][:2]
    bracket = passive_limit(*loop, parameter, penetration="0.0012", speed=speed)
    assert bracket.relative_width < 0.01
    assert f"up to {speed} m/s" in bracket.hand
    assert bracket.witness.peak_speed <= float(speed)


def test_a_proof_of_slow_hands_is_none_of_faster_ones():
    """The longest move in the certificate is the one that was proved, to the part of a count."""
    found = available_storage(device("0.1", "0.04"), zw.Wall(395), penetration="0.0012", speed="0.237")
    document = found.certificate.documents[0]
    assert document["domain"]["largest_move_counts"] == "2.37"
    assert "2.37 counts a sample" in checker.verify(document).reason
    for counts, valid in (("2.25", True), ("2.5", False), (3, False), (0, False), (-2, False)):
        domain = {**document["domain"], "largest_move_counts": counts}
        assert checker.verify({**document, "domain": domain}).valid == valid, counts


def test_the_gain_of_a_transfer_function_is_bracketed():
    law = zw.PulseTransferFunction([100, -30], [1, "-0.2"])
    ideal = device("0.15", "0.1", resolution=0)
    bracket = passive_limit(ideal, law, "gain", tolerance=1e-4)
    assert (bracket.parameter, bracket.unit) == ("environment.gain", "1")
    assert bracket.proved_passive <= zw.check(ideal, law).max_gain <= bracket.proved_active
    assert bracket.relative_width < 1e-4
    wall = passive_limit(ideal, zw.Wall(100), "gain", tolerance=1e-4)
    assert wall.proved_passive <= zw.check(ideal, zw.Wall(100)).max_stiffness / 100 <= wall.proved_active


def test_bounds_on_the_hand_may_carry_their_unit():
    told = zw.limit(*SPRING, penetration="1 mm", speed="500 mm/s")
    assert told.proved_passive == zw.limit(*SPRING, **BOUNDS).proved_passive
    values = zw.available_storage(*SPRING, penetration="1 mm", speed="500 mm/s")
    assert values.scope == zw.available_storage(*SPRING, **BOUNDS).scope
    with pytest.raises(zw.InputError, match='speed is in m/s; got "2 mm"'):
        zw.limit(*SPRING, speed="2 mm")


def test_a_bracket_says_what_was_found_as_a_verdict_does():
    found = zw.limit(*SPRING)
    assert (found.outcome, found.claim) == ("bracketed", found.describe())
    assert replace(found, proved_active=None).outcome == "one side"
    assert replace(found, proved_active=None, proved_passive=None).outcome == "undecided"
