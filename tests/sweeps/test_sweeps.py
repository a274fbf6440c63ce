"""Sweeps: each loop answered as by itself, the same bits however they are computed, one line on bad input."""

import signal
import sys
from functools import partial
from math import inf, nextafter

import numpy as np
import pytest
import xarray as xr
from strategies import seeds

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms
from zwidth.study.chunks.layout import Worker
from zwidth.study.sweeps import request as requests
from zwidth.study.sweeps.axes import axis
from zwidth.study.sweeps.loops import Loop, changed, parameter
from zwidth.study.sweeps.questions import checked
from zwidth.study.sweeps.request import request
from zwidth.study.sweeps.run import compute
from zwidth.study.sweeps.springs import largest_spring

PADDLE = zw.catalogue.device("haptic-paddle")
WALL = zw.Wall(100)
GRID = {"stiffness": "50:600:7", "delay": "0:2 ms:5"}
POLE = zw.Wall(100, "0.03", zw.rendering.OnePole("1 ms"))
WINDOWED = zw.Wall(100, "0.03", zw.rendering.Window(2))
swept = partial(zw.sweep, workers=1)


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ("100:3000:3", (100, 1550, 3000)),
        ("0:5 ms:3", (0, 0.0025, 0.005)),
        ("1:100:3 log", (1, 10, 100)),
        ("0, 1, 2.5 ms", (0, 0.001, 0.0025)),
        ("1e-3, 2e-3", (0.001, 0.002)),
        ((0, "3 ms", 4), (0, 0.001, 0.002, 0.003)),
        ((1, 8, 4, "log"), (1, 2, 4, 8)),
        (np.array([0.1, 0.2]), (0.1, 0.2)),
        (["1 ms", 0.5], (0.001, 0.5)),
    ],
)
def test_values_are_read(given, values):
    """Ranges, ranges of equal ratios and lists; each number the double nearest to what is meant."""
    assert axis("delay", given, "s").values == values


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("1:2", "start:stop:count"),
        ("2:1:5", "swap the ends"),
        ("1:2:1", "whole number from 2"),
        ("1:2:2.5", "whole number from 2"),
        ("1:2:many", "whole number from 2"),
        ("0:2:5 log", "begins above 0"),
        ("1:2:5 ms", "log alone"),
        ("1 ms : 0.005:2", "unit belongs after the last"),
        ("1, 2, 1", "twice"),
        ("1, two", "delay is in s"),
        ("0:1 N:3", "delay is in s"),
        ([], "no value"),
        (3, "varied over a text"),
        ((1, 2, 3, "lin"), "may come"),
    ],
)
def test_bad_values_are_refused(given, message):
    with pytest.raises(zw.InputError, match=message):
        axis("delay", given, "s")


def alike(asked):
    """Every loop asked by itself has the words and numbers of all of them asked together."""
    shape = tuple(len(own.values) for own in asked.axes)
    found = {name: np.zeros(shape, own.kind) for name, own in asked.columns.items()}
    lines = {}
    for place in np.ndindex(shape):
        for name, value in checked(asked.at(place), lines.setdefault(place[1:], {})).items():
            found[name][place] = asked.columns[name].kept(value)
    layers = compute(asked, (0,) * len(shape))
    for name, expected in found.items():
        np.testing.assert_array_equal(layers[name], expected, err_msg=name)


@seeds(4)
def test_springs_are_decided_as_by_check(seed):
    """Whatever is varied, at the limit and a double beyond it too: the same words and largest spring."""
    drawn = np.random.default_rng(seed)
    device = PADDLE.replace(
        damping=zw.Exact(f"{drawn.uniform(0.01, 1):.3g}"),
        coulomb_friction=zw.Exact(f"{drawn.uniform(0, 0.1):.3g}"),
        delay=drawn.choice(["0 ms", "0.3 ms", "1 ms", "2.5 ms"]),
    )
    largest = check_by_closed_forms(device, WALL).max_stiffness or 1.0
    others = {"damping": "0, 0.15", "rate": "500, 1234.5", "delay": "0, 0.5, 1, 3.7 ms", "mass": "30, 40 g"}
    others |= {"resolution": "0, 1, 300 um", "coulomb_friction": "0, 0.02"}
    vary = {"stiffness": [0, largest, nextafter(largest, inf), largest * 1.3]}
    vary |= {str(name): others[name] for name in drawn.permutation(list(others))[:2]}
    asked = request("check", Loop(device, WALL), vary)
    assert asked.springs is not None
    alike(asked)


