"""The plant in C and JavaScript moves as the simulator moves it, to the last bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from machines import Ran, compiled_c, needs_c, needs_node, run_c, run_node, same_bits
from numba import njit
from numpy.typing import NDArray

import zwidth as zw
from zwidth.firmware.plant import Hand, one_period, plant_header, plant_module, plant_program
from zwidth.firmware.program import Program
from zwidth.loop.plant import COULOMB, POSITION, STATE_SIZE, STOPS, VELOCITY, Plant
from zwidth.loop.series import WORK

PERIOD = 0.001

PLANTS: dict[str, tuple[Plant, Hand]] = {
    "free": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 0.0, 0.0, 0.0, 0.0), "free"),
    "undamped": (Plant(0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), "free"),
    "heavy_damping": (Plant(0.002, 0.0, 5.0, 0.02, 0.02, 0.0, 0.0, 0.0, 0.0), "free"),
    "lagging": (Plant(0.05, 0.0, 0.1, 0.02, 0.03, 0.0, 0.0, 0.002, 0.0), "free"),
    "slewing": (Plant(0.05, 0.0, 0.1, 0.02, 0.03, 0.0, 0.0, 0.0, 200.0), "free"),
    "held": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 300.0, 1.0, 0.0, 0.0), "anchored"),
    "held_lagging": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 300.0, 1.0, 0.0005, 0.0), "anchored"),
    "damped_alone": (Plant(0.05, 0.01, 0.1, 0.02, 0.03, 0.0, 1.0, 0.0, 0.0), "anchored"),
}

GIVEN = ("undamped", "slewing", "held_lagging")
"""Those whose numbers are given at every call as well."""

Array = NDArray[np.float64]


def _rows(hand: Hand, rows: int, seed: int) -> Array:
    """Forces that hold it, let it slide and turn it round; an anchor that rests and moves."""
    random = np.random.default_rng(seed)
    size = random.choice([0.0, 0.01, 0.1, 3.0], rows // 20 + 1).repeat(20)[:rows]
    force, push = (
        size * random.normal(size=rows),
        random.choice([0.0, 0.02, 0.5], rows) * random.normal(size=rows),
    )
    speed = random.choice([0.0, 0.0, 0.2, -0.2], rows // 40 + 1).repeat(40)[:rows]
    anchor = np.concatenate([[0.0], np.cumsum(speed * PERIOD)[:-1]])
    return np.stack([force, push] + ([anchor, speed] if hand == "anchored" else []), 1)


@pytest.fixture(scope="module")
def simulated() -> dict[str, tuple[Array, Ran]]:
    """Inputs of each plant; state after every period, and in the end, by the compiled functions."""
    step: Any = njit(error_model="numpy")(one_period)
    made = {}
    for name, (plant, hand) in PLANTS.items():
        rows = _rows(hand, 1500, 3)
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


def _in_c(program: Program, name: str) -> str:
    count = len(program.parameters)
    given = "".join(f", in[k * {count} + {i}]" for i in range(count))
    return f"""{plant_header(program, name=name, about=[name])}
void {name}_rows(const double *in, int rows, double *cells, double *out)
{{
    {name}_state s;
    {name}_init(&s, 0.0);
    for (int k = 0; k < rows; k += 1) {{
        {name}_step(&s{given});
        for (int i = 0; i < {STATE_SIZE}; i += 1) {{ out[k * {STATE_SIZE} + i] = s.state[i]; }}
    }}
    for (int i = 0; i < {STATE_SIZE}; i += 1) {{ cells[i] = s.state[i]; }}
    for (int i = 0; i < {WORK}; i += 1) {{ cells[{STATE_SIZE} + i] = s.work[i]; }}
}}
"""


def _in_javascript(name: str) -> str:
    return f"""import * as of_{name} from "./{name}.mjs";
export const {name} = (() => {{
    const s = of_{name}.init(0);
    return (row, cells) => {{
        of_{name}.step(s, ...row);
        cells.set(s.state);
        cells.set(s.work, {STATE_SIZE});
        return s.state;
    }};
}})();
"""


def _inputs(rows: Array, numbers: list[float]) -> Array:
    return np.concatenate([np.tile(numbers, (len(rows), 1)), rows], 1) if numbers else rows


def _of(name: str) -> str:
    return name.removesuffix("_given")


CELLS = np.zeros(STATE_SIZE + WORK)


def test_the_forces_make_it_slide_turn_and_stop(simulated: dict[str, tuple[Array, Ran]]) -> None:
    """Each plant comes to rest and breaks away again many times: what follows compares something."""
    for name, (_, ran) in simulated.items():
        assert ran.cells[STOPS] > 5, name
        assert np.unique(ran.outputs[:, POSITION]).size > 300, name
        assert np.unique(ran.outputs[:, VELOCITY]).size > 300, name
    assert simulated["free"][1].cells[COULOMB] > 0.0


@needs_c
@pytest.mark.parametrize(
    "options",
    [("-std=c99", "-O2"), ("-std=gnu99", "-O3", "-march=native")],
    ids=lambda options: " ".join(options),
)
def test_the_header_moves_it_as_the_simulator_does(
    simulated: dict[str, tuple[Array, Ran]], options: tuple[str, ...], tmp_path: Path
) -> None:
    """Position, velocity and every energy after every period, with known and with given numbers."""
    programs = _programs()
    library = compiled_c("".join(_in_c(p, n) for n, (p, _) in programs.items()), tmp_path, options)
    for name, (_, numbers) in programs.items():
        rows, expected = simulated[_of(name)]
        ran = run_c(library, name, _inputs(rows, numbers), CELLS, STATE_SIZE)
        assert same_bits(expected.outputs, ran.outputs), name
        assert same_bits(expected.cells, ran.cells), name


@needs_node
def test_the_module_moves_it_as_the_simulator_does(
    simulated: dict[str, tuple[Array, Ran]], tmp_path: Path
) -> None:
    """The same in JavaScript."""
    programs = _programs()
    files = {f"{n}.mjs": plant_module(p, about=[n]) for n, (p, _) in programs.items()}
    given = {
        n: (_inputs(simulated[_of(n)][0], numbers), CELLS, STATE_SIZE) for n, (_, numbers) in programs.items()
    }
    ran = run_node("".join(_in_javascript(n) for n in programs), tmp_path, given, files)
    for name in programs:
        expected = simulated[_of(name)][1]
        assert same_bits(expected.outputs, ran[name].outputs), name
        assert same_bits(expected.cells, ran[name].cells), name


def test_a_free_hand_has_no_spring() -> None:
    """A spring between hand and nothing is refused, as is a period of 0."""
    with pytest.raises(zw.InputError, match="anchor"):
        plant_program(PLANTS["held"][0], PERIOD, "free")
    with pytest.raises(zw.InputError, match="> 0 s"):
        plant_program(PLANTS["held"][0], 0.0, "anchored")
