"""Smallest storage functions: one unit less anywhere, a device or a law a little worse, is refused."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from functools import cache
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from counted_device import counted, device
from plain_iteration import exact_force
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.passivity.storage.chain_document import packed
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.program import program_of
from zwidth.passivity.storage.storage_function import StorageFunction
from zwidth.passivity.storage.value_iteration import value_iteration

BOUNDS = {"penetration": "0.0006", "speed": "0.3"}


LOOPS = {
    "damped": (device("0.26", "0.027"), zw.Wall(300, "0.1")),
    "clamped": (device("0.26", "0.027"), zw.Wall(300, "0.1", clamped=True)),
    "delayed": (device("0.46", "0.017", 1), zw.Wall(300)),
    "limited": (device("0.26", "0.027", force_limit="0.1"), zw.Wall(300, "0.1")),
    "stepped": (device("0.5", "0.043", force_resolution="0.04", force_limit="0.2"), zw.Wall(300, "0.1")),
    "contact": (device("0.9", "0.08"), zw.HuntCrossley(20000, "1.5", 2)),
    "points": (
        device("0.16", "0.0165"),
        zw.NonlinearSpring([-4e-4, -2e-4, 0, 2e-4, 4e-4], [0, "-0.05", 0, "0.05", 0]),
    ),
}


@cache
def least(name):
    """The smallest storage function there is, every value of it attained by a move; and its document."""
    loop, law = LOOPS[name]
    program = program_of(loop, law, **counted(loop), **BOUNDS)

    class FromNothing(Grid):
        """A grid whose search starts at 0."""

        first_guess = property(lambda b: np.zeros((b.domain.cells, b.histories, len(b.nodes)), np.int64))

    iteration = value_iteration(FromNothing(program.law, program.losses, program.domain, 8, "outer"))
    assert iteration.value is not None
    document = json.loads(
        json.dumps(StorageFunction(iteration, "linear").certificate().to_dict(), default=str)
    )
    verification = checker.verify(document)
    assert verification.valid, verification.reason
    return iteration, document


def refused(document, path, value):
    """What is said where one entry is another."""
    verification = checker.verify(tampered(document, path, value))
    assert not verification.valid, (path, value)
    return verification.reason


def scaled(text, factor):
    return str(Fraction(text) * Fraction(factor))


WORSE = {
    "damping_N_s_per_m": "0.99999",
    "coulomb_friction_N": "0.99999",
    "resolution_m": "1.00001",
    "sample_period_s": "1.00001",
}


@pytest.mark.parametrize("key", WORSE)
@pytest.mark.parametrize("name", LOOPS)
def test_every_number_of_the_loop_binds(name, key):
    _, document = least(name)
    factor = "1.1" if (name, key) == ("stepped", "resolution_m") else WORSE[key]  # less changes no step
    loop = document["loop"] | {key: scaled(document["loop"][key], factor)}
    if key == "sample_period_s":
        loop["delay_s"] = scaled(loop["delay_s"], factor)
    assert "takes out more" in refused(document, ("loop",), loop)


def worse_laws(name, law):
    """An entry of the law, and what it may not be."""
    if taps := law["taps_N_per_m"]:
        yield "taps_N_per_m", [scaled(taps[0], "1.1" if name == "stepped" else "1.00001"), *taps[1:]]
    more = Fraction(1, 10) if name == "contact" else Fraction(1, 1000)
    for i, (x, f) in enumerate(law.get("points_m_N", [])):
        if name == "contact" and i == 0:
            continue  # on the surface there is no force whatever the point says
        points = copy.copy(law["points_m_N"])
        points[i] = [x, str(Fraction(f) + (more if i >= 2 or name == "contact" else -more))]
        yield "points_m_N", points
    yield from {
        "contact": [("rate_per_m", scaled(law.get("rate_per_m", 0), "1.00001"))],
        "clamped": [("clamped", False)],
        "limited": [("force_limit_N", scaled(law.get("force_limit_N", 0), "1.001"))],
        "stepped": [("force_step_N", scaled(law.get("force_step_N", 0), f)) for f in ("1.001", "0.5", "2")],
    }.get(name, [])


@pytest.mark.parametrize("name", LOOPS)
def test_every_number_of_the_law_binds(name):
    _, document = least(name)
    for key, value in worse_laws(name, document["law"]):
        assert "takes out more" in refused(document, ("law", key), value)


@pytest.mark.parametrize("name", LOOPS)
def test_one_value_less_by_one_unit(name):
    iteration, document = least(name)
    value, random = iteration.value, Random(name)
    places = np.argwhere(value > 0)
    assert len(places) > 10
    for at in random.sample([tuple(p) for p in places], min(len(places), 100)):
        less = value.copy()
        less[at] -= 1
        assert "takes out more" in refused(document, ("storage",), packed(less))


def test_the_energy_of_a_motion_is_that_of_the_law_written_out():
    """The checker and the definition agree to the last digit, over all rounds."""
    program = program_of(device("0.2", "0.02"), zw.Wall(300, "0.1"), **BOUNDS)
    motion = program.refute(1024)
    document = json.loads(json.dumps(motion.to_dict(), default=str))
    positions, losses, out = motion.motion.listed().positions, program.losses, Fraction(0)
    counts = [x // losses.resolution for x in positions]
    for k, (here, there) in enumerate(pairwise(positions)):
        d, readings = there - here, [counts[k], counts[max(k - 1, 0)]]
        force = exact_force(program.law, readings, losses.resolution)
        out -= force * d + losses.coulomb_friction * abs(d) + losses.damping / losses.period * d**2
    assert checker.verify(document).energy == motion.exact_energy == out
    more = tampered(document, ("repeats", "times"), document["repeats"]["times"] + 1)
    assert checker.verify(more).energy - out == motion.exact_gain
