"""The plant in C and JavaScript moves as the simulator moves it, to the last bit."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from machines import Ran, compiled_c, differing, run_c, run_node, understood
from moved_plants import CELLS, PERIOD, PLANTS, hand_and_law, plant_in_c, plant_in_javascript
from numpy.typing import NDArray

import zwidth as zw
from zwidth.loop.plant import COULOMB, POSITION, STATE_SIZE, STOPS, VELOCITY, WORK, Plant
from zwidth.loop.two_bodies import SERIES_OF_TWO, STATE_OF_TWO, TwoMasses
from zwidth.machine.firmware.plant import one_period, one_period_of_two, plant_module, plant_program
from zwidth.machine.firmware.program import Program

GIVEN = ("undamped", "slewing", "held_lagging")
"""Those whose numbers are given at every call as well."""


class Known(NamedTuple):
    program: Program
    rows: NDArray[np.float64]
    ran: Ran


@pytest.fixture(scope="module")
def known() -> dict[str, Known]:
    """Each plant with its numbers known, some with their numbers given."""
    made = {}
    for name, (plant, hand) in PLANTS.items():
        rows = hand_and_law(hand, 1500, 3)
        state, work = np.zeros(STATE_SIZE), np.zeros(WORK)
        states = np.empty((len(rows), STATE_SIZE))
        for k, (force, push, *anchor) in enumerate(rows):
            one_period(state, work, plant, force, push, *(anchor or (0.0, 0.0)), PERIOD)
            states[k] = state
        ran = Ran(states, np.concatenate([state, work]))
        made[name] = Known(plant_program(plant, PERIOD, hand), rows, ran)
        if name in GIVEN:
            given = plant_program(None, PERIOD, hand)
            wanted = {p.hint for p in given.parameters}
            numbers = [v for f, v in plant._asdict().items() if f in wanted]
            inputs = np.concatenate([np.tile(numbers, (len(rows), 1)), rows], 1)
            made[f"{name}_given"] = Known(given, inputs, ran)
    return made


def test_the_forces_make_it_slide_turn_and_stop(known: dict[str, Known]) -> None:
    """Each plant comes to rest and breaks away again many times: what follows compares something."""
    for name, (_, _, ran) in known.items():
        assert ran.cells[STOPS] > 5, name
        assert np.unique(ran.outputs[:, POSITION]).size > 300, name
        assert np.unique(ran.outputs[:, VELOCITY]).size > 300, name
    assert known["free"].ran.cells[COULOMB] > 0.0


@pytest.mark.parametrize(
    "options",
    [("-std=c99", "-O2"), ("-std=gnu99", "-O3", "-march=native")],
    ids=lambda options: " ".join(options),
)
def test_the_header_moves_it_as_the_simulator_does(
    known: dict[str, Known], options: tuple[str, ...], tmp_path: Path
) -> None:
    """Position, velocity and every energy after every period, with known and with given numbers."""
    understood("cc", *options)
    library = compiled_c("".join(plant_in_c(k.program, n) for n, k in known.items()), tmp_path, options)
    assert not differing(known, {n: run_c(library, n, k.rows, CELLS, STATE_SIZE) for n, k in known.items()})


def test_the_module_moves_it_as_the_simulator_does(known: dict[str, Known], tmp_path: Path) -> None:
    files = {f"{n}.mjs": plant_module(k.program) for n, k in known.items()}
    given = {n: (k.rows, CELLS, STATE_SIZE) for n, k in known.items()}
    text = "".join(plant_in_javascript(n) for n in known)
    assert not differing(known, run_node(text, tmp_path, given, files))


@pytest.mark.parametrize(("lag", "handle_dry"), [(0.0, 0.01), (0.0005, 0.0)])
def test_motor_and_handle_move_as_the_simulator_has_them(
    lag: float, handle_dry: float, tmp_path: Path
) -> None:
    """In C, with known numbers, an amplifier, and dry friction on both sides."""
    understood("cc", "-std=c99", "-O2")
    motor = Plant(0.03, 0.0, 0.06, 0.01, 0.015, 0.0, 0.0, lag, 0.0)
    handle = Plant(0.03, 0.01, 0.09, handle_dry, handle_dry, 300.0, 1.0, lag, 0.0)
    two, rows = TwoMasses(motor, handle, 2131.8, 0.02, 0.0, 0.0), hand_and_law("anchored", 1200, 3)
    state, work = np.zeros(STATE_OF_TWO), np.zeros(SERIES_OF_TWO)
    states = np.empty((len(rows), STATE_OF_TWO))
    for k, (force, push, *anchor) in enumerate(rows):
        one_period_of_two(state, work, two, force, push, *anchor, PERIOD)
        states[k] = state
    known = {
        "two": Known(plant_program(two, PERIOD, "anchored"), rows, Ran(states, np.concatenate([state, work])))
    }
    library = compiled_c(plant_in_c(known["two"].program, "two"), tmp_path, ("-std=c99", "-O2"))
    cells = np.zeros(STATE_OF_TWO + SERIES_OF_TWO)
    assert state[STOPS] > 5
    assert not differing(known, {"two": run_c(library, "two", rows, cells, STATE_OF_TWO)})


def test_a_free_hand_has_no_spring() -> None:
    with pytest.raises(zw.InputError, match="anchor"):
        plant_program(PLANTS["held"][0], PERIOD, "free")
    with pytest.raises(zw.InputError, match="> 0 s"):
        plant_program(PLANTS["held"][0], 0.0, "anchored")
