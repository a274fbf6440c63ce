"""Laws in a chain: the table of the law, value iteration on it, its proofs and motions."""

from __future__ import annotations

import base64
import json
import zlib
from fractions import Fraction
from functools import cache
from random import Random

import numpy as np
import pytest
from counted_device import counted, device
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.loop.kernel import after_every_reading, scratch
from zwidth.model import rendering
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.storage import same_law
from zwidth.passivity.storage.chain_document import packed
from zwidth.passivity.storage.program import program_of
from zwidth.passivity.witness.motion import saved_motion
from zwidth.show.plots import storage as storage_figure

BOUNDS = {"penetration": "0.0008", "speed": "0.4"}
FREE = rendering.SlewLimit(10**9)
"""A law that does nothing: no force changes so fast."""


DEVICE = device("0.26", "0.027")


def decided(environment, *laws, at=DEVICE, **more):
    return zw.available_storage(at, zw.render(environment, *laws), **{**BOUNDS, **more})


@cache
def proved():
    """A storage function of a wall with hysteresis and a force limit, and its document as it is saved."""
    found = decided(zw.Wall(200), rendering.Hysteresis("0.005", 150), rendering.Saturation("0.11"))
    assert found.outcome == "passive"
    return found, json.loads(json.dumps(found.certificate.to_dict(), default=str))


@cache
def refuted():
    """A motion against the same with too wide a hysteresis."""
    found = decided(zw.Wall(200), rendering.Hysteresis("0.05", 900))
    assert found.outcome == "active"
    return found


SAME = {
    "a law that does nothing": (DEVICE, FREE),
    "the same, a sample late": (device("0.46", "0.047", 1), FREE),
    "saturation is the force limit": (device("0.2", "0.02", force_limit="0.06"), rendering.Saturation()),
    "converter steps": (device("0.5", "0.043", force_resolution="0.04"), FREE),
}


@pytest.mark.parametrize("name", SAME)
def test_the_bracket_of_a_wall_alone_is_that_of_the_wall_behind_such_a_law(name):
    """Value iteration on the table and on differences of readings find the same limit."""
    at, law = SAME[name]
    alone = zw.limit(at, zw.Wall(300), **BOUNDS, **counted(at))
    rest = counted(at) if law is FREE else {}  # a saturation takes the place of the force limit
    row = zw.limit(at, zw.render(zw.Wall(300), law), **BOUNDS, **rest)
    assert row.relative_width <= 0.01
    assert alone.relative_width <= 0.01
    assert row.proved_passive < alone.proved_active
    assert alone.proved_passive < row.proved_active
    assert row.certificate.kind == "row storage"
    assert row.scope.hands.outside == row.scope.hands.inside


@pytest.mark.parametrize("stiffness", [150, 180, 200, 220, 260])
def test_looking_ahead_is_a_filter_of_two_readings(stiffness):
    """x̂ = x_k + ½ (x_k − x_{k−1}) before a spring on both sides is H(z) = K (1.5 − 0.5/z)."""
    at = device("0.12", "0.02")
    row = decided(zw.PulseTransferFunction([stiffness], [1]), rendering.Extrapolation(), at=at)
    filtered = zw.PulseTransferFunction([1.5 * stiffness, -0.5 * stiffness], [1, 0])
    other = zw.available_storage(at, filtered, **BOUNDS)
    assert row.outcome == other.outcome != "undecided"


def test_the_same_hysteresis_in_steps_of_a_table_is_that_of_the_simulator():
    """A hand at random, in the simulator: each force is that of the state to which the table leads."""
    law = zw.render(zw.Wall(200), rendering.Hysteresis("0.03", 700), rendering.Held(samples=3))
    table = program_of(DEVICE, law, **BOUNDS).table
    random = Random(7)
    counts = [-1]
    while len(counts) < 400:
        counts.append(min(max(counts[-1] + random.randint(-4, 4), table.lowest), table.highest))
    x = [(n + random.uniform(0.02, 0.98)) * 1e-4 for n in counts]
    trace = zw.simulate(DEVICE, law, zw.operators.PrescribedMotion(x), duration=(len(x) - 1) / 1000)
    forces = trace["actuator_force"].values
    assert (np.diff(forces) != 0).sum() > 50
    state = next(s for s in table.starts if table.counts[s] == counts[0])
    for n, m, force in zip(counts, counts[1:], forces, strict=False):
        assert table.counts[state] == n
        assert table.forces[state] == force
        state = table.successors[state, m - n + table.reach]


