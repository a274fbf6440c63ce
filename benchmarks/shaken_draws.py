"""Draws of things that shake for one reason: a device, a law and a hand at random, and one fault put in.

A draw counts where the loop goes on shaking with the fault and is quiet without it, the hand and everything
else unchanged: that is what it means here that the fault is the cause.  Others are drawn again.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from shaken import Run, Thing, quiet, run, shakes

import zwidth as zw


def draw(rng: np.random.Generator, cause: str) -> tuple[Thing, Run]:
    """A thing that shakes for this reason alone, and its motion."""
    for _ in range(4000):
        thing = _DRAWS[cause](rng, _base(rng))
        try:
            made = run(thing)
            if not shakes(thing, made) or not np.isfinite(made.measured).all():
                continue
            if np.ptp(made.measured) > 1.0:
                continue
            mended = thing.without_fault()
            if quiet(mended, run(mended)):
                return thing, made
        except zw.InputError:
            continue
    raise RuntimeError(f"no draw of {cause} shakes with its fault alone")


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _base(rng: np.random.Generator) -> dict[str, Any]:
    """A device and a hand without any fault; K is set where the fault is."""
    wheel = rng.random() < 0.45
    period = 1.0 / float(rng.choice([250, 500, 1000, 1000, 1000, 2000]))
    if wheel:
        mass, counts = _log(rng, 0.002, 0.02), float(rng.choice([1000, 4096, 10000, 16384, 65536]))
        resolution = 2 * np.pi / counts
        two_sided = rng.random() < 0.7
        scale = 1.0
    else:
        mass, resolution, two_sided, scale = (
            _log(rng, 0.03, 0.4),
            _log(rng, 3e-6, 4e-5),
            rng.random() < 0.2,
            0.02,
        )
    natural = _log(rng, 20.0, 0.35 / period if period < 3e-3 else 80.0)
    stiffness = mass * natural**2
    swing = scale * _log(rng, 0.02, 0.1)
    damping = 2 * _log(rng, 0.01, 0.06) * mass * natural
    base: dict[str, Any] = {
        "motion": "rotary" if wheel else "linear",
        "mass": mass,
        "damping": damping,
        "coulomb": _log(rng, 0.002, 0.02) * stiffness * swing,
        "resolution": resolution,
        "period": period,
        "stiffness": stiffness,
        "two_sided": two_sided,
        "kick": natural * swing * rng.uniform(0.3, 1.0),
        "press": 0.0 if two_sided else stiffness * swing,
        "phase": rng.random(),
        "limit": stiffness * swing * _log(rng, 1.2, 3.0),
        "duration": float(np.clip(80 * 2 * np.pi / natural, 1.0, 4.0)),
    }
    if not two_sided or rng.random() < 0.5:
        base["hand_mass"] = mass * _log(rng, 0.02, 0.3)
        base["hand_stiffness"] = stiffness * _log(rng, 0.02, 0.3)
        base["hand_damping"] = damping * _log(rng, 0.1, 1.5)
    return base


def _losses(base: dict[str, Any]) -> float:
    """b and the hand's c, which pay together."""
    return base["damping"] + base.get("hand_damping", 0.0)


