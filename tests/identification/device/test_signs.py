"""Logs whose signs, units or ranges are not what they seem: the likeliest cause is said."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from numpy.typing import NDArray
from recordings import Recording, hand_moves, paddle

import zwidth as zw
from zwidth.data.logs.sensors import Stops


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Half a minute of the paddle."""
    return hand_moves(paddle(), 30.0, seed=3)


def logged(recording: Recording, **forces: object) -> zw.identification.Identified:
    arrays = {"time": recording.time, "position": recording.position, "hand_force": recording.hand_force}
    return zw.identify(zw.Log.from_arrays(resolution=22.4e-6, **arrays | forces))


def refused(recording: Recording, **forces: object) -> str:
    with pytest.raises(zw.InputError) as error:
        logged(recording, **forces)
    return str(error.value)


def test_a_load_cell_that_counts_the_other_way(recording):
    true = logged(recording).estimates["mass"].value
    said = refused(recording, hand_force=-recording.hand_force)
    assert f"mass comes out as {-true:.4g} kg" in said
    assert f"with the other one mass {true:.4g} kg" in said
    assert 'scale={"hand_force": "-1"} or' in said
    assert 'scale={"position": "-1"}' in said
    assert "do not rule out" not in said


def test_of_two_forces_the_wrong_one_is_named(recording):
    """One sign is turned before two; only where both are, it may be the position's."""
    motor = 2.0 * np.sin(2 * np.pi * 0.7 * recording.time)  # the hand makes up for it
    right = {"hand_force": recording.hand_force + motor, "actuator_force": motor}
    assert logged(recording, **right).estimates["mass"].value == pytest.approx(0.036, rel=0.05)
    for turned, named in (
        (("hand_force",), "hand force"),
        (("hand_force", "actuator_force"), "hand force and actuator force"),
    ):
        said = refused(recording, **{name: -f if name in turned else f for name, f in right.items()})
        assert f"sign of the {named} looks turned round" in said
        assert ('{"position": "-1"}' in said) is (len(turned) == 2)


def test_a_motor_that_compensates_friction_and_is_not_logged(recording):
    """Damping below 0 with the right mass: no sign explains it, and the message says what may."""
    said = refused(recording, hand_force=recording.hand_force - 0.4 * recording.true_velocity)
    assert "damping comes out as -0.2" in said
    assert "mass comes out" not in said
    assert "is friction compensated" in said
    assert "scale=" not in said