@pytest.mark.parametrize(
    ("delay", "velocity"),
    [
        ("0", zw.rendering.BackwardDifference()),
        ("0.001", zw.rendering.Window(3)),
        ("0.0003", zw.rendering.OnePole("0.002")),
    ],
)
def test_walls_are_decided_as_by_check(delay, velocity):
    """A line of stiffnesses, in no order, at both limits and beside them too: the same words and numbers."""
    device, wall = PADDLE.replace(delay=delay), zw.Wall(1, "0.05", velocity)
    limits = [
        check_by_closed_forms(device, wall, contact=contact).max_stiffness or 1.0
        for contact in ("made and broken", "kept")
    ]
    near = [limit * (1 + off) for limit in limits for off in (-1e-3, -1e-9, 0, 1e-9, 1e-3)]
    values = {*near, *(nextafter(limit, inf) for limit in limits), *(3.0 * n for n in (1, 33, 20, 150, 600))}
    asked = request("check", Loop(device, wall), {"stiffness": sorted(values, key=lambda k: k % 7)})
    assert asked.of_walls
    alike(asked)


def test_of_a_line_of_walls_few_are_asked(monkeypatch):
    """All but the first of each part, and those about which doubles are in doubt."""
    module = sys.modules["zwidth.study.sweeps.questions"]
    asked = request("check", Loop(PADDLE, zw.Wall(1, "0.05")), {"stiffness": "10:400:200"})
    told = []

    def counted(loop, line):
        told.append(loop)
        return checked(loop, line)

    question = asked.question._replace(answer=counted)
    monkeypatch.setattr(module, "QUESTIONS", {**module.QUESTIONS, "check": question})
    monkeypatch.setattr(requests, "QUESTIONS", module.QUESTIONS)
    layers = compute(asked, (0,))
    assert set(np.unique(layers["outcome"])) == {1, asked.columns["outcome"].kept("active")}
    assert len(told) < 10


def test_the_largest_spring_is_a_double_at_its_limit():
    """Passive there and not at the next, with and without friction as the limit; none without damping."""
    period, count = PADDLE.exact("sample_period"), PADDLE.exact("resolution")
    numbers = PADDLE.exact("damping"), PADDLE.exact("coulomb_friction"), count, period
    assert largest_spring(*numbers, period * 0) == 300
    smooth = PADDLE.replace(coulomb_friction=numbers[1] / 1000)
    less = numbers[0], numbers[1] / 1000, count, period
    assert largest_spring(*less, period * 0) == check_by_closed_forms(smooth, WALL).max_stiffness
    assert largest_spring(numbers[0] * 0, *numbers[1:], period * 0) == 0


def arrays(found):
    """Every number and word of a sweep, bit by bit; a word has room for others, more or less."""
    rows = {str(name): values.values for name, values in found.variables.items()}
    kinds = {name: "U99" if row.dtype.kind == "U" else row.dtype for name, row in rows.items()}
    return {name: row.astype(kinds[name]).tobytes() for name, row in rows.items()}


def stopped_after(chunks):
    """A progress that stops the sweep, as Ctrl-C would."""

    def report(done, total):
        if done >= chunks:
            raise KeyboardInterrupt

    return report


