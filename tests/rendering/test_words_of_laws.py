"""What every law of a chain says of itself, and what it refuses."""

import control
import numpy as np
import pytest
from prescribed import DEVICE, PERIOD, device, touched

import zwidth as zw
from zwidth.model.rendering import (
    AdaptiveWindow,
    BrakingPulse,
    CrossingCorrection,
    Damper,
    Dither,
    DualRate,
    EnergyBounding,
    EnergyTank,
    EventTransient,
    Extrapolation,
    ForceBounding,
    HalfSamplePrediction,
    Held,
    Hysteresis,
    Kalman,
    ParallelController,
    PassiveLeap,
    PassivityController,
    PoleMatched,
    RateTerm,
    Saturation,
    SlewLimit,
    TickTime,
    WindowedController,
)

BARE = zw.Device(damping=1, rate=1000)
UNDAMPED = device(damping=0)
WALL = zw.Wall(300)
NO_SURFACE = zw.PulseTransferFunction([310, -250], [1, 0])
FINGER = {"finger_mass": 0.011, "finger_stiffness": 430, "finger_damping": 1.3, "finger_position": 0.0037}
COUPLING = zw.VirtualCoupling
WINDOW = "on adaptive window of up to 15 samples within one count, end fit"
T = device().exact("sample_period")