@pytest.fixture(scope="module")
def table(recording: Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with German names, positions in millimetres."""
    path = tmp_path_factory.mktemp("signs") / "log.csv"
    arrays = (recording.time, 1e3 * recording.position, recording.hand_force)
    rows = zip(*(values.tolist() for values in arrays), strict=True)
    lines = "".join(f"{t!r},{x!r},{f!r}\n" for t, x, f in rows)
    path.write_text("Zeit [s],Weg [mm],Kraft [N]\n" + lines, encoding="utf-8")
    return path


COLUMNS = {"time": "Zeit [s]", "position": "Weg [mm]", "hand_force": "Kraft [N]"}


@pytest.mark.parametrize(
    ("scale", "factor"), [("-1", -1.0), (-1, -1.0), (" -1 ", -1.0), ("1 m", 1e3)], ids=repr
)
def test_a_bare_factor_goes_with_the_columns_unit(scale, factor, recording, table):
    (block, *_) = zw.read_log(table, columns=COLUMNS, scale={"position": scale}).blocks()
    assert np.abs(block.position - factor * recording.position[: block.position.size]).max() < 1e-9


def test_a_sign_of_counts(tmp_path):
    rows = "".join(f"{k / 1000!r},{k % 50}\n" for k in range(200))
    (tmp_path / "counts.csv").write_text("t_s,enc_counts\n" + rows, encoding="utf-8")
    log = zw.read_log(tmp_path / "counts.csv", resolution="0.1 mm", scale={"position": "-2"})
    (block,) = log.blocks()
    assert np.allclose(block.position, -2e-4 * (np.arange(200) % 50), atol=1e-12)


@pytest.mark.parametrize("unit", ["m", "deg", "counts", "um"])
def test_a_unit_that_contradicts_the_columns_own(unit, table):
    with pytest.raises(zw.InputError, match=rf'"Weg \[mm\]" says of itself that it is in mm, and {unit} is'):
        zw.read_log(table, columns=COLUMNS, units={"position": unit})
    assert zw.read_log(table, columns=COLUMNS, units={"position": "mm"}).motion == "linear"


Array = NDArray[np.float64]
Way = Literal["cut off", "steps of a converter", "noise behind the stop"]


def saturated(force: Array, share: float, way: Way) -> Array:
    """The force of a load cell that is at an end of its range in so many of its samples."""
    most = np.quantile(np.abs(force), 1 - share)
    cut = np.clip(force, -most, most)
    if way == "steps of a converter":
        return np.rint(cut / 0.005) * 0.005
    if way == "noise behind the stop":
        return cut + 0.002 * np.random.default_rng(0).integers(-2, 3, cut.size)
    return cut


@cache
def session(seed: int, share: float = 0.0, way: Way = "cut off") -> zw.identification.Identified:
    recording = hand_moves(paddle(), 60.0, seed)
    force = saturated(recording.hand_force, share, way) if share else recording.hand_force
    arrays = {"time": recording.time, "position": recording.position, "hand_force": force}
    return zw.identify(zw.Log.from_arrays(resolution=22.4e-6, **arrays))


@pytest.mark.parametrize("way", ["cut off", "steps of a converter", "noise behind the stop"])
def test_damping_is_what_it_was(way):
    found = session(3, 0.1, way)
    (finding,) = [f for f in found.findings if f.kind == "saturated"]
    assert "the sensor is at the end of its range" in finding.text
    assert 0.05 * 60_000 < finding.samples < 0.11 * 60_000
    low, high = found.estimates["damping"].interval(0.99)
    assert low < 0.15 < high
    assert found.strokes < 0.7 * session(3).strokes


def test_most_promises_keep_to_the_limit():
    promised = [2e3 * session(seed, 0.1).estimates["damping"].interval(0.9)[0] for seed in range(2, 18)]
    assert sum(wall > 300 for wall in promised) <= 2  # of a one-sided bound of 95 %
    assert np.median(promised) > 270


def test_too_few_strokes_within_the_range_are_too_little():
    with pytest.raises(zw.InputError, match="too little motion"):
        session(0, 0.2)


def stops(*blocks: Array) -> tuple[tuple[float, float], int]:
    counted = Stops()
    for block in blocks:
        counted.take(block)
    return counted.found()


TIME = np.arange(20_000) / 1000
SINE = 3.0 * np.sin(2 * np.pi * 0.731 * TIME)
NOISE = np.random.default_rng(1).normal(size=20_000)


@pytest.mark.parametrize(
    "force",
    [
        pytest.param(SINE, id="sine"),
        pytest.param(np.rint(SINE / 0.01) * 0.01, id="fine steps"),
        pytest.param(np.rint(SINE / 0.1) * 0.1, id="coarse steps"),
        pytest.param(NOISE, id="noise"),
        pytest.param(np.rint(NOISE / 0.05), id="noise in steps"),
        pytest.param(np.maximum(SINE, 0.0), id="untouched"),
        pytest.param(np.sign(SINE), id="square"),
        pytest.param(np.zeros(100), id="none"),
        pytest.param(np.linspace(-1, 1, 20_000), id="ramp"),
    ],
)
def test_what_turns_round_is_at_no_stop(force):
    """Nor is a force that is 0 where nobody touches, or one of a few values only."""
    assert stops(force) == ((-np.inf, np.inf), 0)


def test_one_end_in_many_blocks():
    force = np.minimum(SINE + 0.01 * np.random.default_rng(2).normal(size=SINE.size), 2.5)
    whole = stops(force)
    assert whole == ((-np.inf, 2.5), int((force == 2.5).sum()))
    assert stops(*np.array_split(force, 37)) == whole
