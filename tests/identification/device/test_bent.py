"""Friction that is no straight line of speed: what is promised lies below it, as far as it was seen."""

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
from zwidth.data.logs.table import Finding
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


@cache
def found(name: str, seed: int) -> zw.identification.Identified:
    """What a minute of a wandering hand says, with white noise of 0.05 N on the load cell."""
    rng = np.random.default_rng(seed)
    omega, phase = 2 * np.pi * rng.uniform(0.3, 3.5, 10)[:, None], rng.uniform(0, 6.28, 10)[:, None]
    amplitude = rng.normal(size=10)[:, None]
    angle = omega * np.arange(60_000) * PERIOD + phase
    scale = 0.015 / (amplitude * np.sin(angle)).sum(axis=0).std()
    x, v, a = (
        scale * (amplitude * part).sum(axis=0)
        for part in (np.sin(angle), omega * np.cos(angle), -(omega**2) * np.sin(angle))
    )
    into, out = LAWS[name].friction(np.abs(v))
    force = MASS * a + np.where(v > 0, into, out) * np.sign(v) + 0.05 * rng.normal(size=v.size)
    return zw.identify(
        zw.Log.from_arrays(
            position=np.floor(x / COUNT) * COUNT, hand_force=force, sample_period=PERIOD, resolution=COUNT
        )
    )


def promised(result: zw.identification.Identified) -> tuple[float, float]:
    """The lower ends of b and f_c, each with 95 %."""
    device = result.device(0.9)
    return float(ends(device.damping)[0]), float(ends(device.coulomb_friction)[0])


@pytest.mark.parametrize("name", ["falling", "falling one way"])
def test_no_more_is_promised_than_the_slope_at_the_largest_speed(name: str) -> None:
    """Of 12 minutes two at most promise more, at 95 % each; by a straight line all do."""
    results = [found(name, seed) for seed in range(12)]
    slopes = [LAWS[name].slope(result.speed) for result in results]
    lines = [
        min(result.directions.least(0.9), result.estimates["damping"].interval(0.9)[0]) for result in results
    ]
    assert all(line > slope for line, slope in zip(lines, slopes, strict=True))
    assert sum(promised(r)[0] > slope for r, slope in zip(results, slopes, strict=True)) <= 2


def test_a_stribeck_bump_is_not_taken_for_damping() -> None:
    """A parabola without a bump says more than there is; with it, two of 12 at most, and not much less."""
    results = [found("Stribeck", seed) for seed in range(12)]
    share = [promised(result)[0] / 0.15 for result in results]
    assert sum(s > 1 for s in share) <= 2
    assert np.median(share) > 0.6
    assert sum(result.shows("Stribeck friction") for result in results) >= 10
    assert all(result.estimates["slow"].value > 0 for result in results if "slow" in result.estimates)


def _bent(result: zw.identification.Identified) -> Finding:
    (finding,) = [f for f in result.findings if f.kind == "bent friction"]
    return finding


@pytest.mark.parametrize("name", list(LAWS))
def test_the_line_promised_is_below_friction(name: str) -> None:
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


def test_a_bend_is_said_with_the_slope_and_the_speed() -> None:
    """And the device is the line that proves the stiffest wall."""
    result = found("falling", 0)
    assert "its slope is" in _bent(result).text
    curve = result.friction_curve(0.9)
    best = curve.best(PERIOD, COUNT)
    assert promised(result) == (float(best.damping), float(best.coulomb_friction))


def test_a_claim_names_the_speed_up_to_which_friction_was_seen(tmp_path) -> None:
    """In the sentence, in the assumptions and in the record, of a device that was saved and read again."""
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


def test_the_speed_is_that_of_the_strokes() -> None:
    """A quarter of the strokes each way, or 32 of them, have a quicker pulse; the slower way counts."""
    result = found("falling", 3)
    velocity, stroke = (result.points[name].values for name in ("speed", "stroke"))
    for way, speed in zip((1, -1), result.fastest, strict=True):
        quicker = np.unique(stroke[way * velocity > speed]).size
        assert quicker == min(32, -(-np.unique(stroke[way * velocity > 0]).size // 4)) - 1
    assert result.speed == min(result.fastest)


@pytest.mark.parametrize("speed", [0.3, 0.6])
def test_a_plan_reaches_the_speed_that_is_asked_for(speed: float) -> None:
    """Its strokes, as a person varies them, show friction that far; slower ones do not, and it goes on."""
    asked = zw.plan(paddle(), force_noise=0.1, speed=speed, precision=0.5)
    kinds = [(s.length, s.duration, 60 * w) for s, w in zip(asked.strokes, asked.shares, strict=True)]
    result = zw.identify(recorded_strokes(kinds, np.random.default_rng(1)))
    assert result.speed > speed
    assert asked.reached(result)
    farther = zw.plan(result, speed=2 * speed, precision=0.5)
    assert not farther.reached(result)
    assert f"So far it was seen up to {result.speed:.3g} m/s" in repr(farther)


def test_friction_speed_of_a_wheel_and_of_its_handle() -> None:
    """rad/s at the axis, m/s at the handle; not 0."""
    wheel = {"damping": "0.01", "sample_period": "1 ms", "friction_speed": "4"}
    assert float(zw.rotary(**wheel).friction_speed) == 4.0
    assert float(zw.rotary(**wheel, handle_radius="0.25").friction_speed) == 1.0
    with pytest.raises(zw.InputError, match="friction_speed must be > 0 rad/s"):
        zw.rotary(**{**wheel, "friction_speed": 0})


def test_the_best_guess_of_no_coulomb_friction_is_none() -> None:
    """An estimate a little below 0 makes a device with f_c = 0, as it does of damping."""
    result = found("falling one way", 0)
    friction = result.estimates["coulomb_friction"]._replace(value=-0.001)
    without = dataclasses.replace(result, estimates={**result.estimates, "coulomb_friction": friction})
    without = dataclasses.replace(without, findings=())
    assert float(without.device(None).coulomb_friction) == 0