@pytest.mark.parametrize("name", ["sweep.zarr", "sweep.parquet"])
def test_a_sweep_goes_on(tmp_path, name, monkeypatch):
    """Stopped twice and gone on with, from the file again, from the file alone: the same bits."""
    monkeypatch.setattr(requests, "BY_CLOSED_FORMS", 6)
    whole = swept(PADDLE, WALL, vary=GRID)
    path = tmp_path / name
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            swept(PADDLE, WALL, vary=GRID, path=path, progress=stopped_after(2))
    with pytest.raises(zw.InputError, match=r"no such file|not whole"):
        zw.load_sweep(path)
    left = []
    found = swept(PADDLE, WALL, vary=GRID, path=path, progress=lambda done, total: left.append(done))
    assert 3 < left[0] <= len(left) + left[0]
    again = zw.sweep(PADDLE, WALL, vary=GRID, path=path, progress=stopped_after(0))
    for other in (found, again, zw.load_sweep(path)):
        assert arrays(other) == arrays(whole)
        assert other.attrs == whole.attrs
        xr.testing.assert_identical(other, whole)
    with pytest.raises(zw.InputError, match="another sweep"):
        zw.sweep(PADDLE, WALL, vary={**GRID, "delay": "0:3 ms:5"}, path=path)


@pytest.mark.parametrize("name", ["sweep.zarr", "sweep.parquet", "map.zarr"])
def test_one_process_at_a_time_writes_a_file(tmp_path, name):
    """A second one is told so and harms nothing; the lock of one that is gone holds nobody up."""
    path = tmp_path / name
    (tmp_path / f".{name}.lock").touch()
    refused = []

    def computed(progress):
        if name == "map.zarr":
            area = {"stiffness": (0, 300), "virtual_damping": (0, 1), "cells": (4, 4)}
            return zw.z_width(PADDLE, **area, workers=1, path=path, progress=progress)
        return swept(PADDLE, WALL, vary={"stiffness": "1, 2"}, path=path, progress=progress)

    def asked_again(done, total):
        with pytest.raises(zw.InputError, match="is being written by another process") as told:
            computed(lambda done, total: None)
        refused.append(str(told.value))

    found = computed(asked_again)
    assert refused
    assert [each.name for each in tmp_path.iterdir() if each.suffix != ".lock"] == [name]
    xr.testing.assert_identical(computed(lambda done, total: None), found)


def test_processes_compute_the_same_bits(monkeypatch):
    monkeypatch.setattr(requests, "BY_CLOSED_FORMS", 6)
    alone, two = (zw.sweep(PADDLE, WALL, vary=GRID, workers=workers) for workers in (1, 2))
    assert arrays(alone) == arrays(two)


def test_a_worker_that_is_gone_is_told():
    """One that was killed: a message, and no waiting for ever; one that nobody asks any more ends."""
    asked = request("check", Loop(PADDLE, WALL), {"stiffness": "1, 2"})
    worker = Worker(compute, asked)
    assert worker.ask((0,))["outcome"].tolist() == [1, 1]
    worker.process.send_signal(signal.SIGKILL)
    worker.process.wait()
    with pytest.raises(zw.InputError, match="ended before its time"):
        worker.ask((0,))
    worker.dismiss()
    other = Worker(compute, asked)
    other.process.stdin.close()
    assert other.process.wait() == 0
    other.dismiss()


def test_every_question_is_answered_as_by_itself():
    """A law with memory, a limit, a touch, a pair: the numbers of the function that answers one."""
    soft = zw.Maxwell(stiffness=100, damping=3)
    found = swept(PADDLE, soft, vary={"stiffness": [100, 2000]})
    for k in found.stiffness.values:
        verdict = check_by_closed_forms(PADDLE, soft.replace(stiffness=k))
        one = found.sel(stiffness=k)
        said = verdict.outcome, verdict.scope.contact, verdict.limit, verdict.max_stiffness
        assert (one.outcome, one.contact, one.binding, one.max_stiffness) == said
    damped = zw.Wall(100, "0.05")
    limits = swept(PADDLE, damped, of="limit", vary={"rate": "1, 2 kHz"}, tolerance=0.1)
    bracket = zw.limit(PADDLE.replace(rate="2 kHz"), damped, iterate=False, tolerance=0.1)
    assert limits.proved_passive.values[1] == bracket.proved_passive
    assert limits.proved_active.values[1] == bracket.proved_active
    pair = zw.Pair(PADDLE, PADDLE, stiffness=50)
    pairs = swept(pair, of="pair", vary={"link-delay": "0, 2 ms", "rate": [1000]})
    verdict_of_two = zw.check(pair.replace(delay="2 ms"))
    assert pairs.outcome.values[1, 0] == verdict_of_two.outcome
    assert pairs.max_stiffness.values[1, 0] == verdict_of_two.largest_stiffness


