"""The plant in C and JavaScript moves as the simulator moves it, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from machines import Ran, compiled_c, run_c, run_node, same_bits, understood
from moved_plants import CELLS, PERIOD, PLANTS, hand_and_law, plant_in_c, plant_in_javascript
from numpy.typing import NDArray

import zwidth as zw
from zwidth.loop.plant import COULOMB, POSITION, STATE_SIZE, STOPS, VELOCITY, WORK
from zwidth.machine.firmware.plant import one_period, plant_module, plant_program
from zwidth.machine.firmware.program import Program

GIVEN = ("undamped", "slewing", "held_lagging")
"""Those whose numbers are given at every call as well."""

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def simulated() -> dict[str, tuple[Array, Ran]]:
    """Inputs of each plant; state after every period, and in the end, by the compiled functions."""
    step = one_period
    made = {}
    for name, (plant, hand) in PLANTS.items():
        rows = hand_and_law(hand, 1500, 3)
        state, work = np.zeros(STATE_SIZE), np.zeros(WORK)
        states = np.empty((len(rows), STATE_SIZE))
        for k, (force, push, *anchor) in enumerate(rows):
            step(state, work, plant, force, push, *(anchor or (0.0, 0.0)), PERIOD)
            states[k] = state
        made[name] = rows, Ran(states, np.concatenate([state, work]))
    return made


def _programs() -> dict[str, tuple[Program, list[float]]]:
    """Of each plant: with its numbers known, and with its numbers given."""
    made: dict[str, tuple[Program, list[float]]] = {}
    for name, (plant, hand) in PLANTS.items():
        made[name] = plant_program(plant, PERIOD, hand), []
        if name not in GIVEN:
            continue
        given = plant_program(None, PERIOD, hand)
        wanted = {p.hint for p in given.parameters}
        made[f"{name}_given"] = given, [v for f, v in plant._asdict().items() if f in wanted]
    return made


def _inputs(rows: Array, numbers: list[float]) -> Array:
    return np.concatenate([np.tile(numbers, (len(rows), 1)), rows], 1) if numbers else rows


def _of(name: str) -> str:
    return name.removesuffix("_given")


def test_the_forces_make_it_slide_turn_and_stop(simulated: dict[str, tuple[Array, Ran]]) -> None:
    """Each plant comes to rest and breaks away again many times: what follows compares something."""
    for name, (_, ran) in simulated.items():
        assert ran.cells[STOPS] > 5, name
        assert np.unique(ran.outputs[:, POSITION]).size > 300, name
        assert np.unique(ran.outputs[:, VELOCITY]).size > 300, name
    assert simulated["free"][1].cells[COULOMB] > 0.0


@pytest.mark.parametrize(
    "options",
    [("-std=c99", "-O2"), ("-std=gnu99", "-O3", "-march=native")],
    ids=lambda options: " ".join(options),
)
def test_the_header_moves_it_as_the_simulator_does(
    simulated: dict[str, tuple[Array, Ran]], options: tuple[str, ...], tmp_path: Path
) -> None:
    """Position, velocity and every energy after every period, with known and with given numbers."""
    understood("cc", *options)
    programs = _programs()
    library = compiled_c("".join(plant_in_c(p, n) for n, (p, _) in programs.items()), tmp_path, options)
    for name, (_, numbers) in programs.items():
        rows, expected = simulated[_of(name)]
        ran = run_c(library, name, _inputs(rows, numbers), CELLS, STATE_SIZE)
        assert same_bits(expected.outputs, ran.outputs), name
        assert same_bits(expected.cells, ran.cells), name


def test_the_module_moves_it_as_the_simulator_does(
    simulated: dict[str, tuple[Array, Ran]], tmp_path: Path
) -> None:
    programs = _programs()
    files = {f"{n}.mjs": plant_module(p, about=[n]) for n, (p, _) in programs.items()}
    given = {
        n: (_inputs(simulated[_of(n)][0], numbers), CELLS, STATE_SIZE) for n, (_, numbers) in programs.items()
    }
    ran = run_node("".join(plant_in_javascript(n) for n in programs), tmp_path, given, files)
    for name in programs:
        expected = simulated[_of(name)][1]
        assert same_bits(expected.outputs, ran[name].outputs), name
        assert same_bits(expected.cells, ran[name].cells), name


def test_a_free_hand_has_no_spring() -> None:
    with pytest.raises(zw.InputError, match="anchor"):
        plant_program(PLANTS["held"][0], PERIOD, "free")
    with pytest.raises(zw.InputError, match="> 0 s"):
        plant_program(PLANTS["held"][0], 0.0, "anchored")
