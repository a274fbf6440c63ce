"""A law as a JavaScript module, run by node."""

from __future__ import annotations

import numpy as np
import pytest
from firmware.baselines.read import float_forces, text, touch
from firmware.emulated import node
from firmware.emulated.required import require


@pytest.fixture(autouse=True)
def _tools() -> None:
    require("node")


def test_forces_of_a_module() -> None:
    """Its numbers are doubles: every bit is that of numpy."""
    counts = touch(20_000)
    assert np.array_equal(node.run(text("wall.mjs"), counts, -3), float_forces(counts, np.float64, -3))


def test_a_module_that_fails() -> None:
    with pytest.raises(AssertionError, match="broken"):
        node.run("export function init() { throw new Error('broken'); }\nexport const step = 0;", [1])