BAD = [
    (EnergyTank, {"level": -1}, "level must be > 0 J, got -1: it is the energy that the tank"),
    (EnergyTank, {"refill": 0}, "refill must be > 0, got 0: without it the tank never fills"),
    (BrakingPulse, {"mass": 0}, "mass must be > 0"),
    (BrakingPulse, {"limit": -1}, "limit must be > 0"),
    (BrakingPulse, {"velocity": 3}, "velocity is AdaptiveWindow"),
    (EventTransient, {"kind": "square"}, "kind is one of 'decaying', 'fixed'"),
    (EventTransient, {"kind": "fixed", "frequency": 100}, "frequency is not of the fixed transient"),
    (EventTransient, {"kind": "acceleration", "amplitude": 1}, "amplitude is not of the acceleration"),
    (EventTransient, {"kind": "acceleration", "record": [1], "duration": 1}, "either record or duration"),
    (EventTransient, {"kind": "acceleration", "record": []}, "from 1 to 10000 samples, got 0"),
    (EventTransient, {"kind": "acceleration", "record": ["a"]}, "record is one deceleration"),
    (EventTransient, {"time_constant": 0}, "time_constant must be > 0"),
    (ForceBounding, {"encoder": "real"}, "encoder is one of 'counted', 'ideal', got 'real'"),
    (ForceBounding, {"resets": 1}, "resets is True to forget"),
    (Hysteresis, {}, "give either force .* got neither"),
    (Hysteresis, {"force": 1, "fastest": 1}, "give either force .* got both"),
    (Hysteresis, {"force": -1}, "force must be > 0"),
    (Hysteresis, {"force": 1, "stiffness": 0}, "stiffness must be > 0"),
    (Hysteresis, {"fastest": 0}, "fastest must be > 0"),
    (Hysteresis, {"force": 1, "clamped": "yes"}, "clamped is True for a sum"),
    (SlewLimit, {"rate": 0}, "rate must be > 0"),
    (Saturation, {"limit": -1}, "limit must be > 0"),
    (Dither, {"amplitude": 0}, "amplitude must be > 0"),
    (Dither, {"amplitude": 1, "kind": "white"}, "kind is one of 'alternating', 'random'"),
    (Dither, {"amplitude": 1, "kind": "random", "seed": 0}, "seed must be > 0"),
    (Dither, {"amplitude": 1, "kind": "random", "seed": 2**31 - 1}, "seed is a whole number"),
    (Dither, {"amplitude": 1, "kind": "random", "seed": 1.5}, "seed is a whole number"),
    (ParallelController, {"observer": "other"}, "observer is one of 'sampled', 'published'"),
    (ParallelController, {"largest_mobility": 0}, "largest_mobility must be > 0"),
    (ParallelController, {"largest_mobility": "none"}, "largest_mobility is in m/N/s; got .none.: expected"),
    (ParallelController, {"largest_velocity": -1}, "largest_velocity must be > 0"),
    (ParallelController, {"weakest": "x"}, "weakest is in N; got .x.: expected a number"),
    (ParallelController, {"resets": 1}, "resets is True to count anew in each touch"),
    (ParallelController, {"ceiling": -1}, "ceiling must be ≥ 0"),
    (PassiveLeap, {"stiffness": 0}, "stiffness must be > 0, got 0: the spring keeps the energy"),
    (PassiveLeap, {"resets": 2}, "resets is True to forget credit where there was no"),
    (PassivityController, {"observer": "other"}, "observer is one of"),
    (PassivityController, {"reference": 1}, "reference is one of"),
    (PassivityController, {"largest_damping": 0}, "largest_damping must be > 0"),
    (PassivityController, {"largest_damping": "none"}, "largest_damping is in .*; got .none."),
    (PassivityController, {"largest_force": "unlimited"}, "largest_force is in N; got .unlim"),
    (PassivityController, {"largest_force": -1}, "largest_force must be > 0"),
    (PassivityController, {"slowest": float("nan")}, "slowest"),
    (Extrapolation, {"samples": -1}, "samples must be ≥ 0, got -1"),
    (HalfSamplePrediction, {"mass": 0}, "mass must be > 0, got 0"),
    (HalfSamplePrediction, {"finger_mass": -1}, "finger_mass must be ≥ 0"),
    (HalfSamplePrediction, {"finger_position": "deep"}, "finger_position is in m; got .deep.: exp"),
    *((RateTerm, {"time_constant": bad}, "time_constant") for bad in (0, -1, "soon")),
    *((Held, {"samples": bad}, "samples is a whole number of samples, at l") for bad in (0, 1.5, True, "2")),
    *((DualRate, {"samples": bad}, "samples is a whole number of sampl") for bad in (0, 1.5, True, "2")),
    (DualRate, {"samples": 2, "slope": -3}, "slope must be > 0, got -3: it is that of a local spring"),
    (DualRate, {"samples": 2, "updates": "smooth"}, "updates is one of 'continuous', 'jump', got 'smooth'"),
    (Damper, {"damping": -1}, "damping must be ≥ 0"),
    (Damper, {"damping": 1, "velocity": zw.rendering.Window(3)}, "velocity is AdaptiveWindow"),
    (Damper, {"damping": 1, "clamped": 1}, "clamped is True for a sum"),
    (AdaptiveWindow, {"noise": -1e-6}, "noise must be ≥ 0"),
    (AdaptiveWindow, {"longest": 0}, "longest must be > 0"),
    (AdaptiveWindow, {"longest": 2.5}, "whole number of samples"),
    (AdaptiveWindow, {"longest": 1001}, "whole number of samples"),
    (AdaptiveWindow, {"fit": "worst"}, "fit is one of 'end', 'best'"),
    (Kalman, {"acceleration": 0}, "acceleration must be > 0"),
    (WindowedController, {"window": 0}, "window is a whole number of samples, at least 1"),
    (WindowedController, {"window": "2.5"}, "window is a whole number of samples"),
    (WindowedController, {"window": 1001}, "window is 1000 samples at most, got 1001"),
    (WindowedController, {"slowest": 0}, "slowest must be > 0"),
    (WindowedController, {"share": "1.01"}, "share must be ≤ 1, got 1.01"),
    (WindowedController, {"share": 0}, "share must be > 0"),
    (WindowedController, {"largest_damping": -1}, "largest_damping must be > 0"),
    (WindowedController, {"largest_damping": "unlimited"}, r"largest_damping is in N\*s/m; got .unlimited."),
    (COUPLING, {"stiffness": -1, "damping": 2, "environment": zw.Wall(3)}, "stiffness must be ≥ 0"),
    (
        COUPLING,
        {"stiffness": 1, "damping": "x", "environment": zw.Wall(3)},
        r"damping is in N\*s/m; got .x.: expected a number",
    ),
    (COUPLING, {"stiffness": 1, "damping": 2, "environment": None}, "an environment is"),
    (COUPLING, {"stiffness": 1, "damping": 2, "environment": control.tf([1], [1, 2])}, "needs a discretizat"),
]


