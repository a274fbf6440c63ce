"""A header compiled for this machine: its forces are those that arithmetic gives, and it can begin anew."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.baselines.read import fixed_forces, float_forces, text, touch
from firmware.emulated.host import HostLaw, watched
from firmware.emulated.required import require

COUNTS = touch(20_000)


@pytest.fixture(autouse=True)
def _tools() -> None:
    require("host")


def test_whole_numbers(tmp_path: Path) -> None:
    counts = touch(20_000, 2**31 - 1)
    law = HostLaw(text("fixed16"), tmp_path)
    law.init(5)
    assert law.dtype == np.int32
    assert law.run(counts).tolist() == fixed_forces(counts, 5)


@pytest.mark.parametrize(("name", "real"), [("naive_float", np.float32), ("naive_double", np.float64)])
def test_floats(name: str, real: type[np.floating], tmp_path: Path) -> None:
    """A law in floats has every bit that numpy has with the same operations, whatever is optimized."""
    for level in ("-O0", "-O2"):
        folder = tmp_path / level
        folder.mkdir()
        law = HostLaw(text(name), folder, level)
        law.init(-3)
        assert law.dtype == real
        assert np.array_equal(law.run(COUNTS), float_forces(COUNTS, real, -3))


def test_a_run_goes_on_and_begins_anew(tmp_path: Path) -> None:
    """Two runs are one, in two parts; after init the same comes again; a force is in newtons."""
    law = HostLaw(text("naive_q16"), tmp_path)
    law.init(0)
    whole = law.run(COUNTS[:100])
    law.init(0)
    assert np.array_equal(np.append(law.run(COUNTS[:40]), law.run(COUNTS[40:100])), whole)
    law.init(0)
    assert law.force(COUNTS[0]) == whole[0] * 2.0**-16


def test_a_warning_is_an_error(tmp_path: Path) -> None:
    careless = text("fixed16").replace("int32_t f;", "int32_t f, unused;")
    with pytest.raises(AssertionError, match="unused"):
        HostLaw(careless, tmp_path)


def test_an_overflow_is_seen(tmp_path: Path) -> None:
    """Whole numbers that grow too large end the run; those of 16 bits do not, whatever is counted."""
    anything = touch(5000, 2**31 - 1)
    for name in ("fixed16", "naive_float"):
        watched(text(name), anything, tmp_path)
    watched(text("naive_q16"), COUNTS, tmp_path)
    with pytest.raises(AssertionError, match="overflow"):
        watched(text("naive_q16"), anything, tmp_path)
