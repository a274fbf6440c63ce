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


def test_a_load_cell_that_counts_the_other_way(recording: Recording) -> None:
    """Mass and damping below 0: the message says which sign to turn, of the force or of the position."""
    true = logged(recording).estimates["mass"].value
    said = refused(recording, hand_force=-recording.hand_force)
    assert f"mass comes out as {-true:.4g} kg" in said
    assert f"with the other one mass {true:.4g} kg" in said
    assert 'scale={"hand_force": "-1"} or' in said
    assert 'scale={"position": "-1"}' in said
    assert "do not rule out" not in said


def two_forces(recording: Recording) -> dict[str, np.ndarray]:
    """The same motion with a motor that helps or brakes by a slow wave, which the hand makes up for."""
    motor = 2.0 * np.sin(2 * np.pi * 0.7 * recording.time)
    return {"hand_force": recording.hand_force + motor, "actuator_force": motor}


@pytest.mark.parametrize(
    ("turned", "said"),
    [
        (("hand_force",), "sign of the hand force looks turned round"),
        (("hand_force", "actuator_force"), "sign of the hand force and actuator force looks turned round"),
    ],
)
def test_of_two_forces_the_wrong_one_is_named(
    turned: tuple[str, ...], said: str, recording: Recording
) -> None:
    """One sign is turned before two; only where both are, it may be the position's."""
    forces = {name: -f if name in turned else f for name, f in two_forces(recording).items()}
    found = refused(recording, **forces)
    assert said in found
    assert ('{"position": "-1"}' in found) is (len(turned) == 2)


def test_two_forces_of_the_right_signs(recording: Recording) -> None:
    """They make the device that the hand alone makes."""
    assert logged(recording, **two_forces(recording)).estimates["mass"].value == pytest.approx(
        0.036, rel=0.05
    )


def test_a_motor_that_compensates_friction_and_is_not_logged(recording: Recording) -> None:
    """Damping below 0 with the right mass: no sign explains it, and the message says what may."""
    said = refused(recording, hand_force=recording.hand_force - 0.4 * recording.true_velocity)
    assert "damping comes out as -0.2" in said
    assert "mass comes out" not in said
    assert "is friction compensated" in said
    assert "scale=" not in said


def test_a_mass_that_is_hardly_seen_is_left_out(recording: Recording) -> None:
    """Below 0 by less than its uncertainty it is no wrong sign; a device of best guesses has no mass then."""
    found = logged(recording)
    light = found.estimates["mass"]._replace(value=-1e-4, error=1e-3)
    device = zw.identification.Identified(
        **{**vars(found), "estimates": {**found.estimates, "mass": light}}
    ).device(None)
    assert device.mass is None
    assert float(device.exact("damping")) == found.estimates["damping"].value


def table(recording: Recording, path: Path) -> Path:
    """A file with German names, positions in millimetres."""
    rows = zip(
        recording.time.tolist(),
        (1e3 * recording.position).tolist(),
        recording.hand_force.tolist(),
        strict=True,
    )
    path.write_text(
        "Zeit [s],Weg [mm],Kraft [N]\n" + "".join(f"{t!r},{x!r},{f!r}\n" for t, x, f in rows),
        encoding="utf-8",
    )
    return path


COLUMNS = {"time": "Zeit [s]", "position": "Weg [mm]", "hand_force": "Kraft [N]"}


def test_a_sign_that_was_typed(recording: Recording, tmp_path: Path) -> None:
    """A bare factor goes with the column's unit, typed as text or given as a number."""
    path = table(recording, tmp_path / "log.csv")
    for minus in ("-1", -1, " -1 "):
        (block, *_) = zw.read_log(path, columns=COLUMNS, scale={"position": minus}).blocks()
        assert np.abs(block.position + recording.position[: block.position.size]).max() < 1e-9
    (tmp_path / "counts.csv").write_text(
        "t_s,enc_counts\n" + "".join(f"{k / 1000!r},{k % 50}\n" for k in range(200))
    )
    log = zw.read_log(tmp_path / "counts.csv", resolution="0.1 mm", scale={"position": "-2"})
    (block,) = log.blocks()
    assert np.allclose(block.position, -2e-4 * (np.arange(200) % 50), atol=1e-12)


@pytest.mark.parametrize("unit", ["m", "deg", "counts", "um"])
def test_a_unit_that_contradicts_the_columns_own(unit: str, recording: Recording, tmp_path: Path) -> None:
    """Neither is obeyed in silence."""
    path = table(recording, tmp_path / "log.csv")
    with pytest.raises(zw.InputError, match=rf'"Weg \[mm\]" says of itself that it is in mm, and {unit} is'):
        zw.read_log(path, columns=COLUMNS, units={"position": unit})
    same = zw.read_log(path, columns=COLUMNS, units={"position": "mm"})
    assert same.motion == "linear"
    (block, *_) = zw.read_log(path, columns=COLUMNS, scale={"position": "1 m"}).blocks()
    assert np.abs(block.position - 1e3 * recording.position[: block.position.size]).max() < 1e-9
