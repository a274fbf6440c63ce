"""No motion makes an emitted law's force differ from the exact one's by more than the bound."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from firmware.adversary import text
from firmware.emulated.host import HostLaw, watched
from firmware.emulated.required import require
from firmware.exact_law import ExactProgram, linear_forces
from firmware.random_laws import LIMITED, PADDLE, STEPPED, hardest, laws, motions

import zwidth as zw
from zwidth.loop.law import sampled_force
from zwidth.loop.setup import prepare
from zwidth.machine.firmware.bound import plain
from zwidth.machine.firmware.evaluation import Exact, NoBound
from zwidth.machine.firmware.invariant import Rest, invariant
from zwidth.machine.firmware.law import law_program
from zwidth.machine.firmware.machine import Machine, machine, rest_ends
from zwidth.model.operator import PrescribedMotion

MOST = 3000
DEVICES = {"bare": PADDLE, "stepped": STEPPED, "limited": LIMITED}


def made(device: zw.Device, name: str, number: str) -> Machine:
    """The machine; the test is skipped where it has no bound, or cannot be written in whole numbers."""
    require("host")
    try:
        found = machine(law_program(device, laws()[name]), number, (-MOST, MOST))
    except zw.InputError:
        pytest.skip("it has no form in fixed point")
    return found if found.error is not None else pytest.skip("no bound is claimed of it")


def tried(exact: ExactProgram, random: np.random.Generator) -> Iterator[np.ndarray]:
    """Motions, the last one with the signs of the force's answer to a count."""
    yield from motions(random, MOST, 60)
    exact.init(0)
    answer = [float(exact.step(n)) for n in (100, 101, *[100] * 60)]
    yield hardest(np.diff(answer), MOST, random)


@pytest.mark.parametrize(
    ("device", "number"),
    [("bare", "double"), ("limited", "double"), ("bare", "float"), ("stepped", "float"), ("bare", "fixed"),
     ("limited", "fixed")],
)  # fmt: skip
@pytest.mark.parametrize("name", laws())
def test_the_error_stays_within_its_bound(name: str, device: str, number: str, tmp_path: Path) -> None:
    """Whatever the hand does; beside the same program in fractions, without the converter's rounding."""
    m = made(DEVICES[device], name, number)
    law, exact, random = HostLaw(text(m), tmp_path), ExactProgram(m.law), np.random.default_rng(len(name))
    for counts in tried(exact, random):
        start = int(random.integers(-MOST, MOST))
        law.init(start)
        exact.init(start)
        for n, unit in zip(counts, law.run(counts), strict=True):
            force = Fraction(float(unit)) * Fraction(law.force_per_unit)
            assert abs(force - exact.step(int(n))) <= m.error
            assert abs(force) <= m.largest_force


@pytest.mark.parametrize("number", ["float", "fixed"])
@pytest.mark.parametrize("name", laws())
def test_it_begins_within_its_bound_and_stays_there(name: str, number: str, tmp_path: Path) -> None:
    """Of the force at rest that the simulator gives, after init and reset, for as long as it waits."""
    m = made(PADDLE, name, number)
    law, period = HostLaw(text(m), tmp_path), PADDLE.exact("sample_period")
    for n in (-MOST, -7, 0, 1, 2, 391, MOST):
        there = PrescribedMotion([n * float(PADDLE.exact("resolution"))] * 2)
        loop = prepare(PADDLE, laws()[name], there, period, encoder_phase=0.5)
        rest = sampled_force(loop.law, loop.memory, n)
        for begin in (partial(law.init, n), law.reset):
            begin()
            assert np.abs(law.run([n] * 40) * law.force_per_unit - rest).max() <= m.error + 1e-9 * abs(rest)


@pytest.mark.parametrize("number", ["double", "float", "fixed"])
@pytest.mark.parametrize(
    "name", [n for n in laws() if n.startswith(("wall", "solid", "maxwell", "everywhere"))]
)
def test_the_exact_law_is_h_of_z(name: str, number: str, tmp_path: Path) -> None:
    """The same against H(z) with the decimals that were typed, from rest at the surface."""
    m = made(STEPPED, name, number)
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
    m = made(DEVICES[device], name, "fixed")
    random = np.random.default_rng(3)
    counts = np.concatenate([*motions(random, MOST, 7000), [2**31 - 1, -(2**31), 0, MOST, -MOST] * 100])
    watched(text(m), counts.astype(np.int32), tmp_path, start=MOST)


@pytest.mark.parametrize("name", laws())
def test_every_number_stays_within_its_bound(name: str) -> None:
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


@pytest.mark.parametrize("name", [n for n in laws() if n.startswith("everywhere")])
def test_no_bound_of_a_filter_is_tighter(name: str) -> None:
    """Readings with the signs of its answer bring each place of its memory to the bound, but for 10⁻³."""
    law = law_program(PADDLE, laws()[name])
    given = {law.program.parameters[0]: plain(-MOST, MOST)}
    rest = Rest(rest_ends(law, (-MOST, MOST)), (0.0,) * law.remembers)
    found = invariant(law.program, given, rest, Exact())
    exact, reached = ExactProgram(law), [Fraction(0)] * law.remembers
    for n in (1, *[0] * 400):
        exact.step(n)
        reached = [most + abs(c) * MOST for most, c in zip(reached, exact.cells, strict=True)]
    for most, (low, high, _) in zip(reached, found.memory, strict=True):
        assert most <= min(-low, high)
        assert max(-low, high) <= float(most) * 1.001


SLOW = {
    "one pole": zw.Wall(300, "0.2", zw.rendering.OnePole("200 ms")),
    "two poles": zw.PulseTransferFunction(["81.3", "-157.1", "75.9"], [1, "-1.9", "0.9025"]),
    "solid": zw.StandardLinearSolid(200, 300, 60),
}


@pytest.mark.parametrize("number", ["float", "fixed"])
@pytest.mark.parametrize("name", SLOW)
def test_what_is_told_of_slow_filters_is_near_what_is_found(name: str, number: str, tmp_path: Path) -> None:
    """A hand that waits at some of 200 readings makes it a tenth of the bound, at least."""
    require("host")
    ways, most = {}, 25_000
    for kind in (number, "double"):
        m = machine(law_program(PADDLE, SLOW[name]), kind, (-most, most))
        (tmp_path / kind).mkdir()
        ways[kind] = m, HostLaw(text(m), tmp_path / kind)
    worst, random = 0.0, np.random.default_rng(1)
    for n in random.integers(0, most, 200):
        off = []
        for _, law in ways.values():
            law.init(int(n))
            off.append(law.run(np.full(1000, n)) * law.force_per_unit)
        worst = max(worst, np.abs(off[0] - off[1]).max())
    assert ways[number][0].error / 10 < worst <= ways[number][0].error + ways["double"][0].error
