"""The Z-width map: each layer against another road, stores that are killed and gone on with, clusters."""

import json
import os
import signal
import subprocess
import sys
from contextlib import ExitStack
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
import xarray as xr
from full_disk import full_disk

import zwidth as zw
from zwidth.model.operator import Dowel, Finger
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.storage.hand_bounds import slow_hands
from zwidth.study.maps.kernel import STABLE, UNKNOWN, UNSTABLE, compute
from zwidth.study.maps.kernel import decide as decide_cell
from zwidth.study.maps.plan import _exactly, plan
from zwidth.study.maps.request import CHUNK, FORMAT, request

PADDLE = zw.catalogue.device("haptic-paddle")
WIDE = ((0, 30000), (0, 90))
LAYERS = ("passive", "passive_sustained", "quiet", "admissible_speed")
FILTERED = zw.rendering.VelocityFilter([1, 0, 0], [1, "-0.5", "0.06"])
"""Its response does not end."""


def same(a, b):
    """Every layer has the same bytes."""
    names = (*LAYERS, "stable_none", "stable_finger", "stable_dowel")
    return all(a[name].values.tobytes() == b[name].values.tobytes() for name in names)


def cells(found):
    """Stiffness and virtual damping of each."""
    return product(found["stiffness"].values, found["virtual_damping"].values)


def test_every_number_has_its_unit():
    found = zw.z_width(PADDLE, *WIDE, cells=(3, 3))
    numbers = {name: one for name, one in found.variables.items() if one.dtype.kind == "f"}
    assert {"limit_passive", "limit_dowel", "admissible_speed", "stiffness"} <= set(numbers)
    assert not [name for name, one in numbers.items() if "units" not in one.attrs]
    assert {found[name].attrs["units"] for name in ("limit_passive", "limit_none", "stiffness")} == {"N/m"}


def test_stable_cells_are_those_that_stability_proves():
    """On a coarse grid every cell of every hand is as `zw.stability.coupled_stability` says, one by one."""
    found = zw.z_width(PADDLE, *WIDE, cells=(9, 11))
    hands = {"none": None, "finger": Finger(), "dowel": Dowel(force=1)}
    for name, hand in hands.items():
        for k, b in cells(found):
            expected = zw.stability.coupled_stability(PADDLE, zw.Wall(k, b), hand).outcome == "stable"
            assert bool(found[f"stable_{name}"].sel(stiffness=k, virtual_damping=b)) == expected


@pytest.mark.parametrize("delay", ["0", "0.0004", "0.002"])
def test_stable_cells_end_at_the_boundary(delay):
    """At each virtual damping the last stable cell is the last one below the curve."""
    device = PADDLE.replace(delay=delay)
    found = zw.z_width(device, *WIDE, cells=(300, 40))
    k = found["stiffness"].values
    for name in ("none", "finger", "dowel"):
        for j, limit in enumerate(found[f"limit_{name}"].values):
            count = 0 if np.isnan(limit) else int((k < limit).sum())
            assert found[f"stable_{name}"].values[:, j].sum() == count


def test_passive_cells_are_those_that_check_proves():
    """Near both edges of the passive region, each cell as `zw.check` says; both kinds occur."""
    found = zw.z_width(PADDLE, (0, 360), (-0.2, 0.2), cells=(12, 10))
    outcomes = set()
    for k, b in cells(found):
        mine = bool(found["passive"].sel(stiffness=k, virtual_damping=b))
        assert not mine or zw.check(PADDLE, zw.Wall(k, b)).outcome == "passive"
        # without delay the condition for contact made and broken is also necessary for B ≥ 0
        assert b < 0 or mine == (k * 0.0005 + b <= 0.15)
        outcomes.add(mine)
    assert outcomes == {True, False}


