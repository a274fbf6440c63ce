"""One recording, in every form that the tests write it."""

from __future__ import annotations

import numpy as np
import pytest
from known_motion import STEP, Recording


@pytest.fixture
def recording() -> Recording:
    """Two seconds at 2 kHz of a hand that moves 3 mm to and fro."""
    random = np.random.default_rng(5)
    time = np.arange(4000) / 2000
    motion = 3e-3 * np.sin(7.3 * time) + 1e-4 * np.sin(131.0 * time)
    force = np.round(2.0 * np.cos(7.3 * time) + 0.05 * random.normal(size=time.size), 5)
    return Recording(time, np.rint(motion / STEP) * STEP, force)
