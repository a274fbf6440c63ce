"""Chains that end in force bounding, in float: the law pays for the rounding of 24 bits itself."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.host import HostLaw
from firmware.emulated.required import require

import zwidth as zw
from zwidth.errors import InputError
from zwidth.machine.firmware.verdict import judged

PADDLE = zw.catalogue.device("haptic-paddle")
STIFF = zw.render(zw.Wall(2000, 1), zw.rendering.SlewLimit(2000), zw.rendering.ForceBounding())


def test_the_certificate_has_the_rounding_of_float() -> None:
    found = zw.emit(PADDLE, STIFF, number="float")
    assert found.judged.outcome == "passive"
    document = found.verdict.certificate.to_dict()
    assert Fraction(document["law"]["roundoff"]) == Fraction(1, 2**24)
    assert zw.verify(document).scope is not None
    document["law"]["hair"] = str(Fraction(1, 2**48))
    assert zw.verify(document).scope is None


def test_no_motion_gains_from_the_emitted_law(tmp_path: Path) -> None:
    """Walks, jumps and edges between two counts: the hand has put in at least as much as it has taken out."""
    require("host")
    found = zw.emit(PADDLE, STIFF, number="float", travel="-50 .. 50 mm")
    law, random = HostLaw(found.text, tmp_path), np.random.default_rng(3)
    b, friction, count, period = (
        float(PADDLE.exact(key)) for key in ("damping", "coulomb_friction", "resolution", "sample_period")
    )
    for size in (1, 3, 40, 1500):
        n = np.clip(np.cumsum(random.integers(-size, size + 1, 20_000)), -2000, 2000).astype(np.int32)
        law.init(int(n[0]))
        force = np.asarray(law.run(n), dtype=float)
        assert np.abs(force).max() > 0.1
        moves = count * np.diff(n.astype(float))
        put_in = np.cumsum(force[:-1] * moves + friction * np.abs(moves) + b / period * moves**2)
        assert put_in.min() >= -1e-9 * np.abs(put_in).max()


def test_a_delay_is_not_left_out() -> None:
    """Force bounding is proved without delay: neither a delay nor an interval of them is taken for none."""
    late = PADDLE.replace(delay=zw.Interval(0, zw.Exact("0.0002")))
    with pytest.raises(InputError, match="give one number"):
        zw.emit(late, STIFF, number="float")
    with pytest.raises(InputError, match="not emitted"):
        zw.emit(PADDLE.replace(delay="0.2 ms"), STIFF, number="float")
    machine = zw.emit(PADDLE, STIFF, number="float").machine
    undecided = replace(zw.check(PADDLE, zw.Wall(100)), outcome="undecided", certificate=None)
    assert not judged(late, STIFF, machine, lambda *_: undecided).proved