@pytest.mark.parametrize(
    ("changes", "velocity"),
    [
        ({}, zw.rendering.OnePole(0.005)),
        ({"delay": "0.0005"}, zw.rendering.BackwardDifference()),
        ({"delay": "0.0005"}, zw.rendering.Window(4)),
        ({"delay": "0.002"}, zw.rendering.BackwardDifference()),
        ({"delay": "0.0033", "resolution": "0.0008"}, zw.rendering.OnePole(0.003)),
        ({"resolution": "0.001"}, zw.rendering.Window(3)),
    ],
)
def test_sustained_cells_are_those_that_the_criterion_proves(changes, velocity):
    """Each cell as the exact decision says; more of them than with contact broken, and not all."""
    device = PADDLE.replace(**changes)
    found = zw.z_width(device, (0, 330), (-0.3, 0.6), (24, 17), velocity_filter=velocity, hands={})
    sustained = found["passive_sustained"]
    for k, b in cells(found):
        expected = decide(device, zw.Wall(k, b, velocity_filter=velocity)).is_provable
        assert bool(sustained.sel(stiffness=k, virtual_damping=b)) == expected
    assert (found["passive"] <= sustained).all()
    assert found["passive"].sum() < sustained.sum() < sustained.size


@pytest.mark.parametrize(("first", "past"), [(0, 20), (3, 17), (9, 10), (1, 19), (0, 1), (19, 20), (4, 9)])
def test_ends_of_an_interval_are_found(first, past):
    """Wherever it lies in the range that floats allow, if one of the three cells tried first is in it."""
    seen = set()

    def proved(i):
        seen.add(i)
        return first <= i < past

    expected = (0, 0) if (first, past) == (4, 9) else (first, past)
    assert _exactly(proved, 0, 20) == expected
    assert seen <= set(range(20))


def test_a_cell_exactly_on_the_limit_is_passive_and_the_next_double_is_not():
    """K = 2b/T = 300 N/m at B = 0 is met exactly, although 0.15 is no double."""
    on = zw.z_width(PADDLE, (299, 301), ("-0.1", "0.1"), cells=(1, 1))
    above = zw.z_width(PADDLE, (299, "301.0000000000002"), ("-0.1", "0.1"), cells=(1, 1))
    assert on["stiffness"].item() == 300
    assert above["stiffness"].item() > 300
    assert on["virtual_damping"].item() == 0
    assert bool(on["passive"])
    assert not bool(above["passive"])


def test_the_encoder_limits_what_is_passive():
    """With a coarse encoder f_c ≥ (K/2 + B/T) Δ binds: K = 2f_c/Δ − 2B/T."""
    coarse = PADDLE.replace(resolution="0.001")
    found = zw.z_width(coarse, (0, 300), (0, "0.12"), cells=(150, 60))
    k, b = found["stiffness"].values[:, None], found["virtual_damping"].values[None, :]
    expected = (k * 0.0005 + b <= 0.15) & ((k / 2 + b * 1000) * 0.001 <= 0.12)
    assert (found["passive"].values == expected).all()
    assert 0 < expected.sum() < (k * 0.0005 + b <= 0.15).sum()


def test_the_admissible_speed_of_a_spring_is_that_of_the_plane():
    """v = (2f_c − KΔ)/(KT − 2b), never above it, and within 1e-12."""
    found = zw.z_width(PADDLE, (0, 20000), ("-1e-12", "1e-12"), cells=(40, 1))
    seen = set()
    for k, speed in zip(found["stiffness"].values, found["admissible_speed"].values[:, 0], strict=True):
        exact = float(zw.formulas.admissible_speed(PADDLE, k))
        assert speed <= exact
        assert speed == exact or speed == pytest.approx(exact, rel=1e-11)
        seen.add("inf" if speed == np.inf else "0" if speed == 0 else "finite")
    assert seen == {"inf", "finite", "0"}


def test_no_fast_motion_below_the_admissible_speed_gains_energy():
    """A thousand motions of 60 samples, random and to and fro, at that speed; at 30 times it some gain."""
    k, b = 500.0, 0.08
    found = zw.z_width(PADDLE, (k - 1, k + 1), (b - 0.01, b + 0.01), cells=(1, 1))
    speed = found["admissible_speed"].item()
    assert 0.5 < speed < 10
    period, friction, drag, count = 1e-3, 0.12, 0.15, 22.4e-6
    rng = np.random.default_rng(2)
    for factor, gains in ((1.0, False), (30.0, True)):
        moves = rng.choice([-1.0, 1.0, 0.5, -0.5], (1000, 60)) * speed * period * factor
        moves[:500, 1::2] = -moves[:500, 0::2]
        x = np.concatenate([np.full((1000, 2), -1e-6), np.zeros((1000, 60))], axis=1)
        work = np.zeros(1000)
        for n in range(60):
            q, before = (np.floor(x[:, n + 1 - late] / count) * count for late in (0, 1))
            force = np.where(q > 0, k * q + b * (q - before) / period, 0.0)
            move = moves[:, n]
            work += force * move + friction * np.abs(move) + drag * move**2 / period
            x[:, n + 2] = x[:, n + 1] + move
        assert (work.min() < 0) == gains


