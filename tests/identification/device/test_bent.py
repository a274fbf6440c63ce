"""Friction that bends or differs by direction: what is promised lies below it, as far as it was seen."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from recorded_strokes import recorded as recorded_strokes
from recordings import paddle

import zwidth as zw
from zwidth.cli.main import main
from zwidth.model.specification.read import load_device
from zwidth.quantity.exact import ends

Array = NDArray[np.float64]
PERIOD, COUNT, MASS = 1e-3, 22.4e-6, 0.036


class Law(NamedTuple):
    """Friction by speed, and its slope, into the wall and out of it."""

    friction: Callable[[Array], tuple[Array, Array]]
    slope: Callable[[float], float]


def _falling(v: Array) -> Array:
    return 0.12 + 0.25 * v / (1 + v / 0.5)


def _stribeck(v: Array) -> Array:
    return 0.12 + 0.15 * v + 0.06 * np.exp(-((v / 0.06) ** 2))


def _one_way(v: Array) -> tuple[Array, Array]:
    return 0.12 + 0.25 * v, _falling(v)


LAWS = {
    "falling": Law(lambda v: (_falling(v), _falling(v)), lambda v: 0.25 / (1 + v / 0.5) ** 2),
    "Stribeck": Law(lambda v: (_stribeck(v), _stribeck(v)), lambda v: 0.15),
    "falling one way": Law(_one_way, lambda v: 0.25 / (1 + v / 0.5) ** 2),
}


def wandering(
    rng: np.random.Generator, waves: int, fastest: float, deviation: float
) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of a minute of a hand."""
    omega, phase = 2 * np.pi * rng.uniform(0.3, fastest, waves)[:, None], rng.uniform(0, 6.28, waves)[:, None]
    amplitude = rng.normal(size=waves)[:, None]
    angle = omega * np.arange(60_000) * PERIOD + phase
    x = (amplitude * np.sin(angle)).sum(axis=0)
    v = (amplitude * omega * np.cos(angle)).sum(axis=0)
    a = -(amplitude * omega**2 * np.sin(angle)).sum(axis=0)
    scale = deviation / x.std()
    return x * scale, v * scale, a * scale


def identified(x: Array, force: Array) -> zw.identification.Identified:
    position = np.floor(x / COUNT) * COUNT
    return zw.identify(
        zw.Log.from_arrays(position=position, hand_force=force, sample_period=PERIOD, resolution=COUNT)
    )


@cache
def found(name: str, seed: int) -> zw.identification.Identified:
    """Of bent friction, with white noise of 0.05 N on the load cell."""
    rng = np.random.default_rng(seed)
    x, v, a = wandering(rng, 10, 3.5, 0.015)
    into, out = LAWS[name].friction(np.abs(v))
    return identified(x, MASS * a + np.where(v > 0, into, out) * np.sign(v) + 0.05 * rng.normal(size=v.size))


@cache
def two_ways(seed: int, inward: float, outward: float) -> zw.identification.Identified:
    """Of the paddle with another damping in each direction, with white noise of 0.1 N on the load cell."""
    x, v, a = wandering(np.random.default_rng(seed), 12, 4.0, 0.02)
    force = MASS * a + np.where(v > 0, inward, outward) * v + 0.15 * np.sign(v)
    return identified(x, force + 0.1 * np.random.default_rng(seed + 1000).normal(size=x.size))


def promised(result: zw.identification.Identified) -> tuple[float, float]:
    """The lower ends of b and f_c, each with 95 %."""
    device = result.device(0.9)
    return float(ends(device.damping)[0]), float(ends(device.coulomb_friction)[0])


@pytest.mark.parametrize("name", ["falling", "falling one way"])
def test_no_more_is_promised_than_the_slope_at_the_largest_speed(name):
    """Of 12 minutes two at most promise more, at 95 % each; by a straight line all do."""
    results = [found(name, seed) for seed in range(12)]
    slopes = [LAWS[name].slope(result.speed) for result in results]
    lines = [
        min(result.directions.least(0.9), result.estimates["damping"].interval(0.9)[0]) for result in results
    ]
    assert all(line > slope for line, slope in zip(lines, slopes, strict=True))
    assert sum(promised(r)[0] > slope for r, slope in zip(results, slopes, strict=True)) <= 2


