"""No motion makes an emitted law's force differ from the exact one's by more than the bound."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from firmware.adversary import text
from firmware.emulated.host import HostLaw, watched
from firmware.emulated.required import require
from firmware.exact_law import ExactProgram, linear_forces
from firmware.random_laws import LIMITED, PADDLE, STEPPED, hardest, laws, motions

import zwidth as zw
from zwidth.firmware.bound import plain
from zwidth.firmware.evaluation import Exact, NoBound
from zwidth.firmware.invariant import Rest, invariant
from zwidth.firmware.law import law_program
from zwidth.firmware.machine import Machine, machine, rest_ends

MOST = 3000
DEVICES = {"bare": PADDLE, "stepped": STEPPED, "limited": LIMITED}


def made(device: zw.Device, name: str, number: str) -> Machine | None:
    """The machine, where it has a bound and can be written."""
    try:
        found = machine(law_program(device, laws()[name]), number, (-MOST, MOST))
    except zw.InputError:
        return None
    return None if found.error is None else found


def tried(exact: ExactProgram, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Motions, the last one with the signs of the force's answer to a count."""
    yield from motions(random, MOST, 60)
    exact.init(0)
    answer = [float(exact.step(n)) for n in (100, 101, *[100] * 60)]
    yield hardest(np.diff(answer), MOST, random)


@pytest.mark.parametrize(
    ("device", "number"),
    [
        ("bare", "double"),
        ("limited", "double"),
        ("bare", "float"),
        ("stepped", "float"),
        ("bare", "fixed"),
        ("limited", "fixed"),
    ],
)
@pytest.mark.parametrize("name", laws())
def test_the_error_stays_within_its_bound(name: str, device: str, number: str, tmp_path: Path) -> None:
    """Whatever the hand does; beside the same program in fractions, without the converter's rounding."""
    require("host")
    m = made(DEVICES[device], name, number)
    if m is None:
        pytest.skip("no bound is claimed of it")
    law, exact, random = HostLaw(text(m), tmp_path), ExactProgram(m.law), np.random.default_rng(len(name))
    for counts in tried(exact, random):
        start = int(random.integers(-MOST, MOST))
        law.init(start)
        exact.init(start)
        for n, unit in zip(counts, law.run(counts), strict=True):
            force = Fraction(float(unit)) * Fraction(law.force_per_unit)
            assert abs(force - exact.step(int(n))) <= m.error
            assert abs(force) <= m.largest_force


@pytest.mark.parametrize("number", ["double", "float", "fixed"])
@pytest.mark.parametrize(
    "name", [n for n in laws() if n.startswith(("wall", "solid", "maxwell", "everywhere"))]
)
def test_the_exact_law_is_h_of_z(name: str, number: str, tmp_path: Path) -> None:
    """The same against H(z) with the decimals that were typed, from rest at the surface."""
    require("host")
    m = made(STEPPED, name, number)
    if m is None:
        pytest.skip("no bound is claimed of it")
    law, env, random = HostLaw(text(m), tmp_path), laws()[name], np.random.default_rng(7)
    clamped, surface = getattr(env, "clamped", False), not name.startswith("everywhere")
    for counts in motions(random, MOST, 60):
        seen = np.maximum(counts, 0) if name in ("solid", "maxwell") else counts
        law.init(0)
        forces = linear_forces(STEPPED, env, [int(n) for n in seen], surface, clamped)
        for unit, force in zip(law.run(counts), forces, strict=True):
            assert abs(Fraction(float(unit)) * Fraction(law.force_per_unit) - force) <= m.error


@pytest.mark.parametrize("device", ["bare", "limited"])
@pytest.mark.parametrize("name", laws())
def test_whole_numbers_stay_within_their_word(name: str, device: str, tmp_path: Path) -> None:
    """Nothing overflows in fixed point in 10⁵ samples, and no reading outside of the range does harm."""
    require("host")
    m = made(DEVICES[device], name, "fixed")
    if m is None:
        pytest.skip("it has no form in fixed point")
    random = np.random.default_rng(3)
    counts = np.concatenate([*motions(random, MOST, 7000), [2**31 - 1, -(2**31), 0, MOST, -MOST] * 100])
    watched(text(m), counts.astype(np.int32), tmp_path, start=MOST)


@pytest.mark.parametrize("name", laws())
def test_every_number_stays_within_its_bound(name: str) -> None:
    """Every exact intermediate, and all that is remembered, lies in the range that the bound has for it."""
    law = law_program(PADDLE, laws()[name])
    exact, random = ExactProgram(law), np.random.default_rng(5)
    ends = rest_ends(law, (-MOST, MOST))
    given = {law.program.parameters[0]: plain(-MOST, MOST)}
    try:
        found = invariant(law.program, given, Rest(ends, (0.0,) * ends.shape[1]), Exact())
    except NoBound:
        pytest.skip("no bound is claimed of it")
    for counts in tried(exact, random):
        exact.init(int(random.integers(-MOST, MOST)))
        for n in counts:
            exact.step(int(n))
            for variable, value in exact.values.items():
                if variable in found.values and variable.kind != "truth":
                    assert found.values[variable].low <= value <= found.values[variable].high
            for value, (low, high, _) in zip(exact.cells, found.memory, strict=True):
                assert low <= value <= high
