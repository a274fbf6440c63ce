"""A law that begins, or is reset, is at rest: as if the hand had been where it is for ever."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from firmware.adversary import text
from firmware.emitted_laws import Law, laws
from firmware.emulated.host import HostLaw
from firmware.emulated.required import require
from firmware.random_laws import PADDLE
from firmware.random_laws import laws as bounded
from strategies import seeds

import zwidth as zw
from zwidth.loop.law import sampled_force
from zwidth.loop.setup import Setup, prepare, resting_memory
from zwidth.machine.firmware.law import law_program
from zwidth.machine.firmware.machine import machine
from zwidth.machine.servo.cycle import pack, put_at_rest
from zwidth.model.operator import PrescribedMotion


def laid_out(law: Law, counts: int) -> Setup:
    device, environment = law
    there = PrescribedMotion([counts * float(device.exact("resolution"))] * 2)
    return prepare(device, environment, there, device.exact("sample_period"), encoder_phase=0.5)


def test_a_solid_that_relaxes_pushes_as_its_spring(tmp_path: Path) -> None:
    """K x, 2 N at 20 mm of 100 N/m, in the simulator and as it is emitted."""
    device = zw.Device(mass="0.1", damping="0.4", resolution="20 um", sample_period="0.001")
    solid, still = zw.StandardLinearSolid(100, 200, "0.5"), PrescribedMotion([0.02001] * 9)
    assert zw.simulate(device, solid, still, "0.008")["commanded_force"].values == pytest.approx(2, rel=1e-12)
    require("host")
    law = HostLaw(text(machine(law_program(device, solid), "double", (-5000, 5000))), tmp_path)
    law.init(1000)
    assert law.run([1000] * 9) == pytest.approx(2, rel=1e-12)


def test_two_lines_hold_what_every_law_remembers() -> None:
    """Outside and inside, to the last bit: what the servo begins with is what the simulator does."""
    random = np.random.default_rng(1)
    for law in [*(make() for make in laws().values()), *((PADDLE, law) for law in bounded().values())]:
        setup, lines = laid_out(law, 0), pack(*law, 0.0, np.inf).rest
        found = np.empty(lines.shape[2])
        for x in [*random.normal(size=20) * 10 ** random.uniform(-6, 0, 20), 0.0, -0.0]:
            put_at_rest(found, lines, x)
            assert np.array_equal(found.view(np.int64), resting_memory(setup, x).view(np.int64))


RELAXING = {
    "solid": zw.StandardLinearSolid(100, 200, 20),
    "solid of two": zw.GeneralizedMaxwell(100, [(150, 3), (80, "0.4")]),
    "one pole": zw.Wall(150, "0.05", zw.rendering.OnePole("20 ms")),
    "filter": zw.PulseTransferFunction([150, -250, 105], [1, "-1.6", "0.64"]),
    "bounding": zw.render(zw.Wall(2000, 1), zw.rendering.ForceBounding()),
}
SLOW = zw.Device(
    mass="0.05", damping="0.2", coulomb_friction="0.02", resolution="20 um", sample_period="0.001"
)


def motion(random: np.random.Generator, samples: int) -> np.ndarray:
    """In and out with pauses, from the surface on [m]: slowly in and quickly out, or as it comes."""
    places, paced = [0.0], random.random() < 0.5
    while len(places) < samples:
        inwards = places[-1] < 0.005
        ways = int(np.exp(random.uniform(*((7, 8.5) if inwards else (0, 4)) if paced else (0, 7))))
        end = (0.02 if inwards else -0.001) * random.random() ** 0.2
        places += [*np.linspace(places[-1], end, ways + 1)[1:], *[end] * int(random.choice([0, 1, 300]))]
    return np.array(places[:samples])


def gained(law: zw.Environment, random: np.random.Generator) -> tuple[float, float, int]:
    """The most that the hand has beyond what the claim counts [J], all it moved [J], the number of resets.

    A reset before a reading, at rest at that one, counts nothing.  One at rest at the reading before counts
    the way since then, times what the force differs by from the one at rest there: that force is still given.
    """
    setup, lines = laid_out((SLOW, law), 0), pack(SLOW, law, 0.0, np.inf).rest
    count, period, friction, damping = (
        float(SLOW.exact(key)) for key in ("resolution", "sample_period", "coulomb_friction", "damping")
    )
    memory, rest = setup.memory.copy(), setup.memory.copy()
    x = motion(random, 6000)
    readings, often = np.floor(x / count), random.choice([0, 0.003, 0.3])
    resets = np.append(np.abs(np.diff(x, 2, prepend=0)) > 1e-9, False) | (random.random(len(x)) < often)
    before, late, has, most, moved = 0.0, 0.0, 0.0, 0.0, 0.0
    for n, way, reset in zip(readings, np.diff(x), resets, strict=False):
        if reset:
            at_once = random.random() < 0.5
            put_at_rest(memory, lines, (n if at_once else before) * count)
            has -= 0.0 if at_once else late
        force = sampled_force(setup.law, memory, int(n))
        put_at_rest(rest, lines, n * count)
        late = abs(force - sampled_force(setup.law, rest, int(n))) * abs(way)
        has -= force * way + friction * abs(way) + damping * way**2 / period
        before, most, moved = n, max(most, has), moved + abs(force * way)
    return most, moved, int(resets.sum())


@seeds(6)
@pytest.mark.parametrize("name", RELAXING)
def test_no_motion_with_resets_gains(name: str, seed: int) -> None:
    """Beyond what the claim counts, at no time, however often the law is reset."""
    random = np.random.default_rng(seed)
    for _ in range(2):
        most, moved, resets = gained(RELAXING[name], random)
        assert most <= 1e-12 * moved
        assert resets