def test_no_move_of_random_hands_takes_out_more_than_the_storage_falls():
    """Anywhere between the nodes, in exact arithmetic, with the true cost of a move."""
    found, _ = proved()
    grid, value = found.storage.grid, found.storage.value
    table, steps = grid.table, grid.steps
    f_c, b, delta = Fraction("0.027"), Fraction("0.26"), Fraction("0.0001")

    def stored(state, x):
        inside = (x / delta - int(table.counts[state])) * steps
        node = min(int(inside), steps - 1)
        low, high = (int(v) for v in value[state, node : node + 2])
        return (low + (high - low) * (inside - node)) * grid.energy_unit

    random = Random(3)
    state = int(table.starts[0])
    x = (int(table.counts[state]) + Fraction(1, 3)) * delta
    tight = 0
    for _ in range(5000):
        far = Fraction(random.choice([1, 5, 30, 200, 400]) * random.randint(-1000, 1000), 10**5)
        to = min(max(x + far * delta, table.lowest * delta), (table.highest + 1) * delta - delta / 10**6)
        count = to // delta
        then = int(table.successors[state, int(count - table.counts[state]) + table.reach])
        d = to - x
        out = -Fraction(float(table.forces[state])) * d - f_c * abs(d) - b * 1000 * d * d
        fallen = stored(state, x) - stored(then, to)
        assert out <= fallen
        tight += out > 0
        state, x = then, to
    assert tight > 20  # moves that are paid


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (rendering.PassivityController(), r"does not close within 100,000 states .* remembers too much"),
        (rendering.Damper("0.05", rendering.AdaptiveWindow(longest=1000)), r"within 19,\d+ states"),
    ],
    ids=["the energy that was counted", "a thousand readings: few states are enough to say no"],
)
def test_a_law_that_remembers_too_much_is_refused(law, said):
    with pytest.raises(zw.InputError, match=said):
        decided(zw.Wall(200), law)


def test_an_adaptive_window_of_three_readings_closes():
    short = rendering.Damper("0.05", rendering.AdaptiveWindow(longest=3))
    assert decided(zw.Wall(100), short, penetration="0.0004", speed="0.3").outcome == "passive"


def test_bounds_are_chosen_where_none_are_given():
    """The largest of a few grids on which the law closes quickly; a short memory has a large one."""
    little = program_of(DEVICE, zw.render(zw.Wall(100), FREE))
    much = program_of(DEVICE, zw.render(zw.Wall(100), rendering.DualRate(samples=3)))
    assert (little.domain.highest, little.domain.reach) == (31, 16)
    assert much.domain.highest < 31


def test_what_cannot_be_iterated_is_said():
    law = zw.render(zw.Wall(200), FREE)
    for at, more, said in (
        (DEVICE.replace(delay="0.0005"), {}, "delays of whole samples"),
        (DEVICE, {"force_limit": True}, "force_limit is to be counted in"),
        (DEVICE.replace(resolution=0), {}, "ideal encoder"),
    ):
        with pytest.raises(zw.InputError, match=said):
            zw.available_storage(at, law, **more)
    with pytest.raises(zw.InputError, match=r"laws are not linear.*zwidth\.check"):
        law.pulse_transfer_function(DEVICE.exact("sample_period"))


def test_a_motion_is_replayed_by_the_simulator():
    """The simulator counts in each round what exact arithmetic does, and in all more than went in."""
    found = refuted()
    assert found.witness.verify()
    hand = zw.operators.WitnessMotion(found.witness, rounds=3000)
    duration = hand.intervals * DEVICE.exact("sample_period")
    trace = zw.simulate(DEVICE, found.environment, hand, duration=duration)
    assert trace.zwidth.energy.extracted > 0.01
    taken = -trace["hand_work"].values
    samples = len(found.witness.cycle) - 1
    per_round = (taken[-1] - taken[-1 - 1000 * samples]) / 1000
    assert per_round == pytest.approx(found.witness.energy_per_cycle, rel=1e-6)
    assert found.witness.peak_speed <= 0.4 * (1 + 1e-12)


