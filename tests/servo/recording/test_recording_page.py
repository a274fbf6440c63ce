"""The page on recordings names what is in them."""

from pathlib import Path

import pytest

import zwidth as zw
from zwidth.machine.servo.devices import Simulated
from zwidth.machine.servo.ring import PHASES, column_names

PAGE = (Path(__file__).parents[3] / "docs" / "recording.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def columns():
    device = zw.catalogue.device("haptic-paddle")
    return column_names(Simulated(device=device, hand=zw.operators.Finger(), duration="10 ms"))


def test_every_column_is_on_the_page(columns):
    """In the order of the rows; of what a simulated device tells, position and velocity."""
    own = columns[: columns.index("true_position_m") + 2]
    places = [PAGE.index(f"`{name}`") for name in own]
    assert places == sorted(places)


def test_every_phase_is_on_the_page():
    row = next(line for line in PAGE.splitlines() if line.startswith("| `phase` |"))
    assert [row.find(name) for name in PHASES] == sorted(row.find(name) for name in PHASES)
    assert all(f"{number} {name}" in row for number, name in enumerate(PHASES))