def test_a_touch_is_simulated_as_by_itself():
    hand = zw.operators.Dowel(force=1)
    vary = {"operator.force": "1, 2", "stiffness": [770]}
    touches = swept(PADDLE, zw.Wall(770), of="simulate", operator=hand, duration="0.05 s", vary=vary)
    trace = zw.simulate(PADDLE, zw.Wall(770), zw.operators.Dowel(force=2), 0.05)
    row = zw.traces.compare_traces({"one": trace}).rows["one"]
    assert {name: float(touches[name].values[1, 0]) for name in row} == row
    assert touches["energy_extracted"].attrs["units"] == "J"


LAWS = (
    zw.rendering.Damper("0.05", zw.rendering.AdaptiveWindow(longest=4)),
    zw.rendering.PassivityController(),
    zw.rendering.WindowedController(),
)


def test_numbers_of_laws_in_a_chain_are_varied():
    """Also those that the device filled in, whole ones, and those of a law's velocity."""
    hand = zw.operators.Dowel(force=1)
    vary = {"law.2.largest-damping": "0.03, 0.2", "law.3.window": "3, 9", "law.1.velocity.longest": [2, 4]}
    chain = zw.render(zw.Wall(770), *LAWS)
    found = swept(PADDLE, chain, of="simulate", operator=hand, duration="0.03 s", vary=vary)
    assert found["law.2.largest_damping"].attrs["units"] == "N*s/m"
    chain = zw.render(
        zw.Wall(770),
        zw.rendering.Damper("0.05", zw.rendering.AdaptiveWindow(longest=2)),
        zw.rendering.PassivityController(largest_damping="0.2"),
        zw.rendering.WindowedController(window=9),
    )
    trace = zw.simulate(PADDLE, chain, hand, 0.03)
    row = zw.traces.compare_traces({"one": trace}).rows["one"]
    assert {name: float(found[name].values[1, 1, 0]) for name in row} == row
    assert len(np.unique(found.deepest_position.values)) > 1


def poled(time_constant):
    return zw.Wall(90, "0.03", zw.rendering.OnePole(time_constant))


def coupled(time_constant):
    return zw.VirtualCoupling(200, "0.01", zw.Wall(500, "0.02", zw.rendering.OnePole(time_constant)))


@pytest.mark.parametrize(
    ("wall", "name", "values", "changed_wall"),
    [
        (poled("1 ms"), "velocity_filter.time_constant", "1, 20 ms", poled("20 ms")),
        (poled("1 ms"), "velocity_filter.cutoff", "50, 100 Hz", poled(zw.Exact(1 / (2 * np.pi * 100)))),
        (
            WINDOWED,
            "velocity_filter.samples",
            [2, 9],
            WINDOWED.replace(velocity_filter=zw.rendering.Window(9)),
        ),
        (coupled("1 ms"), "environment.velocity_filter.time_constant", "1, 5 ms", coupled("5 ms")),
        (
            zw.render(WALL, zw.rendering.RateTerm()),
            "law.time_constant",
            "0.1, 1 ms",
            zw.render(WALL, zw.rendering.RateTerm(time_constant="1 ms")),
        ),
        (
            zw.render(WALL, zw.rendering.ForceBounding()),
            "stiffness",
            "100, 2000",
            zw.render(zw.Wall(2000), zw.rendering.ForceBounding()),
        ),
    ],
)
def test_what_a_law_is_made_of_is_varied(wall, name, values, changed_wall):
    """Filters of a velocity, what is behind a coupling, a law in a chain: each as by itself."""
    one = swept(PADDLE, wall, vary={name: values}).isel({name: 1})
    verdict = zw.check(PADDLE, changed_wall, iterate=False)
    said = verdict.outcome, verdict.scope.contact, getattr(verdict, "limit", "")
    assert (one.outcome, one.contact, one.binding) == said