def test_a_stribeck_bump_is_not_taken_for_damping():
    """A parabola without a bump says more than there is; with it, two of 12 at most, and not much less."""
    results = [found("Stribeck", seed) for seed in range(12)]
    share = [promised(result)[0] / 0.15 for result in results]
    assert sum(s > 1 for s in share) <= 2
    assert np.median(share) > 0.6
    assert sum(result.shows("Stribeck friction") for result in results) >= 10
    assert all(result.estimates["slow"].value > 0 for result in results if "slow" in result.estimates)


@pytest.mark.parametrize("name", list(LAWS))
def test_the_line_promised_is_below_friction(name):
    """At every speed up to that seen, in the mean of both directions, another speed in each."""
    over = 0
    for seed in range(12):
        result = found(name, seed)
        b, f_c = promised(result)
        v = np.linspace(1e-6, result.speed, 200)
        into, out = LAWS[name].friction(v)
        over += f_c > (np.min(into - b * v) + np.min(out - b * v)) / 2
        assert f_c > 0.8 * 0.12
    assert over <= 2


def test_a_bend_is_said_with_the_slope_and_the_speed():
    result = found("falling", 0)
    (finding,) = [f for f in result.findings if f.kind == "bent friction"]
    assert "its slope is" in finding.text
    best = result.friction_curve(0.9).best(PERIOD, COUNT)
    assert promised(result) == (float(best.damping), float(best.coulomb_friction))


def test_a_claim_names_the_speed_up_to_which_friction_was_seen(tmp_path):
    result = found("Stribeck", 1)
    result.save(tmp_path / "mine.toml", 0.9)
    device = load_device([tmp_path / "mine.toml"], {})
    verdict = zw.check(device, zw.Wall(100))
    assert device.friction_speed <= result.speed
    speed = f"{float(device.friction_speed):.6g} m/s"
    assert f"if friction beyond {speed}, where it was not measured" in verdict.claim
    assert any(f"it was measured up to {speed}" in line for line in verdict.assumptions)
    assert verdict.scope.to_dict()["friction_speed_m_per_s"] == pytest.approx(result.speed, rel=1e-5)
    row = zw.render(zw.Wall(2000), zw.rendering.ForceBounding())
    single = device.replace(mass="0.0357", damping="0.14", coulomb_friction="0.12")
    for answer in (
        zw.available_storage(single, zw.Wall(100), speed=0.3, penetration=0.0003),
        zw.formulas.check_bounding(single, row),
        zw.stability.tolerated_activity(single, zw.Wall(100)),
    ):
        assert f"if friction beyond {speed}" in answer.claim
    everywhere = zw.check(device.replace(friction_speed=None), zw.Wall(100))
    assert "friction beyond" not in everywhere.claim
    assert "friction_speed_m_per_s" not in everywhere.scope.to_dict()