@pytest.mark.parametrize(("law", "options", "said"), BAD)
def test_an_option_that_cannot_be_is_refused(law, options, said):
    with pytest.raises(zw.InputError, match=said):
        law(**options)


@pytest.mark.parametrize(
    ("law", "said", "where"),
    [
        (EnergyBounding(), "energy bounding pays for the force with the device's damping", UNDAMPED),
        (EnergyTank(), "has no force_limit or the environment no stiffness; give level", device()),
        (EnergyTank(level=1), "largest_damping pays for the force with the device's damping", UNDAMPED),
        (ForceBounding(), "force bounding pays for the force with the device's damping", UNDAMPED),
        (PassiveLeap(), "stiffness has no default here", NO_SURFACE),
        (PassiveLeap(), "a passive leap pays for the force with the device's damping", UNDAMPED),
        (DualRate(samples=2), "a local spring without slope pays for the force with", UNDAMPED),
        (PassivityController(), 'has none: nothing would pay .* or largest_damping="unl', UNDAMPED),
        (WindowedController(), "largest_damping was not given", UNDAMPED),
        (BrakingPulse(), "mass was not given", BARE),
        (BrakingPulse(), "no surface", NO_SURFACE),
        (EventTransient(), "no surface", NO_SURFACE),
        (EventTransient(frequency=500), "below half the rate, 500 Hz", DEVICE),
        (EventTransient(duration=11), "from 1 to 10000 samples", DEVICE),
        (EventTransient(duration=PERIOD), "no amplitude of this transient", DEVICE),
        (Hysteresis(fastest=1), "has no K", zw.Wall(0)),
        (Hysteresis(1), "has no K", zw.HuntCrossley(100)),
        (SlewLimit(), "rate was not given .* motor_inductance", BARE),
        (Saturation(), "limit was not given .* force_limit", BARE),
        (Saturation(), "force_limit, which is not certain", DEVICE.replace(force_limit=(8, 9))),
        (Dither(), "amplitude was not given .* force_resolution", BARE),
        (HalfSamplePrediction(), "the device has none: give mass", BARE),
        (HalfSamplePrediction(finger_stiffness=1e9), "do not tell a velocity", DEVICE),
        (HalfSamplePrediction(finger_damping=1e9), "do not tell a velocity", DEVICE),
        (CrossingCorrection(), "needs a Wall, got Maxwell", zw.Maxwell(3, 4)),
        (PoleMatched(), "needs a Wall, got Maxwell", zw.Maxwell(3, 4)),
        (PoleMatched(), "swings half a turn", zw.Wall(1e6)),
    ],
)
def test_a_device_or_an_environment_that_does_not_go_with_it_is_refused(law, said, where):
    there = {"device": where} if isinstance(where, zw.Device) else {"environment": where}
    with pytest.raises(zw.InputError, match=said):
        touched([0.0, 0.001], law, **{"environment": WALL, **there})


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: zw.render(WALL), "no law was given"),
        (lambda: zw.render(WALL, zw.Wall(2)), "zwidth.rendering"),
        (lambda: zw.render("wall", PassivityController()), "environment"),
        (lambda: COUPLING((1, 2), 2, zw.Wall(3)).pulse_transfer_function(T), "interval"),
        (lambda: COUPLING(0, 0, zw.Wall(0)).pulse_transfer_function(T), "add up to zero"),
        (lambda: COUPLING(0, -3, zw.Wall(3000)).pulse_transfer_function(T), "still to come"),
    ],
)
def test_what_is_no_chain_and_no_coupling_is_refused(make, said):
    with pytest.raises(zw.InputError, match=said):
        make()


@pytest.mark.parametrize(
    "law", [WindowedController(largest_damping="0.1"), PassivityController(largest_damping="0.1")]
)
def test_a_limit_of_its_own_needs_no_damping(law):
    assert np.isfinite(touched([0.0, 0.001], law, environment=WALL, device=UNDAMPED).commanded_force).all()


