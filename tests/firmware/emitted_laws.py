"""Laws of every kind that a machine may run, by name."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray
from random_scenes import random_scene

import zwidth as zw
from zwidth.machine.firmware.law import LawProgram
from zwidth.model import rendering as r
from zwidth.model.environment import Environment
from zwidth.study.bench.bench import standard_laws

PADDLE = zw.catalogue.device("haptic-paddle")
"""A converter with steps, an encoder, a force limit."""

BARE = zw.Device(mass="0.05", damping="0.1", resolution="1e-5", sample_period="0.0005")
"""Neither steps nor a limit."""

READ = zw.Device(mass="0.05", damping="0.1", sample_period="0.001")
"""Of which no resolution is known: the position is given."""

Law = tuple[zw.Device, Environment]


def _finger() -> dict[str, object]:
    return {"finger_mass": "0.01", "finger_stiffness": 100, "finger_damping": 1}


def laws() -> dict[str, Callable[[], Law]]:
    wall, damped = zw.Wall(300), zw.Wall(300, "0.2")
    random = np.random.default_rng(3)
    taps = [Fraction(int(n), 1000) for n in random.integers(-999, 1000, 101)]
    poles = np.poly([0.9, 0.5, -0.3, 0.8 + 0.1j, 0.8 - 0.1j, 0.2j, -0.2j, 0.99]).real
    points = np.round(np.cumsum(random.integers(1, 9, 160)) * 1e-4, 6)
    forces = np.round([-1, *random.normal(size=158), 1], 3)
    given: dict[str, Environment] = {
        "spring": wall,
        "damped": damped,
        "clamped": damped.replace(clamped=True),
        "bilateral": zw.PulseTransferFunction([500, -200], [1, 0]),
        "window": zw.Wall(300, "0.2", velocity_filter=r.Window(12)),
        "one_pole": zw.Wall(300, "0.2", velocity_filter=r.OnePole("0.002"), clamped=True),
        "detents": zw.NonlinearSpring.detents(5, "0.002", "0.5"),
        "bump_stop": zw.NonlinearSpring.bump_stop("0.003", 300, 4000000, "0.005"),
        "points": zw.NonlinearSpring([float(x) for x in points], [float(f) for f in forces]),
        "hunt_crossley": zw.HuntCrossley(30000, dissipation=2),
        "hertz": zw.HuntCrossley(30000, dissipation=0, exponent="1.5"),
        "power": zw.HuntCrossley(30000, dissipation=1, exponent="2.2", clamped=False),
        "square": zw.HuntCrossley(30000, dissipation=1, exponent=2),
        "maxwell": zw.Maxwell(500, 2),
        "solid": zw.StandardLinearSolid(200, 300, 2, clamped=True),
        "prony": zw.GeneralizedMaxwell(100, [(300, 2), (100, 5), (50, "0.1")]),
        "order_8": zw.PulseTransferFunction(
            [3, -1, 2, "0.5", 1, "0.2", "-0.1", 1, 2], [float(a) for a in poles]
        ),
        "fir_100": zw.PulseTransferFunction(taps, [1] + [0] * 100),
        "delayed": zw.PulseTransferFunction([300], [1, 0, 0, 0]),
        "scene_linear": random_scene(1, 8, ("spring", "damper", "mass")),
        "scene_contact": random_scene(2, 6, ("spring", "damper", "contact")),
        "scene_friction": random_scene(5, 6, ("spring", "damper", "friction")),
        "scene_points": random_scene(9, 6, ("spring", "damper", "points")),
        "coupled_scene": random_scene(7, 9),
    }
    chains = {
        "saturation": (wall, [r.Saturation(2)]),
        "slew": (damped, [r.SlewLimit(500)]),
        "dither": (wall, [r.Dither("0.01")]),
        "random_dither": (wall, [r.Dither("0.01", kind="random")]),
        "compensation": (wall, [r.FrictionCompensation("0.05", "0.01", "0.02")]),
        "sign_compensation": (wall, [r.FrictionCompensation("0.05", "0.01", 0)]),
        "best_fit": (wall, [r.Damper("0.2", r.AdaptiveWindow(fit="best"), clamped=True)]),
        "credit": (wall, [r.PassivityController(credit=True, forgetting="0.5", reference="spring")]),
        "leap_resets": (damped, [r.PassiveLeap(resets=True)]),
        "bounding_resets": (damped, [r.ForceBounding(resets=True)]),
        "wide_window": (damped, [r.WindowedController(window=50)]),
        "jumps": (damped, [r.DualRate(samples=5, updates="jump")]),
        "fixed_event": (wall, [r.EventTransient(kind="fixed", amplitude=1, duration="0.005")]),
        "throughout": (wall, [r.CrossingCorrection(throughout=True, **_finger())]),
        "slip": (damped, [r.Hysteresis(force="0.1", stiffness=500, clamped=True)]),
        "three": (
            wall,
            [
                r.Extrapolation(samples="0.5"),
                r.Damper("0.1", r.TickTime()),
                r.PassivityController(),
                r.Saturation(3),
            ],
        ),
        "four": (
            damped,
            [r.HalfSamplePrediction(**_finger()), r.SlewLimit(900), r.Dither("0.01"), r.ForceBounding()],
        ),
    }
    made: dict[str, Callable[[], Law]] = {}
    for name, environment in given.items():
        made[name] = lambda e=environment: (PADDLE, e)
    for name in ("damped", "points", "hunt_crossley", "prony", "order_8"):
        made[f"{name}_bare"] = lambda e=given[name]: (BARE, e)
        made[f"{name}_read"] = lambda e=given[name]: (READ, e)
    for name, (environment, chain) in chains.items():
        made[name] = lambda e=environment, c=chain: (PADDLE, r.render(e, *c))
    for name, law in standard_laws(PADDLE, zw.Wall(300)).items():
        made[f"bench_{name}".replace("-", "_")] = lambda e=law: (PADDLE, e)
    made["coupling"] = lambda: (PADDLE, r.VirtualCoupling(2000, 1, environment=zw.Maxwell(500, 2)))
    return made


def readings(law: LawProgram, seed: int, steps: int) -> NDArray[np.float64]:
    """Counts, or positions where the law is given those; −0.0 among them."""
    walk = counts(seed, steps)
    return walk if law.resolution > 0 else np.where(np.arange(steps) % 2, walk, -walk[::-1]) * 2.1e-5


def counts(seed: int, steps: int) -> NDArray[np.float64]:
    """A walk that goes in and out, with jumps, rests and readings as large as counts can be."""
    random = np.random.default_rng(seed)
    pace = random.choice([0, 1, 2, 10, 100], steps // 50 + 1).repeat(50)[:steps]
    walk = np.cumsum(np.rint(random.normal(size=steps) * pace))
    walk += np.rint(200 * np.sin(np.arange(steps) * 0.01))
    walk[steps // 2 :] -= walk[steps // 2]
    jumps = random.random(steps) < 0.002
    walk[jumps] += random.integers(-3000, 3000, jumps.sum())
    extreme = random.random(steps) < 0.0005
    walk[extreme] = random.choice([2**31 - 1, -(2**31) + 1, 32767, -32767, 0], extreme.sum())
    walk[-steps // 10 :] = np.rint(walk[-steps // 10 :] % 40 - 20)  # at the surface
    return walk
