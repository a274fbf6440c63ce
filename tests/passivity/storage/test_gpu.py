"""Value iteration on a graphics card: thread by thread in numba's simulator of CUDA, on tiny grids."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

import zwidth as zw
from zwidth.errors import InputError
from zwidth.passivity.storage.domain import Domain
from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.solve.value_iteration import value_iteration

_ON_CARD = """
import zwidth as zw
from zwidth.passivity.storage.solve import gpu
from zwidth.passivity.storage.domain import Domain
from zwidth.passivity.storage.grid.grid import Grid
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.storage.solve.value_iteration import value_iteration

gpu._SCRATCH = 1  # so that threads have more than one item
paddle = zw.catalogue.device("haptic-paddle").replace(coulomb_friction="0.004")
ended = []
window = zw.rendering.Window(2)
outer, inner = ("outer", 3), ("inner", 1024)
for stiffness, damping, delay, domain, (approximation, steps) in (
    (200, {}, 0, Domain(-3, 3, 4), outer),
    (200, {"damping": 0.05}, 0, Domain(-5, 3, 4), inner),
    (20000, {"damping": 0.03, "velocity_filter": window, "clamped": True}, 0, Domain(-2, 2, 2), inner),
    (20000, {"damping": 0.02}, 1, Domain(-2, 2, 2), outer),
):
    wall = zw.Wall(stiffness, **damping)
    law = finite_law(paddle, wall)
    losses = Losses(*(paddle.exact(k) for k in ("damping", "coulomb_friction", "resolution")),
                    paddle.exact("sample_period"), delay)
    grid = Grid(law, losses, domain, steps, approximation)
    grid.__dict__["first_guess"] = 0 * grid.first_guess  # so that it takes many rounds
    card, own = (value_iteration(grid, backend=one) for one in ("gpu", "cpu"))
    assert own.rounds > 2, (approximation, wall, own.rounds)
    assert (card.value is None) == (own.value is None)
    assert bool(card.cycle) == bool(own.cycle)
    assert own.value is None or (card.value == own.value).all()
    ended.append(own.value is not None)
print(*ended)
"""


def _in_simulator(code: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1", "NUMBA_DISABLE_JIT": "1"}
    return subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)


def test_the_card_finds_what_the_processor_finds() -> None:
    """The same outcome and the same V to the last bit, with none, one or two readings remembered."""
    done = _in_simulator(_ON_CARD)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True"] * 2 + ["False"] * 2


def _grid() -> Grid:
    paddle = zw.catalogue.device("haptic-paddle")
    keys = ("damping", "coulomb_friction", "resolution", "sample_period")
    losses = Losses(*(paddle.exact(k) for k in keys), 0)
    return Grid(finite_law(paddle, zw.Wall(200)), losses, Domain(-3, 3, 4), 4, "outer")


def test_without_a_card_one_message_says_what_to_do() -> None:
    """Where CUDA is missing, or its package, the message names the extra."""
    try:
        from numba import cuda

        if cuda.is_available():
            pytest.skip("there is a card")
    except ImportError:
        pass
    with pytest.raises(InputError, match=r"leave out backend='gpu'|zwidth\[gpu\]"):
        value_iteration(_grid(), backend="gpu")


def test_anything_else_than_cpu_and_gpu_is_refused() -> None:
    with pytest.raises(InputError, match='backend is "cpu" or "gpu"'):
        value_iteration(_grid(), backend="tpu")