def test_the_limit_behind_a_law_whose_number_is_varied():
    chain = zw.render(zw.Wall(100), zw.rendering.RateTerm())
    found = swept(PADDLE, chain, of="limit", vary={"law.time_constant": "0.1, 1 ms"})
    for k in (0, 1):
        law = zw.rendering.RateTerm(time_constant=found["law.time_constant"].values[k])
        one = zw.limit(PADDLE, zw.render(zw.Wall(100), law), iterate=False)
        assert found.proved_passive.values[k] == one.proved_passive


def test_what_an_outcome_is_about_stands_beside_it():
    """No claim without its contact and encoder; what all have in common is in the scope."""
    found = swept(PADDLE, poled("1 ms"), vary={"delay": "0, 1 ms"})
    assert found.outcome.values.tolist() == ["passive", "passive in contact"]
    assert found.contact.values.tolist() == ["made and broken", "kept"]
    assert set(found.encoder.values.tolist()) == {"counted"}
    assert '"which": "every"' in found.attrs["scope"]
    assert "by closed forms" in found.attrs["answers"]


def test_a_wheel_in_degrees():
    """Counts in a turn, degrees and revolutions, as options have them."""
    numbers = {"inertia": "6 g*m^2", "damping": "0.05", "coulomb_friction": "0.02", "rate": 1000}
    wheel = zw.rotary(counts_per_turn=65536, **numbers)
    wall = zw.Wall("2 N*m/rad")
    found = zw.sweep(wheel, wall, vary={"counts_per_turn": [4096, 65536], "stiffness": "1, 5 N*m/deg"})
    assert found.stiffness.attrs["units"] == "N*m/rad"
    loop = Loop(wheel, wall)
    own = [parameter(loop, name) for name in found.dims]
    for n, k in np.ndindex(2, 2):
        at = changed(loop, {own[0]: found.counts_per_turn.values[n], own[1]: found.stiffness.values[k]})
        assert found.outcome.values[n, k] == check_by_closed_forms(at.subject, at.environment).outcome
    coarse = zw.sweep(wheel, wall, vary={"resolution": "0.1, 1 deg"})
    assert coarse.resolution.values[1] == pytest.approx(np.pi / 180)


def test_a_loop_that_cannot_be_is_said_to_be_refused():
    """Two rates that do not go into each other: no answer, and why of the first."""
    pair = zw.Pair(PADDLE, PADDLE, stiffness=50)
    found = swept(pair, of="pair", vary={"leader.rate": [1000, 1500, 2000]})
    assert found.refused.values.tolist() == [False, True, False]
    assert found.outcome.values[1] == ""
    assert np.isnan(found.max_stiffness.values[1])
    assert "leader.rate = 1.5 kHz: one arm reads a whole number" in found.attrs["first_refused"]


