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

import zwidth as zw
from zwidth.environment.environment import Environment
from zwidth.firmware.law import LawProgram, law_program
from zwidth.firmware.module import module
from zwidth.loop.law import sampled_force, sampled_force_at
from zwidth.loop.setup import prepare
from zwidth.operator import PrescribedMotion

STEPS = 3000


class Known(NamedTuple):
    """A law, its readings, and what the compiled functions make of them."""

    law: LawProgram
    readings: NDArray[np.float64]
    ran: Ran


@pytest.fixture(scope="module")
def known() -> Mapping[str, Known]:
    return {name: _known(*make()) for name, make in laws().items()}


def _known(device: zw.Device, environment: Environment) -> Known:
    """What `simulate` gives: on a walk, then from rest at some places."""
    law = law_program(device, environment)
    still = [[np.nan, *[n] * 4] for n in (-3000, -1, 0, 1, 2, 391, 3000)]
    given = np.concatenate([readings(law, 7, STEPS), np.ravel(still) * (1 if law.resolution > 0 else 2.1e-5)])
    step, kind = (sampled_force, int) if law.resolution > 0 else (sampled_force_at, float)
    forces = np.zeros((len(given), 1))
    for k, x in enumerate(given):
        if np.isnan(x):
            continue
        if k == 0 or np.isnan(given[k - 1]):
            there = PrescribedMotion([float(kind(x)) * (law.resolution or 1.0)] * 2)
            period = device.exact("sample_period")
            memory = prepare(device, environment, there, period, encoder_phase=0.5).memory
        forces[k] = step(law.law, memory, kind(x))
    return Known(law, given[:, None], Ran(forces, memory))


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
    """Force and memory are equal to the last bit, however C is compiled, also where products can be fused.

    So they are where a law begins: at rest, outside or inside, as in the simulator.
    """
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