def test_the_documents_survive_being_saved(tmp_path):
    for found in (proved()[0], refuted()):
        found.save(tmp_path / "found.json")
        document = read_document(tmp_path / "found.json")
        assert verify_document(document).valid
        part = document["certificate" if found.outcome == "passive" else "witness"]
        assert same_law(part, DEVICE, found.environment)
    assert saved_motion(document, "found").positions == refuted().witness.motion.positions


def test_another_law_is_not_the_same():
    found, document = proved()
    row = found.environment.laws
    assert same_law(document, DEVICE, found.environment)
    assert not same_law(document, DEVICE, zw.render(zw.Wall("200.0000001"), *row))
    assert not same_law(document, DEVICE, zw.render(zw.Wall(200), row[0]))
    motion = refuted().witness.to_dict()
    assert same_law(motion, DEVICE, refuted().environment)
    assert not same_law(motion, DEVICE, zw.render(zw.Wall("200.0000001"), *refuted().environment.laws))
    # a weaker force does not break the storage function, and twice the force gains more
    forces = numbers(document["table"]["forces"], "<f8")
    forces[forces.argmax()] = np.nextafter(0.11, 0)
    weaker = tampered(document, ["table", "forces"], packed(forces, "<f8"))
    stronger = tampered(motion, ["forces_N"], [2 * f for f in motion["forces_N"]])
    stronger["energy_J"] = checker.verify(stronger).energy
    for other, environment in ((weaker, found.environment), (stronger, refuted().environment)):
        assert checker.verify(other).valid
        assert not same_law(other, DEVICE, environment)
    with pytest.raises(zw.InputError, match="row storage or row motion"):
        same_law({"kind": "storage"}, DEVICE, found.environment)


def numbers(text, kind="<i8"):
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), kind).copy()


def test_every_value_of_a_least_storage_function_binds():
    """The search begins at nothing, so that a move attains each value: less of any is too little."""
    _, document = proved()
    value = numbers(document["storage"])
    for i in Random(1).sample(list(np.flatnonzero(value > 0)), 25):
        value[i] -= 1
        less = checker.verify(tampered(document, ["storage"], packed(value)))
        assert "more energy than was stored" in less.reason
        value[i] += 1


def test_the_storage_is_shown_over_all_that_the_law_may_remember():
    """V at least and at most, along the position, in joules."""
    found, _ = proved()
    energy = found.available_storage()
    assert energy.dims == ("remembered", "position")
    least, most = energy.sel(remembered="least"), energy.sel(remembered="most")
    assert (most >= least).all()
    assert float((most - least).max()) > 0
    storage = found.storage
    assert float(most.max()) == float(storage.value.max() * storage.grid.energy_unit)
    lines = storage_figure(found).axes[0].lines
    assert [line.get_gid() for line in lines] == ["most"]


def test_a_reading_off_the_grid_leaves_its_row_alone():
    """The step that the table is made of stays on the grid."""
    program = program_of(DEVICE, zw.render(zw.Wall(200), FREE), **BOUNDS)
    row = program.law.starts[0]
    out = np.full((1, 5, len(row)), 7.0)
    after_every_reading(program.law.packed, row[None, :], np.array([0.0]), 1, -1, 1, scratch(), out)
    assert (out[0, [0, 4]] == 7).all()
    assert (out[0, 1:4, -1] == [0, 0, 200 * 1e-4]).all()


def test_a_limit_is_sought_on_one_domain():
    """Where no bounds are given, those on which the law closes as it is hold for every value."""
    law = zw.render(zw.Wall(200), rendering.DualRate(samples=2))
    bracket = zw.limit(DEVICE, law)
    grid = bracket.storage.grid
    assert (grid.domain.highest + 1, grid.domain.reach) == program_of(DEVICE, law).counts
    assert f"({grid.domain.highest + 1} counts) on either side" in bracket.hand
    assert bracket.proved_passive > 10**12  # its slope is never more than 2b/T
    assert bracket.proved_active is None


def test_a_limit_of_the_device_behind_laws():
    """The friction that h + KΔ/2 asks for, found from both sides."""
    law = zw.render(zw.Wall(200), rendering.Hysteresis("0.04", 2000))
    bracket = zw.limit(device("0.5", "0.05"), law, "coulomb_friction", **BOUNDS)
    assert bracket.proved_active < 0.05 < bracket.proved_passive
    assert bracket.relative_width <= 0.01
    with pytest.raises(zw.InputError, match="no parameter 'force'"):
        zw.limit(DEVICE, law, "force")
