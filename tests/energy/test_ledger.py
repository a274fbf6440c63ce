"""The ledger: what it adds up, and when it says that energy came out."""

from __future__ import annotations

import numpy as np
import pytest

import zwidth as zw
from zwidth.loop.energy import ledger

PADDLE = zw.catalogue.device("haptic-paddle")


def _touch(stiffness: float, hand=None, **options):
    return zw.simulate(PADDLE, zw.Wall(stiffness), hand or zw.operators.Dowel(), 0.6, **options)


def test_both_balances_close_to_rounding():
    trace = _touch(600.0, zw.operators.Finger())
    book = trace.zwidth.energy
    assert book.closes
    assert np.abs(book.residual).max() < 1e-15
    tampered = trace.copy()
    tampered["viscous_loss"] = trace.viscous_loss * 1.001
    assert not ledger(tampered).closes


def test_a_passive_loop_gives_nothing_out_and_an_active_one_does():
    """300 N/m is passive: no hand gets anything; at 770 N/m the dowel does."""
    assert _touch(300.0).zwidth.energy.extracted <= 0.0
    assert _touch(770.0).zwidth.energy.extracted > 1e-3


def test_what_the_device_held_at_first_does_not_count_as_extracted():
    """A hand that only stops a moving device gets its kinetic energy, and no more."""
    free = zw.Device(mass=0.5, damping=0.0, rate=1000)
    hand = zw.operators.ConstantForce(-1.0)
    trace = zw.simulate(free, zw.Wall(0.0), hand, 0.25, initial_velocity=0.5)
    book = trace.zwidth.energy
    assert -trace.hand_work.values.min() == pytest.approx(0.5 * 0.5 * 0.25, rel=1e-9)
    assert book.extracted == pytest.approx(0.0, abs=1e-12)


def test_totals_in_words_numbers_and_html():
    book = _touch(500.0).zwidth.energy
    assert "the hand put into the device" in repr(book)
    assert book._repr_html_().startswith("<table>")
    assert book.to_dict()["hand_work_J"] == book.totals["hand_work"]
    plain = _touch(500.0, zw.operators.ConstantForce(1.0)).zwidth.energy
    assert "damper" not in repr(plain)


def test_a_dataset_without_energies_is_refused():
    with pytest.raises(zw.InputError, match="lacks viscous_loss"):
        ledger(_touch(100.0).drop_vars("viscous_loss"))
