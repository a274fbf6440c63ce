"""Storage functions and motions that were tampered with: rejected with a reason, never an exception."""

from __future__ import annotations

import base64
import copy
import json
import zlib
from fractions import Fraction
from functools import cache
from random import Random

import numpy as np
import pytest

import zwidth as zw
from zwidth import checker
from zwidth.passivity.storage.grid import Grid
from zwidth.passivity.storage.program import program_of
from zwidth.passivity.storage.storage_function import StorageFunction
from zwidth.passivity.storage.value_iteration import value_iteration

BOUNDS = {"penetration": "0.0006", "speed": "0.3"}


def device(damping, friction, delay=0, **more):
    """A device of 0.1 mm a count at 1 kHz, the delay in samples."""
    return zw.Device(
        damping=damping,
        coulomb_friction=friction,
        resolution="0.0001",
        sample_period="0.001",
        delay=Fraction(delay, 1000),
        **more,
    )


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
    counted = {f"force_{key}": getattr(loop, f"force_{key}") is not None for key in ("limit", "resolution")}
    program = program_of(loop, law, **counted, **BOUNDS)

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


def packed(value):
    """V as it stands in a document."""
    return base64.b64encode(zlib.compress(np.asarray(value).astype("<i8").tobytes())).decode("ascii")


def changed(document, path, value):
    """A copy with one entry replaced, or taken away."""
    tampered = copy.deepcopy(document)
    inner = tampered
    for key in path[:-1]:
        inner = inner[key]
    if value is None:
        del inner[path[-1]]
    else:
        inner[path[-1]] = value
    return tampered


def rejected(document):
    """The reason why a document is not accepted."""
    verification = checker.verify(document)
    assert not verification.valid, verification.reason
    assert verification.reason
    assert "\n" not in verification.reason
    return verification.reason


def scaled(text, factor):
    """An exact number times a factor."""
    return str(Fraction(text) * Fraction(factor))


WORSE = {
    "damping_N_s_per_m": "0.99999",
    "coulomb_friction_N": "0.99999",
    "resolution_m": "1.00001",
    "sample_period_s": "1.00001",
    "delay_s": "0",
}


@pytest.mark.parametrize("key", WORSE)
@pytest.mark.parametrize("name", LOOPS)
def test_every_number_of_the_loop_binds(name, key):
    """A hundred thousandth for the worse is too much; another delay, more or less, has other states."""
    _, document = least(name)
    loop = document["loop"]
    if key == "delay_s":
        for delay in ("0", "0.001", "0.002", "0.0005", "1", "-0.001"):
            if Fraction(delay) != Fraction(loop[key]):
                rejected(changed(document, ("loop", key), delay))
        return
    factor = "1.1" if (name, key) == ("stepped", "resolution_m") else WORSE[key]  # less changes no step
    worse = changed(document, ("loop", key), scaled(loop[key], factor))
    if key == "sample_period_s":
        worse["loop"]["delay_s"] = scaled(loop["delay_s"], WORSE[key])
    assert "takes out more" in rejected(worse)
    for bad in ("-1", "nan", "inf", "", "1/0", True, [], {}):
        rejected(changed(document, ("loop", key), bad))
    rejected(changed(document, ("loop", key), None))


@pytest.mark.parametrize("name", LOOPS)
def test_every_number_of_the_law_binds(name):
    """Taps, points and the force limit changed for the worse; clamped and surface."""
    _, document = least(name)
    law = document["law"]
    if law["taps_N_per_m"]:
        factor = "1.1" if name == "stepped" else "1.00001"  # less changes no step
        first = [scaled(law["taps_N_per_m"][0], factor), *law["taps_N_per_m"][1:]]
        rejected(changed(document, ("law", "taps_N_per_m"), first))
        rejected(changed(document, ("law", "taps_N_per_m"), [*law["taps_N_per_m"], "0"]))
        rejected(changed(document, ("law", "taps_N_per_m"), []))
        rejected(changed(document, ("law", "surface"), "none"))
    else:
        for i, (x, f) in enumerate(law["points_m_N"]):
            if name == "contact" and i == 0:
                continue  # on the surface there is no force whatever the point says
            points = copy.deepcopy(law["points_m_N"])
            worse = Fraction(1, 10) if name == "contact" else Fraction(1 if i >= 2 else -1, 1000)
            points[i] = [x, str(Fraction(f) + worse)]
            rejected(changed(document, ("law", "points_m_N"), points))
        rejected(changed(document, ("law", "points_m_N"), law["points_m_N"][::-1]))
        rejected(changed(document, ("law", "points_m_N"), [["0"]]))
        rejected(changed(document, ("law", "points_m_N"), []))
    if name == "contact":
        for rate in ("1.00001", "2", "-1"):
            rejected(changed(document, ("law", "rate_per_m"), scaled(law["rate_per_m"], rate)))
        for rate in (None, "0", "nan", [], True):
            rejected(changed(document, ("law", "rate_per_m"), rate))
        rejected({**document, "law": {**law, "taps_N_per_m": ["1", "-1"], "points_m_N": []}})
    if name == "clamped":
        rejected(changed(document, ("law", "clamped"), False))
    if name == "limited":
        rejected(changed(document, ("law", "force_limit_N"), scaled(law["force_limit_N"], "1.001")))
        rejected(changed(document, ("law", "force_limit_N"), None))
        rejected(changed(document, ("law", "force_limit_N"), "-0.1"))
    if name == "stepped":
        for step in ("1.001", "0.999", "0.5", "2"):
            rejected(changed(document, ("law", "force_step_N"), scaled(law["force_step_N"], step)))
        for step in (None, "0", "-0.04", "nan", [], True):
            rejected(changed(document, ("law", "force_step_N"), step))
    for bad in ("yes", "", 1):
        rejected(changed(document, ("law", "clamped"), bad))
        rejected(changed(document, ("law", "surface"), bad))
    rejected(changed(document, ("law", "friction"), "1"))
    rejected(changed(document, ("law",), []))


