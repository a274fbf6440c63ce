"""The checker of absolute stability accepts what is proved, refuses the rest; the plant by another road."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from checked import read
from scipy.linalg import expm
from strategies import seeds

from zwidth import checker
from zwidth.checker.known_hand.wall import plant_of

LOOP = {
    "mass_kg": "0.05",
    "damping_N_s_per_m": "0.7",
    "hand_mass_kg": "0.01",
    "hand_damping_N_s_per_m": "0.3",
    "hand_stiffness_N_per_m": "350",
    "sample_period_s": "0.001",
    "delay_s": "0.0014",
}


def document(**changes):
    """Example 6 of Carrasco et al. (2020), proved up to 0.9 by one tap."""
    base = {
        "kind": "absolute stability",
        "plant": {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]},
        "nonlinearity": "monotone",
        "slope": "0.9",
        "center": "1",
        "taps": [{"place": -1, "weight": "0.23"}, {"place": -2, "weight": "0.5"}],
        "convexity": "0",
        "smoothness": "0",
    }
    return {**base, **changes}


def left_side(doc, angles):
    """The inequality from its definition, in floats."""
    z = np.exp(1j * angles)
    top, bottom = ([float(Fraction(c)) for c in doc["plant"][k]] for k in ("numerator", "denominator"))
    g = np.polyval(top, z) / np.polyval(bottom, z)
    k, m = float(doc["slope"]), float(doc["center"])
    m = m - sum(float(t["weight"]) * z ** -t["place"] for t in doc["taps"])
    q1, q2 = float(doc["convexity"]), float(doc["smoothness"])
    convex = q1 * k * ((1 - 1 / z) * g).real
    smooth = q2 * k * (((z - 1) * g).real - k / 2 * abs((z - 1) * g) ** 2)
    return (m * (1 + k * g)).real + convex + smooth


@seeds(12)
def test_sign_is_that_of_the_definition(seed):
    """A random multiplier is accepted exactly where the inequality, evaluated on a fine grid, is positive."""
    rng = np.random.default_rng(seed)
    places = rng.choice([-3, -2, -1, 1, 2, 3], size=2, replace=False)
    weights = rng.uniform(0, 0.45, size=2).round(3)
    doc = document(
        slope=str(round(rng.uniform(0.3, 1.0), 4)),
        taps=[{"place": int(p), "weight": str(w)} for p, w in zip(places, weights, strict=True)],
        convexity=str(rng.choice([0, 0.7])),
        smoothness=str(rng.choice([0, 0.4])),
    )
    least = left_side(doc, np.linspace(0, np.pi, 20001)).min()
    assert abs(least) > 1e-6
    assert checker.verify(doc).valid == (least > 0)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"taps": [{"place": 1, "weight": "-0.1"}]}, "not odd"),
        ({"taps": [{"place": 1, "weight": "0.6"}, {"place": 2, "weight": "0.4"}]}, "less than the center"),
        ({"taps": [{"place": 0, "weight": "0.1"}]}, "place"),
        ({"taps": [{"place": 1, "weight": "0.1"}, {"place": 1, "weight": "0.1"}]}, "place"),
        ({"smoothness": "-1"}, "≥ 0"),
        ({"slope": "0"}, "> 0"),
        ({"slope": "1.5"}, "positive"),
        ({"nonlinearity": "any"}, "nonlinearity"),
        ({"plant": {"numerator": ["1", "2", "3"], "denominator": ["1", "0", "0"]}}, "proper"),
        ({"plant": {"numerator": ["1"], "denominator": ["1", "-1.01"]}}, "unit circle"),
    ],
)
def test_refuses_what_proves_nothing(change, reason):
    found = checker.verify(document(slope="0.3", taps=[], **{}) | change)
    assert checker.verify(document(slope="0.3", taps=[])).valid
    assert not found.valid
    assert reason in found.reason


def test_plant_of_a_touched_device_by_another_road():
    told = {**document(), "loop": LOOP}
    del told["plant"]
    plant = plant_of(read(told), 320)
    assert max(x.reach for x in (*plant.numerator, *plant.denominator)) < 1 << 120
    mass, damping, stiffness, period, late = 0.06, 1.0, 350.0, 0.001, 1.4
    flow = np.array([[0, 1, 0], [-stiffness / mass, -damping / mass, 1 / mass], [0, 0, 0]])

    def stepped(state, force, span):
        return (expm(flow * span * period) @ np.array([*state, force]))[:2]

    force = [1.0] + [0.0] * 60
    state, seen = np.zeros(2), []
    for k in range(61):
        seen.append(state[0])
        held = [force[k - 2] if k >= 2 else 0.0, force[k - 1] if k >= 1 else 0.0]
        state = stepped(stepped(state, held[0], late - 1), held[1], 2 - late)
    top, bottom = ([c.middle / 2**320 for c in part] for part in plant)
    top = [0.0] * (len(bottom) - len(top)) + top
    response = np.zeros(61)
    for k in range(61):
        own = sum(c * response[k - i] for i, c in enumerate(bottom) if i and k >= i)
        response[k] = (top[k] if k < len(top) else 0.0) - own
    assert response == pytest.approx(seen, rel=1e-9, abs=1e-12 * max(seen))


@pytest.mark.parametrize("name", ["hand_stiffness_N_per_m", "mass_kg", "sample_period_s"])
def test_plant_that_is_not_stable_is_refused(name):
    doc = {k: v for k, v in document(slope="10", taps=[]).items() if k != "plant"}
    assert checker.verify({**doc, "loop": LOOP}).valid
    assert "must be > 0" in checker.verify({**doc, "loop": {**LOOP, name: "0"}}).reason