def test_the_kernel_never_believes_a_sign_that_rounding_made():
    """Within 1e-13 of the boundary it leaves the cell to exact arithmetic; 1e-9 away it decides rightly."""
    ready = plan(request(PADDLE, *WIDE, (10, 10), None, {"finger": Finger()}))
    hand = ready.hands[0]
    for b in (1.0, 20.0, 60.0):
        limit = zw.stability.coupled_stability(PADDLE, zw.Wall(10, b), Finger()).max_stiffness
        for off, answer in ((-1e-9, STABLE), (0.0, UNKNOWN), (1e-9, UNSTABLE)):
            cell, room = (limit * (1 + off), b, hand.slack), (np.zeros((2, 9)), np.zeros((2, 9)))
            assert decide_cell(hand.free, hand.stiff, hand.damped, *cell, *room) == answer


def test_a_filter_without_end_is_not_called_passive():
    """No condition for contact made and broken covers it; stability is decided all the same."""
    found = zw.z_width(PADDLE, (0, 300), (0, 1), cells=(5, 5), velocity_filter=FILTERED)
    assert not found["passive"].any()
    assert (found["admissible_speed"] == 0).all()
    assert found["stable_finger"].any()
    assert np.isnan(found["limit_passive"]).all()


@pytest.mark.parametrize("delay", ["0.0005", "0.0014"])
def test_a_delay_of_part_of_a_sample_ends_where_check_does(delay):
    """The curve is where `check` stops proving contact made and broken; slow hands are proved beyond it."""
    device = PADDLE.replace(delay=delay)
    found = zw.z_width(device, (0, 300), (-0.1, 0.2), cells=(60, 6), hands={})
    beyond = 0
    for place, b in enumerate(found["virtual_damping"].values):
        limit = float(found["limit_passive"][place])
        if limit > 0:
            for share, kind in ((1 - 1e-9, "contact"), (1 + 1e-9, "quantized")):
                verdict = check_by_closed_forms(device, zw.Wall(limit * share, b))
                assert verdict.certificate is None or verdict.certificate.kind == kind
                assert (verdict.outcome == "passive") is (share < 1)
        column = found.isel(virtual_damping=place)
        layers = (column[name].values for name in ("stiffness", "admissible_speed", "passive"))
        for k, speed, passive in zip(*layers, strict=True):
            assert passive == (k <= limit)
            if 0 < speed < np.inf and beyond < 6:
                beyond += 1
                assert slow_hands(device, zw.Wall(k, b), Fraction(float(speed))) is not None
                assert slow_hands(device, zw.Wall(k, b), Fraction(float(speed) * (1 + 1e-9))) is None
    assert beyond == 6
    assert json.loads(found["quiet"].attrs["scope"])["hands"]["in_each_part_of_a_sample"]


def test_regions_and_free_air():
    """The passive area is the triangle ½ (2b/T) b, to a cell; the lower end is the device itself."""
    found = zw.z_width(PADDLE, (0, 600), (0, "0.3"), cells=(400, 400))
    assert found["area"].sel(region="passive").item() == pytest.approx(0.5 * 300 * 0.15, rel=0.01)
    assert found["largest_stiffness"].sel(region="passive").item() == pytest.approx(300, abs=2)
    assert (found["free_mass"], found["free_damping"], found["free_friction"]) == (0.036, 0.15, 0.12)
    assert found["quiet"].values[found["passive"].values].all()


def test_threads_do_not_change_a_bit():
    one, four = (zw.z_width(PADDLE, *WIDE, cells=(300, 300), workers=n) for n in (1, 4))
    assert same(one, four)