@pytest.mark.parametrize(
    ("vary", "more", "message"),
    [
        ({}, {}, "nothing is varied"),
        ({"stifness": "1, 2"}, {}, 'to vary in this loop; did you mean "stiffness"'),
        ({"velocity_filter": "1, 2"}, {"environment": POLE}, "no number of its own; .*cutoff"),
        ({"samples": "1, 2"}, {"environment": WINDOWED}, 'did you mean "velocity_filter.samples"'),
        ({"velocity_filter.samples": "1.5, 2"}, {"environment": WINDOWED}, "samples = 1.5: a .*whole number"),
        ({"velocity_filter.cutoff": "0, 2"}, {"environment": POLE}, "cutoff must be > 0 Hz"),
        ({"velocity_filter.cutoff": "1, 2", "velocity_filter.time_constant": "1, 2"},
         {"environment": POLE}, "the same number"),
        ({"law.window": "1, 2"}, {"environment": zw.render(WALL, *LAWS)}, 'did you mean "law.3.window"'),
        ({"stiffness": "-1, 2"}, {}, r"at stiffness = -1 N/m: stiffness must be ≥ 0"),
        ({"rate": "1, 2", "sample_period": "1, 2"}, {}, "the same number"),
        ({"stiffness": (0, 1, 30_000), "delay": (0, 1, 1000)}, {}, "at most 20000000 loops"),
        ({"stiffness": "1, 2"}, {"of": "serve"}, "a sweep is of check, limit, simulate, pair"),
        ({"stiffness": "1, 2"}, {"of": "pair"}, "two arms"),
        ({"stiffness": "1, 2"}, {"of": "simulate"}, "needs a hand"),
        ({"stiffness": "1, 2"}, {"workers": 0}, "workers must be"),
        ({"stiffness": "1, 2"}, {"path": "sweep.csv"}, r"ends in \.zarr or \.parquet"),
        ({"stiffness": "1, 2"}, {"path": "nowhere/sweep.zarr"}, "no directory"),
        ({"delay": "0, 1 ms"}, {"hands": {"My hand": None}}, "small letters, such as finger"),
        ({"delay": "0, 1 ms"}, {"hands": {"finger": 3}}, "hand"),
        ({"delay": "0, 1 ms"}, {"hands": [None]}, "hands are given by their names"),
        ({"delay": "0, 1 ms"}, {"device": PADDLE.replace(mass=None), "hands": {"none": None}}, "mass"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_before_work_starts(vary, more, message):
    with pytest.raises(zw.InputError, match=message):
        zw.sweep(**{"device": PADDLE, "environment": WALL, **more}, vary=vary)


def test_a_file_that_is_no_sweep(tmp_path):
    foreign = tmp_path / "x.parquet"
    foreign.write_bytes(b"no table")
    with pytest.raises(zw.InputError, match="no sweep that can be read"):
        zw.load_sweep(foreign)
    with pytest.raises(zw.InputError, match="another sweep, or none"):
        zw.sweep(PADDLE, WALL, vary=GRID, path=foreign)
    assert foreign.read_bytes() == b"no table"
    with pytest.raises(zw.InputError, match="no such file"):
        zw.load_sweep(tmp_path / "y.zarr")
    with pytest.raises(zw.InputError, match=r"\.zarr or \.parquet"):
        zw.load_sweep(tmp_path / "y.nc")


def test_of_hands_that_are_known_it_says_what_stability_says():
    """Of each by its name, beside the verdict about every hand."""
    hands = {"none": None, "finger": zw.operators.Finger()}
    grid = {"stiffness": "100, 3000", "delay": "0, 2 ms"}
    found = swept(PADDLE, zw.Wall(100, "0.05"), vary=grid, hands=hands)
    for stiffness in found["stiffness"].values:
        for delay in found["delay"].values:
            one = found.sel(stiffness=stiffness, delay=delay)
            device, wall = PADDLE.replace(delay=float(delay)), zw.Wall(float(stiffness), "0.05")
            for name, hand in hands.items():
                alone = zw.stability.coupled_stability(device, wall, hand)
                assert one[f"stability_{name}"].item() == alone.outcome
                assert one[f"max_stable_stiffness_{name}"].item() == alone.max_stiffness
            assert one["outcome"].item() == check_by_closed_forms(device, wall).outcome
    assert set(found["stability_finger"].values.flat) == {"stable", "unstable"}
    assert "as long as it keeps contact" in found.attrs["answers"]
