"""The device that most tests here are about: 0.1 mm a count at 1 kHz."""

from __future__ import annotations

from fractions import Fraction

import zwidth as zw


def device(damping, friction, delay=0, **more):
    """The delay in samples; other numbers as they are given."""
    given = {"resolution": "0.0001", "sample_period": "0.001", "delay": Fraction(delay) / 1000, **more}
    return zw.Device(damping=damping, coulomb_friction=friction, **given)


def counted(loop):
    """Of its actuator, what is known."""
    return {f"force_{key}": getattr(loop, f"force_{key}") is not None for key in ("limit", "resolution")}