def test_a_store_is_gone_on_with(tmp_path):
    cells, path = (300, 300), tmp_path / "map.zarr"
    told, again = [], []

    def stop(done, total):
        told.append(done)
        if done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        zw.z_width(PADDLE, *WIDE, cells=cells, path=path, progress=stop, workers=1)
    found = zw.z_width(PADDLE, *WIDE, cells=cells, path=path, progress=lambda done, total: again.append(done))
    assert told == [1, 2, 3, 4]
    assert again == [5, 6, 7, 8, 9]
    assert same(found, zw.z_width(PADDLE, *WIDE, cells=cells))
    opened = xr.open_zarr(path, consolidated=False)
    assert (opened["passive"].values == found["passive"].values).all()


STOPPED = """
import sys, time
import zwidth as zw

def stopped(done, total):
    print(done, flush=True)
    if done == int(sys.argv[2]):
        time.sleep(3600)

device, walls = zw.catalogue.device("haptic-paddle"), ((0, 30000), (0, 90))
zw.z_width(device, *walls, cells=(260, 260), path=sys.argv[1], progress=stopped)
"""
"""It goes no further than it is told, so that nobody need be quick to kill it there."""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no SIGKILL here")
def test_a_map_killed_twice_loses_nothing(tmp_path):
    """SIGKILL at chunk 2, and again at chunk 5: what was done stays, and the end is the same to the bit."""
    path = tmp_path / "killed.zarr"
    for at in (2, 5):
        command = [sys.executable, "-c", STOPPED, str(path), str(at)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        for line in process.stdout:
            if int(line) == at:
                os.kill(process.pid, signal.SIGKILL)
                break
        assert process.wait() == -signal.SIGKILL
        process.stdout.close()
        assert xr.open_zarr(path, consolidated=False)["done"].values.sum() == at
    left = []
    found = zw.z_width(PADDLE, *WIDE, cells=(260, 260), path=path, progress=lambda n, total: left.append(n))
    assert left == list(range(6, 10))
    assert same(found, zw.z_width(PADDLE, *WIDE, cells=(260, 260)))


def test_a_store_stopped_before_its_arrays_were_there(tmp_path):
    """A group that says which map was begun, and nothing else: it is begun again."""
    import zarr

    asked = request(PADDLE, *WIDE, (5, 5), None, None)
    path = tmp_path / "map.zarr"
    zarr.create_group(path, attributes={"format": FORMAT, "begun": asked.layout.digest})
    found = zw.z_width(PADDLE, *WIDE, cells=(5, 5), path=path)
    assert same(found, zw.z_width(PADDLE, *WIDE, cells=(5, 5)))


def test_a_full_disk_keeps_what_is_finished(tmp_path):
    path = tmp_path / "map"

    def full(done, total):
        disk.enter_context(full_disk(largest=0))

    with ExitStack() as disk, pytest.raises(zw.InputError, match=r"map cannot be written: .*goes on with it"):
        zw.z_width(PADDLE, *WIDE, cells=(CHUNK, CHUNK + 1), path=path, progress=full, workers=1)
    left = []
    zw.z_width(PADDLE, *WIDE, cells=(CHUNK, CHUNK + 1), path=path, progress=lambda n, total: left.append(n))
    assert left == [2]


def leads_elsewhere(path):
    """Neither read nor written is what a link in it names."""
    (path / "passive").rename(path.parent / "other")
    (path / "passive").symlink_to(path.parent / "other")


def declares_more(path):
    """Cells that were never written are filled in, as many as are declared."""
    about = path / "passive" / "zarr.json"
    document = json.loads(about.read_text(encoding="utf-8"))
    about.write_text(json.dumps({**document, "shape": [2**40, 2**40]}), encoding="utf-8")


@pytest.mark.parametrize(
    ("changed", "stiffness", "message"),
    [
        (leads_elsewhere, (0, 30000), "passive in it is a link"),
        (declares_more, (0, 30000), "holds another map"),
        (lambda path: None, (0, 1), "holds another map"),
    ],
    ids=["a link", "more", "another range"],
)
def test_a_store_of_another_map_is_refused(changed, stiffness, message, tmp_path):
    zw.z_width(PADDLE, *WIDE, cells=(5, 5), path=tmp_path / "map")
    changed(tmp_path / "map")
    with pytest.raises(zw.InputError, match=message):
        zw.z_width(PADDLE, stiffness, WIDE[1], cells=(5, 5), path=tmp_path / "map")


def test_a_folder_with_something_else_is_not_touched(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(zw.InputError, match="holds"):
        zw.z_width(PADDLE, *WIDE, cells=(5, 5), path=tmp_path)
    assert (tmp_path / "notes.txt").read_text(encoding="utf-8") == "mine"


def test_a_cluster_gives_the_same_bits(monkeypatch):
    """Two workers, each a process of its own, against the threads of this one."""
    import distributed

    monkeypatch.setattr("zwidth.study.chunks.layout._TIMEOUT", "600 s")  # they may start slowly
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, scheduler_port=0
    ) as cluster:
        there = zw.z_width(PADDLE, *WIDE, cells=(150, 150), address=cluster.scheduler_address)
    assert same(there, zw.z_width(PADDLE, *WIDE, cells=(150, 150)))


def test_chunks_tile_the_map():
    asked = request(PADDLE, *WIDE, (CHUNK + 3, 5), None, {"none": None})
    ready = plan(asked)
    assert asked.layout.chunks == (2, 1)
    assert [compute(ready, (i, 0))["passive"].shape for i in (0, 1)] == [(CHUNK, 5), (3, 5)]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stiffness": (10, 0)}, "smaller to its larger end"),
        ({"stiffness": (-1, 5)}, "pulls the hand in"),
        ({"stiffness": 500}, "two ends, such as"),
        ({"stiffness": (0, 1000, 21)}, "two ends, got 3 values"),
        ({"stiffness": np.linspace(0, 1000, 21)}, "two ends, got 21 values"),
        ({"stiffness": "0:1000"}, "not a product of units"),
        ({"cells": (0, 5)}, "two whole numbers ≥ 1"),
        ({"cells": 5}, "two whole numbers"),
        ({"cells": (5, "a")}, "two whole numbers"),
        ({"cells": (100000, 100000)}, "at most"),
        ({"hands": {"soft": zw.stability.HandImpedance(mass=(0, 1))}}, "hand soft"),
        ({"device": PADDLE.replace(damping=(0.1, 0.2))}, "interval"),
        ({"device": zw.Device(damping=1, rate=1000)}, "mass"),
        ({"workers": 0}, "workers"),
        ({"speed": 0}, "speed"),
    ],
)
def test_what_cannot_be_mapped(change, message):
    given = {"device": PADDLE, "stiffness": (0, 10), "virtual_damping": (0, 1), "cells": (3, 3), **change}
    with pytest.raises(zw.InputError, match=message):
        zw.z_width(**given)


