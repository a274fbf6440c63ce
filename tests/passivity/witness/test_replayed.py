"""A hand motion on a device with a transmission: what comes out where two masses replay it."""

from __future__ import annotations

import json

import pytest

import zwidth as zw
from zwidth.checker import judge
from zwidth.loop.energy import ledger
from zwidth.model.operator import WitnessMotion
from zwidth.passivity.witness.motion import saved_motion


def device(stiffness, encoder="motor", dry=0, step=0, **more):
    between = zw.Transmission(
        stiffness=stiffness, handle_damping="0.09", handle_mass="30 g", handle_coulomb_friction=dry,
        encoder=encoder, **more,
    )  # fmt: skip
    return zw.Device(
        mass="30 g", damping="0.06", rate="1 kHz", delay=0, coulomb_friction=dry, resolution=step,
        transmission=between,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("stiffness", "encoder", "limit", "pieces"),
    [
        ("2131.8", "motor", 120.753, 1),
        ("28657", "motor", 129.925, 1),
        ("28657", "handle", 257.272, 8),
        ("5.33e6", "motor", 271.251, 32),
    ],
)
def test_a_little_above_the_limit_one_gains_and_below_it_nothing_is_shown(stiffness, encoder, limit, pieces):
    own = device(stiffness, encoder, "0.01", "10 um")
    found = zw.check(own, zw.Wall(1.01 * limit)).witness
    assert found.energy > 0
    assert found.stays_inside
    assert found.motion.pieces == pieces
    assert zw.check(own, zw.Wall(0.999 * limit)).witness is None


def test_it_is_told_and_no_evidence_and_a_file_of_it_is_made_again():
    own, wall = device("28657"), zw.Wall(140)
    verdict = zw.check(own, wall)
    saved = json.loads(json.dumps(verdict.to_dict()))
    assert saved["hand_motion"]["energy_J"] == verdict.witness.energy
    assert "witness" not in saved
    judged = judge(saved)
    assert judged.valid
    assert "hand_motion" in judged.told
    hand = WitnessMotion(saved_motion(saved, "it"))
    trace = zw.simulate(own, wall, hand, hand.intervals * own.exact("sample_period"))
    assert ledger(trace).got_out == pytest.approx(verdict.witness.energy, rel=1e-9)
    assert ledger(trace).closes
    assert "not checked" in verdict.witness.describe()


def test_pieces_do_not_change_a_straight_motion():
    """The same line, given at the samples or in four pieces of each."""
    own, wall = device("5.33e6", dry="0.01"), zw.PulseTransferFunction([100], [1])
    places = [0, 1, 3, 2, 5]
    fine = [a + (b - a) * i / 4 for a, b in zip(places, places[1:], strict=False) for i in range(4)] + [5]
    one, four = (
        zw.simulate(own, wall, WitnessMotion(zw_motion(p, n)), 4e-3) for p, n in ((places, 1), (fine, 4))
    )
    for name in ("hand_work", "motor_position", "hand_force"):
        assert four[name].values == pytest.approx(one[name].values, rel=1e-9)


def zw_motion(places, pieces):
    return saved_motion(
        {"kind": "replayed motion", "pieces": pieces, "positions_m": list(map(str, places))}, "it"
    )


def test_a_motion_in_pieces_is_refused_by_one_mass():
    hand = WitnessMotion(zw_motion([0, 1, 2], 2))
    with pytest.raises(zw.InputError, match="2 pieces in a sample"):
        zw.simulate(device("28657").replace(transmission=None), zw.Wall(10), hand, 1e-3)
    with pytest.raises(zw.InputError, match="none of 2 pieces"):
        zw_motion([0, 1], 2)


def test_hands_of_finite_stiffness_are_sent_to_the_simulator():
    from zwidth.passivity.finite_stiffness import replay

    with pytest.raises(zw.InputError, match="zwidth simulate"):
        replay(zw.check(device("28657"), zw.Wall(140)))


def test_the_picture_has_the_band_and_the_motion():
    figure = zw.plots.check_figure(zw.check(device("28657"), zw.Wall(140)))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == [
        "distance from the circle's middle [radii]",
        "position x\n[mm]",
        "force f\n[mN]",
        "energy out\n[mJ]",
    ]