@pytest.mark.parametrize("name", LOOPS)
def test_every_number_of_the_grid_binds(name):
    """Cells, reach, steps and unit, one more or less; and sizes that no grid has."""
    _, document = least(name)
    domain = document["domain"]
    for key in domain:
        for value in (domain[key] + 1, domain[key] - 1, 10**30, 10**7, "0.5", "nan", None):
            if key == "largest_move_counts" and name == "points" and value in (2, 4, "0.5"):
                continue  # no reading is remembered: all moves are checked, and all of them hold
            rejected(changed(document, ("domain", key), value))
    for unit in (scaled(document["force_unit"], "1/2"), "0", "-1", "nan", "1e-4000", "1e4000"):
        rejected(changed(document, ("force_unit",), unit))
    for key in ("loop", "law", "domain", "force_unit", "storage"):
        assert key in rejected(changed(document, (key,), None))


@pytest.mark.parametrize("name", LOOPS)
def test_one_value_less_by_one_unit(name):
    """Every positive value is attained by a move: one unit less anywhere is too little."""
    iteration, document = least(name)
    value, random = iteration.value, Random(name)
    places = np.argwhere(value > 0)
    assert len(places) > 10
    for at in random.sample([tuple(p) for p in places], min(len(places), 100)):
        less = value.copy()
        less[at] -= 1
        assert "takes out more" in rejected(changed(document, ("storage",), packed(less)))


@pytest.mark.parametrize("name", LOOPS)
def test_one_value_far_too_large(name):
    """What is said to be stored in one place must be stored in those from where one comes there."""
    iteration, document = least(name)
    random, cells = Random(name), len(iteration.value)
    middle = iteration.grid.histories // 2
    for _ in range(20):
        more = iteration.value.copy()
        cell, node = random.randrange(1, cells - 1), random.randrange(more.shape[2])
        more[cell, middle, node] += 2**40
        assert "takes out more" in rejected(changed(document, ("storage",), packed(more)))