def _sampling(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    ask = _losses(base) * _log(rng, 1.5, 5.0)
    scale = ask / (0.5 * base["stiffness"] * base["period"])
    if scale < 1:
        loss = 0.5 * base["stiffness"] * base["period"] / ask
        base["damping"] *= loss
        if "hand_damping" in base:
            base["hand_damping"] *= loss
    else:
        loss = 0.5 * base["stiffness"] * base["period"] / ask
        base["damping"] *= loss
        if "hand_damping" in base:
            base["hand_damping"] *= loss
    some = _log(rng, 0.01, 0.2) * base["damping"] if rng.random() < 0.4 else 0.0
    softer = 0.7 * 2 * base["damping"] / base["period"]
    return Thing(
        cause="sampling",
        **base,
        virtual_damping=some,
        mended={
            "stiffness": softer,
            "press": base["press"] * softer / base["stiffness"],
            "virtual_damping": 0.0,
        },
    )


def _delay(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    samples = float(rng.integers(1, 13)) if rng.random() < 0.7 else float(rng.uniform(0.8, 12.0))
    return Thing(
        cause="delay",
        **base,
        delay=samples * base["period"],
        virtual_damping=base["damping"] * _log(rng, 0.05, 0.5) if rng.random() < 0.4 else 0.0,
        window=int(rng.choice([1, 1, 2, 5])),
        mended={"delay": 0.0},
    )


def _velocity(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    window = int(rng.choice([1, 1, 2, 3, 5, 8, 10, 15, 20]))
    moving = base["mass"] + base.get("hand_mass", 0.0)
    return Thing(
        cause="differenced velocity",
        **base,
        window=window,
        virtual_damping=moving / ((window + 1) * base["period"]) * _log(rng, 0.5, 4.0),
        mended={"virtual_damping": 0.0},
    )


def _encoder(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(held * _log(rng, 1.2, 2.5), 0.3 * base["damping"])
    base["resolution"] *= _log(rng, 2.0, 20.0)
    base["coulomb"] = base["stiffness"] * base["resolution"] / 2 * _log(rng, 0.01, 0.7)
    if "hand_damping" in base:
        base["hand_damping"] = base["damping"] * _log(rng, 0.05, 0.5)
    step = base["stiffness"] * base["resolution"]
    if base["press"]:
        base["press"] = step * (rng.integers(1, 15) + rng.uniform(0.3, 0.7))
        base["kick"] = min(base["kick"], 10 * base["resolution"] / base["period"] / 20)
    return Thing(cause="encoder buzz", **base, mended={"resolution": base["resolution"] / 200})


def _drive(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    moving = base["mass"] + base.get("hand_mass", 0.0)
    lag = base["period"] * _log(rng, 1.5, 10.0)
    return Thing(
        cause="drive damping",
        **base,
        drive_damping=moving / lag * _log(rng, 0.5, 6.0),
        drive_lag=lag,
        mended={"drive_damping": 0.0},
    )


def _compensation(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    base["coulomb"] *= 3
    over = base["coulomb"] * _log(rng, 1.2, 4.0)
    speed = base["kick"] * _log(rng, 0.01, 0.1) if rng.random() < 0.7 else 0.0
    return Thing(
        cause="friction compensation",
        **base,
        compensation=over,
        compensation_speed=speed,
        mended={"compensation": 0.6 * base["coulomb"]},
    )


def _weakening(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    base["hand_mass"] = base["mass"] * _log(rng, 0.05, 0.5)
    base["hand_stiffness"] = base["stiffness"] * _log(rng, 0.1, 1.0)
    base["hand_damping"] = base["damping"] * _log(rng, 0.05, 0.5)
    natural = np.sqrt(base["stiffness"] / base["mass"])
    swing = base["kick"] / natural
    base["coulomb"] = base["stiffness"] * swing * _log(rng, 0.02, 0.2)
    stuck = base["coulomb"] * _log(rng, 1.5, 5.0)
    base["drag"] = swing * natural * _log(rng, 0.002, 0.05) * rng.choice([1.0, 1.0])
    base["limit"] = 0.0
    return Thing(
        cause="velocity-weakening friction",
        **base,
        stiction=stuck,
        stribeck_speed=base["drag"] * _log(rng, 1.0, 8.0),
        mended={"stiction": base["coulomb"], "stribeck_speed": 1.0},
    )


def _limited(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(0.5 * base["damping"], held * _log(rng, 1.4, 3.0))
    natural = np.sqrt(base["stiffness"] / base["mass"])
    swing = base["kick"] / natural
    base["limit"] = base["stiffness"] * swing * _log(rng, 1.5, 10.0)
    base["kick"] *= rng.uniform(1.0, 3.0)
    return Thing(
        cause="actuator limit",
        **base,
        slew=base["stiffness"] * swing * natural * _log(rng, 0.1, 1.0),
        mended={"slew": 0.0},
    )


def _structural(rng: np.random.Generator, base: dict[str, Any]) -> Thing:
    held = 0.5 * base["stiffness"] * base["period"]
    base["damping"] = max(base["damping"], held * _log(rng, 1.4, 4.0))
    natural = np.sqrt(base["stiffness"] / base["mass"])
    moving = base["mass"]
    share = rng.uniform(0.25, 0.75)
    base["mass"] = moving * share
    mode = natural * _log(rng, 2.5, 10.0)
    if mode * base["period"] > 1.2:
        mode = 1.2 / base["period"]
    reduced = moving * share * (1 - share)
    shaft = reduced * mode**2
    window = int(rng.choice([1, 2, 3, 5]))
    return Thing(
        cause="structural resonance",
        **base,
        handle_mass=moving * (1 - share),
        shaft=shaft,
        shaft_damping=2 * _log(rng, 0.003, 0.03) * reduced * mode,
        sensor_on_handle=bool(rng.random() < 0.6),
        virtual_damping=base["damping"] * _log(rng, 0.3, 6.0),
        window=window,
        mended={"shaft": 0.0, "mass": moving, "sensor_on_handle": False},
    )


_DRAWS = {
    "sampling": _sampling,
    "delay": _delay,
    "differenced velocity": _velocity,
    "encoder buzz": _encoder,
    "drive damping": _drive,
    "friction compensation": _compensation,
    "velocity-weakening friction": _weakening,
    "actuator limit": _limited,
    "structural resonance": _structural,
}
