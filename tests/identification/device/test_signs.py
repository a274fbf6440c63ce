"""Logs whose signs or units are not what they seem: no device comes of them, but the likeliest cause."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from recordings import Recording, hand_moves, paddle

import zwidth as zw


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Half a minute of the paddle."""
    return hand_moves(paddle(), 30.0, seed=3)


def logged(recording: Recording, **forces: object) -> zw.identification.Identified:
    """What the recording says with these forces in place of the hand's."""
    log = zw.Log.from_arrays(
        time=recording.time,
        position=recording.position,
        resolution=22.4e-6,
        **(forces or {"hand_force": recording.hand_force}),
    )
    return zw.identify(log)


def refused(recording: Recording, **forces: object) -> str:
    """Why no device comes of it."""
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