@pytest.mark.parametrize("name", LOOPS)
def test_values_that_are_none(name):
    """Text cut short, another number of values, below 0, too large, no text."""
    iteration, document = least(name)
    text, value = document["storage"], iteration.value
    negative = value.copy()
    negative[np.unravel_index(value.argmin(), value.shape)] = -1
    reasons = {
        "cut": (text[: len(text) // 2 // 4 * 4], ""),
        "cut inside a letter": (text[:-3], "unpacked"),
        "no base64": ("µ" + text[1:], "unpacked"),
        "not packed": (base64.b64encode(value.tobytes()).decode("ascii"), "unpacked"),
        "one too few": (packed(value.ravel()[:-1]), "one value for each"),
        "one too many": (packed(np.append(value.ravel(), 0)), "one value for each"),
        "empty": ("", ""),
        "no text": (value.ravel().tolist(), "must be text"),
        "below 0": (packed(negative), "bounded below by 0"),
        "lowest of all": (packed(np.full_like(value, -(2**63))), "bounded below by 0"),
        "too large": (packed(value + 2**54), "too large"),
        "largest of all": (packed(np.full_like(value, 2**63 - 1)), "too large"),
        "none stored": (packed(np.zeros_like(value)), "takes out more"),
    }
    for tampered, said in reasons.values():
        assert said in rejected(changed(document, ("storage",), tampered))


def test_a_force_that_wraps_around_is_not_believed():
    """2⁶³ units of force a count pass through a 64-bit number as none: a motion gains from this law."""
    loop = {
        "damping_N_s_per_m": "0",
        "coulomb_friction_N": "10",
        "resolution_m": "1",
        "sample_period_s": "1",
        "delay_s": "1",
    }
    law = {"surface": "none", "clamped": True, "taps_N_per_m": [str(-(2**63))]}
    repeats = {"first": 0, "last": 2, "times": 20}
    positions = ["0", "-1/1000", "0"]
    motion = {
        "kind": "contact motion",
        "loop": loop,
        "law": law,
        "repeats": repeats,
        "positions_m": positions,
    }
    motion["energy_J"] = checker.verify({**motion, "energy_J": 0}).energy
    assert checker.verify(motion).valid
    domain = {"lowest_count": -1, "highest_count": 0, "largest_move_counts": 1, "steps_per_count": 1}
    proof = {"kind": "storage", "loop": loop, "law": law, "domain": domain, "force_unit": "1"}
    rejected({**proof, "storage": packed(np.zeros((2, 3, 2)))})


@pytest.mark.parametrize(
    "reach",
    [10**12, 10**30],
)
def test_a_reach_beyond_every_memory(reach):
    """Without memory the reach is in no shape; it is bounded all the same, before anything is allocated."""
    loop = least("points")[1]["loop"]
    law = {"surface": "none", "clamped": False, "taps_N_per_m": ["0"]}
    domain = {"lowest_count": 0, "highest_count": 0, "largest_move_counts": reach, "steps_per_count": 1}
    proof = {"kind": "storage", "loop": loop, "law": law, "domain": domain, "force_unit": "1e-12"}
    rejected({**proof, "storage": packed(np.zeros((1, 1, 2)))})


WORDS = (None, True, 0, -1, 1.5, "nan", "1/0", "x", [], {}, [[]], 10**40, "1e4999", "-1e4999", float("inf"))
"""What may stand anywhere in a document by mistake, or on purpose."""


def _paths(document, before=()):
    if isinstance(document, dict):
        for key, value in document.items():
            yield (*before, key)
            yield from _paths(value, (*before, key))
    elif isinstance(document, list):
        for i, value in enumerate(document):
            yield (*before, i)
            yield from _paths(value, (*before, i))


@pytest.mark.parametrize("name", ["damped", "points", "motion"])
def test_nothing_in_a_document_raises(name):
    """Any entry replaced by any word: a verdict and a reason, always."""
    document = active()[1] if name == "motion" else least(name)[1]
    seen = 0
    for path in _paths(document):
        for word in WORDS:
            verification = checker.verify(changed(document, path, word))
            assert verification.reason
            seen += not verification.valid
    assert seen > 50


@cache
def active():
    """A wall that is too stiff, and the document of a motion that gains."""
    loop = device("0.2", "0.02", 0)
    program = program_of(loop, zw.Wall(300, "0.1"), **BOUNDS)
    motion = program.refute(1024)
    assert motion is not None
    document = json.loads(json.dumps(motion.to_dict(), default=str))
    assert checker.verify(document).valid
    return motion, document


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("loop", "damping_N_s_per_m"), "2", "none comes out"),
        (("loop", "coulomb_friction_N"), "1", "none comes out"),
        (("loop", "sample_period_s"), "0.0000001", "keep to its speed"),
        (("bounds", "depth_m"), "0", "keep to its depth"),
        (("bounds", "force_N"), "1", "no proof of this kind has: bounds.force_N"),
        (("loop", "resolution_m"), "1", "none comes out"),
        (("loop", "resolution_m"), "0", "must be > 0"),
        (("loop", "delay_s"), "0.0005", "switch_positions is missing"),
        (("loop", "delay_s"), "1", "longer than can be checked"),
        (("law", "taps_N_per_m"), ["0", "0"], "none comes out"),
        (("law", "taps_N_per_m"), ["-400", "100"], "none comes out"),
        (("law", "taps_N_per_m"), [], "either taps or points"),
        (("law", "surface"), "wall", "surface must be"),
        (("law", "clamped"), "no", "clamped must be true or false"),
        (("repeats", "first"), 10**6, "must lie in the motion"),
        (("repeats", "first"), -1, "first must be ≥ 0"),
        (("repeats", "last"), 0, "must lie in the motion"),
        (("repeats", "times"), 0, "times must be ≥ 1"),
        (("repeats", "times"), 1, "not settled"),
        (("positions_m", 0), "0.0002", "begin at rest"),
        (("positions_m", -1), "0", ""),
        (("positions_m",), [], "positions_m must have 2"),
        (("positions_m",), ["0"] * 100_001, "positions_m must have 2"),
        (("positions_m",), None, "positions_m is missing"),
        (("repeats",), None, "repeats is missing"),
        (("law",), None, "law is missing"),
    ],
)
def test_a_motion_that_was_tampered_with(path, value, said):
    """Losses, law, clock, cycle and start: each of them binds."""
    assert said in rejected(changed(active()[1], path, value))


def test_the_energy_of_a_motion_is_that_of_the_law_written_out():
    """The checker and the definition agree to the last digit, over all rounds."""
    from plain_iteration import exact_force

    motion, document = active()
    program = program_of(device("0.2", "0.02", 0), zw.Wall(300, "0.1"), **BOUNDS)
    positions = motion.motion.listed().positions
    step, out = program.losses.resolution, Fraction(0)
    counts = [x // step for x in positions]
    for k in range(len(positions) - 1):
        d = positions[k + 1] - positions[k]
        force = exact_force(program.law, [counts[k], counts[max(k - 1, 0)]], step)
        out -= force * d + program.losses.coulomb_friction * abs(d)
        out -= program.losses.damping / program.losses.period * d**2
    assert checker.verify(document).energy == motion.exact_energy == out
    more = changed(document, ("repeats", "times"), document["repeats"]["times"] + 1)
    assert checker.verify(more).energy - out == motion.exact_gain
