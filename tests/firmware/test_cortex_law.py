"""The emulated Cortex-M4: instructions are counted one by one, forces are those of this machine."""

from __future__ import annotations

import numpy as np
import pytest
from firmware.baselines.read import fixed_forces, float_forces, text, touch
from firmware.emulated import cortex
from firmware.emulated.answers import IDLE
from firmware.emulated.required import require


@pytest.fixture(autouse=True)
def _tools() -> None:
    require("cortex-m4")


def test_every_instruction_is_counted() -> None:
    """n more of them are n more; so are those of a loop."""
    loop = '__asm__ volatile("1: subs %0, #1\\n bne 1b" : "+r"(counts) : : "cc"); '
    for extra, more in (("", 0), ('__asm__ volatile("nop\\n nop\\n nop"); ', 3), (loop, None)):
        counts = np.array([1, 2, 7, 100, 20_000])
        law = IDLE.replace("return counts", f"{extra}return counts")
        bare = cortex.run(IDLE, counts).cost
        wanted = bare + (2 * counts if more is None else more)
        assert cortex.run(law, counts).cost.tolist() == wanted.tolist()


@pytest.mark.parametrize("floats", [cortex.SOFT, cortex.HARD])
def test_forces_of_the_cortex(floats: tuple[str, ...]) -> None:
    counts = touch(3000, 2**31 - 1)
    fixed = cortex.run(text("fixed16"), counts, 5, floats)
    assert fixed.forces.tolist() == fixed_forces(counts, 5)
    for name, real in (("naive_float", np.float32), ("naive_double", np.float64)):
        answers = cortex.run(text(name), counts, -3, floats)
        assert answers.forces.dtype == real
        assert np.array_equal(answers.forces, float_forces(counts, real, -3))


def test_what_a_step_takes() -> None:
    counts = touch(500)
    soft, hard = (cortex.run(text("naive_float"), counts, floats=f) for f in (cortex.SOFT, cortex.HARD))
    assert hard.worst < 50 < 200 < soft.median
    assert cortex.run(text("naive_double"), counts).median > 200
    assert cortex.run(text("fixed16"), counts, floats=cortex.SOFT).worst < 50
    assert 0 < hard.flash < soft.flash
