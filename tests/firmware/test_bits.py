"""What is emitted of a law gives the same bits as the compiled step functions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from emitted_laws import laws, readings
from machines import (
    Ran,
    compiled_c,
    law_in_c,
    law_in_javascript,
    needs_c,
    needs_node,
    run_c,
    run_node,
    same_bits,
)
from numpy.typing import NDArray

from zwidth.firmware.law import LawProgram, law_program
from zwidth.firmware.module import module
from zwidth.loop.law import sampled_force, sampled_force_at

STEPS = 3000


class Known(NamedTuple):
    """A law, its readings, and what the compiled functions make of them."""

    law: LawProgram
    readings: NDArray[np.float64]
    ran: Ran


@pytest.fixture(scope="module")
def known() -> Mapping[str, Known]:
    return {name: _known(law_program(*make())) for name, make in laws().items()}


def _known(law: LawProgram) -> Known:
    given = readings(law, 7, STEPS)
    step, kind = (sampled_force, int) if law.resolution > 0 else (sampled_force_at, float)
    first = float(kind(given[0])) * (law.resolution or 1.0)
    numbers, memory = np.array(law.law), law.rest[0] + law.rest[1] * first
    forces = [step(numbers, memory, kind(x)) for x in given]
    return Known(law, given[:, None], Ran(np.array(forces)[:, None], memory))


def _differ(known: Mapping[str, Known], ran: Mapping[str, Ran]) -> list[str]:
    return [
        name
        for name, one in known.items()
        if not all(same_bits(a, b) for a, b in zip(one.ran, ran[name], strict=True))
    ]


def test_the_readings_make_every_law_push(known: Mapping[str, Known]) -> None:
    """Each law gives many forces, inside its limit and at it: what follows compares something."""
    assert all(len(np.unique(one.ran.outputs)) > 40 for one in known.values())


@needs_c
@pytest.mark.parametrize(
    "options",
    [("-std=c99", "-O2"), ("-std=gnu99", "-O3"), ("-std=gnu99", "-O3", "-march=native")],
    ids=lambda options: " ".join(options),
)
def test_every_header_has_the_same_bits(
    known: Mapping[str, Known], options: tuple[str, ...], tmp_path: Path
) -> None:
    """Force and memory are equal to the last bit, however C is compiled, also where products can be fused."""
    library = compiled_c("".join(law_in_c(k.law, n) for n, k in known.items()), tmp_path, options)
    ran = {n: run_c(library, n, k.readings, k.ran.cells, 1) for n, k in known.items()}
    assert not _differ(known, ran)


@needs_node
def test_every_module_has_the_same_bits(known: Mapping[str, Known], tmp_path: Path) -> None:
    """Force and memory are equal to the last bit in JavaScript."""
    files = {f"{n}.mjs": module(k.law, about=[n], numbers=[]) for n, k in known.items()}
    text = "".join(law_in_javascript(n) for n in known)
    ran = run_node(text, tmp_path, {n: (k.readings, k.ran.cells, 1) for n, k in known.items()}, files)
    assert not _differ(known, ran)