def test_the_branch_of_a_maxwell_body_is_the_spring_of_reference():
    touched([0.0, 0.001], PassivityController(reference="spring"), environment=zw.Maxwell(300, 1))


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (EnergyTank(level="0.002", refill=3), "energy tank (to 2 mJ, refill 3 N·m·s/rad per J)"),
        (
            EventTransient("fixed", amplitude=2),
            f"transient at entry (fixed, 2 N·m·s/rad, for 10 ms) {WINDOW}",
        ),
        (
            Hysteresis(fastest=3, stiffness=5, clamped=True),
            "hysteresis of the width for 3 rad/s, spring of 5 N·m/rad, never pulls",
        ),
        (SlewLimit(5), "slew limit of 5 N·m/s"),
        (SlewLimit(), "slew limit of the motor"),
        (Dither(2), "alternating dither of 2 N·m"),
        (Dither(kind="random"), "random dither of part of a converter step"),
        (Saturation(3), "saturation at 3 N·m"),
        (Saturation(), "saturation at the force limit"),
        (AdaptiveWindow(1e-4), "adaptive window of up to 15 samples within 100 µrad, end fit"),
        (Kalman(30), "Kalman filter for 30 (rad/s²)/√Hz"),
        (TickTime(), "time between ticks"),
        (
            CrossingCorrection(throughout=True, finger_stiffness=2),
            "crossing correction (finger 2 N·m/rad, throughout)",
        ),
        (
            zw.FrictionCompensation(coulomb="0.4", viscous="0.7", speed="0.03"),
            "compensation of friction by 0.4 N·m tanh(v/(0.03 rad/s)) and 0.7 N·m·s/rad of its own speed",
        ),
    ],
)
def test_described_on_a_rotary_device(law, said):
    assert law.describe("rotary") == said


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (zw.render(WALL, EnergyBounding()), "wall, 300 N/m, with energy bounding"),
        (zw.render(WALL, ForceBounding()), "wall, 300 N/m, with force bounding (counted encoder)"),
        (
            zw.render(WALL, Extrapolation(), HalfSamplePrediction(mass="0.3", **FINGER)),
            "wall, 300 N/m, with extrapolated by 0.5 samples, half-sample prediction "
            "(mass 0.3 kg, finger 0.011 kg, 430 N/m, 1.3 N·s/m)",
        ),
        (
            zw.render(WALL, Held(samples=15), DualRate(samples=2, slope=70)),
            "wall, 300 N/m, with updated every 15 samples, "
            "local spring (updated every 2 samples, slope 70 N/m, continuous updates)",
        ),
        (
            BrakingPulse(2, 3, Kalman()),
            "braking pulse that stops 2 kg, at most 3 N on Kalman filter for a count in ten samples",
        ),
        (EventTransient(), f"transient at entry (decaying, 100 Hz, 10 ms) {WINDOW}"),
        (
            EventTransient("acceleration", record=[1, 2]),
            f"transient at entry (acceleration, record of 2 samples) {WINDOW}",
        ),
        (Hysteresis("0.2"), "hysteresis of ±0.2 N"),
        (PassiveLeap(stiffness=5, resets=True), "passive leap (a spring of 5 N/m, resets)"),
        (PoleMatched(), "poles matched (no finger)"),
        (Damper(2, TickTime(), clamped=True), "damper of 2 N·s/m on time between ticks, never pulls"),
        (
            zw.FrictionCompensation(coulomb="0.4"),
            "compensation of friction by 0.4 N in the direction of motion",
        ),
        (zw.FrictionCompensation(), "compensation of friction by nothing"),
        (
            COUPLING(820, 2, COUPLING(700, 1, zw.Maxwell(3, 4))),
            "virtual coupling, 820 N/m and 2 N·s/m, before virtual coupling, 700 N/m and 1 N·s/m, before "
            "Maxwell body, (3 N/m in series with 4 N·s/m), discretization backward",
        ),
    ],
)
def test_described_on_a_linear_device(law, said):
    assert law.describe() == said