def test_what_no_condition_covers_is_said_and_springs_are_decided():
    """Of a filter without end the column at B = 0 ends where `check` does, from both sides."""
    device = PADDLE.replace(delay="0.0005", coulomb_friction=1)
    given = {"hands": {}, "velocity_filter": FILTERED}
    found = zw.z_width(device, (0, 300), ("-0.5", "0.5"), cells=(300, 3), **given)
    middle = found["passive"].values[:, 1]
    k = found["stiffness"].values
    limit = float(found["spring_limit"])
    assert 0 < limit < 300
    assert (middle == (k <= limit)).all()
    assert not found["passive"].values[:, [0, 2]].any()
    assert np.isinf(found["admissible_speed"].values[middle, 1]).all()
    for share, outcome in ((1 - 1e-9, "passive"), (1 + 1e-6, "active")):
        assert check_by_closed_forms(device, zw.Wall(limit * share)).outcome == outcome
    assert "does not end" in found.attrs["not_covered"]
    assert zw.maps.z_width_certificate(device, found, velocity_filter=FILTERED) is not None
    coarse = zw.z_width(device.replace(coulomb_friction="0.001"), (0, 300), (0, 1), cells=(4, 4), hands={})
    assert float(coarse["spring_limit"]) == pytest.approx(2 * 0.001 / 2.24e-5)
    assert zw.z_width(PADDLE, (0, 300), (0, 1), cells=(4, 4), hands={}).attrs["not_covered"] == ""


def test_no_spring_is_passive_without_damping_of_the_device():
    """A filter whose response does not end leaves springs alone, and b = 0 holds none but that of K = 0."""
    for damping, passive in ((0, [False, False]), (0.15, [True, False])):
        device = PADDLE.replace(damping=damping)
        found = zw.z_width(device, (0, 500), (-1, 1), (2, 1), velocity_filter=FILTERED, hands={})
        assert found["virtual_damping"].values.tolist() == [0]
        assert found["passive"].values[:, 0].tolist() == passive