def test_the_speed_is_that_of_the_strokes():
    """A quarter of the strokes each way, or 32 of them, have a quicker pulse; the slower way counts."""
    result = found("falling", 3)
    velocity, stroke = (result.points[name].values for name in ("speed", "stroke"))
    for way, speed in zip((1, -1), result.fastest, strict=True):
        quicker = np.unique(stroke[way * velocity > speed]).size
        assert quicker == min(32, -(-np.unique(stroke[way * velocity > 0]).size // 4)) - 1
    assert result.speed == min(result.fastest)


@pytest.mark.parametrize("speed", [0.3, 0.6])
def test_a_plan_reaches_the_speed_that_is_asked_for(speed):
    """Its strokes, as a person varies them, show friction that far; slower ones do not, and it goes on."""
    asked = zw.plan(paddle(), force_noise=0.1, speed=speed, precision=0.5)
    kinds = [(s.length, s.duration, 60 * w) for s, w in zip(asked.strokes, asked.shares, strict=True)]
    result = zw.identify(recorded_strokes(kinds, np.random.default_rng(1)))
    assert result.speed > speed
    assert asked.reached(result)
    farther = zw.plan(result, speed=2 * speed, precision=0.5)
    assert not farther.reached(result)
    assert f"So far it was seen up to {result.speed:.3g} m/s" in repr(farther)


def test_friction_speed_of_a_wheel_and_of_its_handle():
    wheel = {"damping": "0.01", "sample_period": "1 ms", "friction_speed": "4"}
    assert float(zw.rotary(**wheel).friction_speed) == 4.0
    assert float(zw.rotary(**wheel, handle_radius="0.25").friction_speed) == 1.0
    with pytest.raises(zw.InputError, match="friction_speed must be > 0 rad/s"):
        zw.rotary(**{**wheel, "friction_speed": 0})


def test_best_guesses_below_0():
    result = found("falling one way", 0)
    less = {name: result.estimates[name]._replace(value=-0.001) for name in ("mass", "coulomb_friction")}
    without = dataclasses.replace(result, estimates={**result.estimates, **less}, findings=())
    device = without.device(None)
    assert (float(device.coulomb_friction), device.mass) == (0, None)


@pytest.mark.parametrize(("inward", "outward"), [(0.26, 0.14), (0.14, 0.26)])
def test_each_direction_is_found(inward, outward):
    result = two_ways(0, inward, outward)
    for estimate, true in zip(result.directions, (inward, outward, (inward - outward) / 2), strict=True):
        low, high = estimate.interval(0.999)
        assert low < true < high
        assert high - low < 0.25 * 0.26
    assert result.directions.weaker.value == pytest.approx(0.14, rel=0.1)
    low, high = result.estimates["coulomb_friction"].interval(0.999)
    assert low < 0.15 < high
    assert result.shows("damping by direction")


def test_the_wall_rests_on_the_lesser():
    """Of 12 sessions at 95 % two at most promise more than 2 · 0.14/T; by the mean of both all would."""
    results = [two_ways(seed, 0.26, 0.14) for seed in range(12)]
    walls = [2 * float(result.device(0.9).damping.low) / PERIOD for result in results]
    assert sum(wall > 280 for wall in walls) <= 2
    assert np.median(walls) > 0.85 * 280
    assert all(2 * result.estimates["damping"].interval(0.9)[0] / PERIOD > 280 for result in results)
    best = results[0].device(None)
    assert float(best.damping) == results[0].directions.outward.value


def test_confidence_in_a_wall_between_the_two():
    result = two_ways(1, 0.26, 0.14)
    assert result.confidence(zw.Wall(308)) < 0.5
    assert result.confidence(zw.Wall(350)) < 0.01
    assert result.confidence(zw.Wall(225)) > 0.95


def test_a_device_that_is_the_same_both_ways_loses_little():
    """Not knowing that it is costs some per cent of the promise; nothing is said of directions."""
    results = [two_ways(seed, 0.15, 0.15) for seed in range(12)]
    share = [float(result.device(0.9).damping.low) / 0.15 for result in results]
    assert np.median(share) > 0.85
    assert sorted(share)[1] > 0.75
    assert sum(s > 1 for s in share) <= 2
    assert not any(result.shows("damping by direction") for result in results)
    assert float(results[0].device(None).damping) == results[0].estimates["damping"].value


def test_both_stand_in_every_face(tmp_path, capsys):
    result = two_ways(0, 0.26, 0.14)
    assert "inward" in repr(result)
    assert "outward" in repr(result)
    document = result.to_dict(0.95)
    low, high = document["damping_outward_N_s_per_m"]["interval"]
    assert low < 0.14 < high
    assert document["stiffest_by_damping_N_per_m"]["interval"][0] <= 2 * low / PERIOD
    saved = tmp_path / "device.toml"
    result.save(saved, 0.99)
    assert main(["check", str(saved), "--stiffness", "300", "--contact", "kept"]) != 0
    capsys.readouterr()
    assert "inward" not in repr(two_ways(0, 0.15, 0.15))
