"""Things that shake, each for one reason, and the logs they leave: simulated faults for `diagnosis.py`.

It knows nothing of the diagnosis.  A device, a law, a hand and a logger are drawn at random, and one fault is
put in.  A draw counts where the loop shakes with the fault and is quiet without it, the hand and everything
else unchanged: that is what it means here that the fault is the cause.  Others are drawn again.

Sampling, delay, velocity estimate, encoder, compensation of friction and the amplifier's voltage are those of
`zw.simulate`.  What it lacks is integrated here in steps of T/40: a damper inside the drive, friction that
falls with speed, and a handle on a springy shaft.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numba as nb
import numpy as np
from numpy.typing import NDArray

import zwidth as zw
from zwidth.device.amplifier import VoltageLimited

Array = NDArray[np.float64]

CAUSES = (
    "sampling",
    "delay",
    "differenced velocity",
    "encoder buzz",
    "drive damping",
    "friction compensation",
    "velocity-weakening friction",
    "actuator limit",
    "structural resonance",
)

FINE = 40
"""Steps of the integrator here in a sample period."""


@dataclass(frozen=True, kw_only=True)
class Thing:
    """All numbers of one loop, in SI units, and its fault."""

    cause: str
    motion: str
    mass: float
    damping: float
    coulomb: float
    resolution: float
    period: float
    stiffness: float
    virtual_damping: float = 0.0
    window: int = 1
    two_sided: bool = False
    delay: float = 0.0
    limit: float = 0.0
    slew: float = 0.0
    compensation: float = 0.0
    compensation_speed: float = 0.0
    hand_mass: float = 0.0
    hand_stiffness: float = 0.0
    hand_damping: float = 0.0
    press: float = 0.0
    drag: float = 0.0
    kick: float = 0.0
    drive_damping: float = 0.0
    drive_lag: float = 0.0
    stiction: float = 0.0
    stribeck_speed: float = 1.0
    shaft: float = 0.0
    shaft_damping: float = 0.0
    handle_mass: float = 0.0
    sensor_on_handle: bool = False
    duration: float = 2.0
    phase: float = 0.3
    mended: dict[str, Any] = field(default_factory=dict)

    def without_fault(self) -> Thing:
        """The same without the fault."""
        return replace(self, **self.mended)

    @property
    def device(self) -> zw.Device:
        """Its true numbers."""
        return zw.Device(
            motion=self.motion,
            mass=self.mass,
            damping=self.damping,
            coulomb_friction=self.coulomb,
            resolution=self.resolution,
            sample_period=self.period,
            delay=self.delay,
            **(
                {
                    "force_limit": self.limit,
                    "current_limit": 1.0,
                    "motor_inductance": 1.0,
                    "supply_voltage": self.slew / self.limit,
                }
                if self.slew
                else {"force_limit": self.limit}
                if self.limit
                else {}
            ),
        )


@dataclass(frozen=True)
class Run:
    """At the samples: time, what the encoder read, what was asked for, what the motor gave, true speed."""

    time: Array
    measured: Array
    commanded: Array
    applied: Array
    velocity: Array


def run(thing: Thing) -> Run:
    """Simulate it."""
    if thing.cause in ("drive damping", "velocity-weakening friction", "structural resonance"):
        return _run_here(thing)
    law: Any
    if thing.two_sided:
        law = _two_sided(thing)
    else:
        law = zw.Wall(
            stiffness=thing.stiffness,
            damping=thing.virtual_damping,
            velocity_filter=zw.rendering.Window(thing.window),
        )
    if thing.compensation:
        law = zw.render(
            law, zw.FrictionCompensation(coulomb=thing.compensation, speed=thing.compensation_speed)
        )
    trace = zw.simulate(
        thing.device,
        law,
        _hand(thing),
        thing.duration,
        initial_position=0.0 if thing.two_sided else -0.3 * _depth(thing),
        initial_velocity=thing.kick,
        encoder_phase=thing.phase,
        amplifier=VoltageLimited() if thing.slew else None,
    )
    names = ("time", "measured_position", "commanded_force", "actuator_force", "velocity")
    return Run(*(np.asarray(trace[name].values, dtype=float) for name in names))


def _two_sided(thing: Thing) -> Any:
    """K + B (1 − z⁻ᴺ)/(N T) on both sides."""
    k, b, n, t = thing.stiffness, thing.virtual_damping, thing.window, thing.period
    if not b:
        return zw.PulseTransferFunction([k], [1.0])
    gain = b / (n * t)
    return zw.PulseTransferFunction([k + gain, *[0.0] * (n - 1), -gain], [1.0, *[0.0] * n])


def _depth(thing: Thing) -> float:
    return thing.press / thing.stiffness if thing.press else 20 * thing.resolution


def _hand(thing: Thing) -> Any:
    if not thing.hand_stiffness:
        return zw.operators.ConstantForce(force=thing.press)
    return zw.operators.Finger(
        mass=thing.hand_mass,
        stiffness=thing.hand_stiffness,
        damping=thing.hand_damping,
        force=thing.press * (1 + thing.hand_stiffness / thing.stiffness),
        speed=max(thing.kick, 1e-3),
        start=0.0 if thing.two_sided else -0.3 * _depth(thing),
    )


def _run_here(thing: Thing) -> Run:
    steps = round(thing.duration / thing.period)
    numbers = np.array(
        [
            thing.mass, thing.damping, thing.coulomb, thing.resolution, thing.period, thing.stiffness,
            thing.virtual_damping, thing.two_sided, thing.limit, thing.hand_mass, thing.hand_stiffness,
            thing.hand_damping, thing.press, thing.drag, thing.kick, thing.drive_damping, thing.drive_lag,
            max(thing.stiction, thing.coulomb), thing.stribeck_speed, thing.shaft, thing.shaft_damping,
            thing.handle_mass, thing.sensor_on_handle, thing.phase,
        ],
        dtype=float,
    )  # fmt: skip
    late = round(thing.delay / thing.period)
    out = _integrate(numbers, thing.window, late, steps)
    return Run(np.arange(steps) * thing.period, *out)


@nb.njit(cache=True)
def _integrate(p: Array, window: int, late: int, steps: int) -> Array:
    (mass, b, fc, res, T, K, B, both, limit, mh, kh, ch, press, drag, kick, Bd, lag, fs, vs, shaft, cs, m2,
     on_handle, phase) = p  # fmt: skip
    out = np.zeros((4, steps))
    readings = np.zeros(steps + window)
    x, v, x2, v2 = 0.0, kick, 0.0, kick
    stiff = shaft > 0.0
    total = mass + (0.0 if stiff else mh)
    handle = m2 + mh
    drive_speed = 0.0
    behind = max(1, round(lag / T * FINE))
    past = np.zeros(behind)
    tick = 0
    dt = T / FINE
    command = np.zeros(steps)
    for k in range(steps):
        sensed = x2 if on_handle > 0 else x
        r = np.floor(sensed / res + phase) * res
        if k == 0:
            readings[: window + 1] = r
        readings[k + window] = r
        u = K * r + B * (r - readings[k]) / (window * T)
        if both == 0 and r <= 0.0:
            u = 0.0
        if limit > 0.0:
            u = min(max(u, -limit), limit)
        command[k] = u
        held = command[k - late] if k >= late else 0.0
        out[0, k], out[1, k] = r, u
        out[2, k] = held + Bd * drive_speed
        if limit > 0.0:
            out[2, k] = min(max(out[2, k], -limit), limit)
        out[3, k] = v2 if on_handle > 0 else v
        for i in range(FINE):
            t = k * T + i * dt
            if Bd != 0.0:
                drive_speed = past[tick % behind]
                past[tick % behind] = v
                tick += 1
            force = held + Bd * drive_speed
            if limit > 0.0:
                force = min(max(force, -limit), limit)
            anchor = drag * t + (press / kh if kh > 0 else 0.0)
            seat, move = (x2, v2) if stiff else (x, v)
            hand = kh * (anchor - seat) - ch * (move - drag) if kh > 0 else press
            push = -force
            if stiff:
                twist = shaft * (x - x2) + cs * (v - v2)
                push -= twist
                v2 += dt * (hand + twist) / handle
                x2 += dt * v2
            else:
                push += hand
            rub = fc + (fs - fc) * np.exp(-((v / vs) ** 2))
            free = v + dt * (push - b * v) / total
            drop = dt * rub / total
            v = 0.0 if abs(free) <= drop else free - drop * np.sign(free)
            x += dt * v
        if abs(x) > 1e3:
            out[:, k:] = np.nan
            break
    return out


def shakes(thing: Thing, made: Run) -> bool:
    """True where it goes on shaking to the end, as far as a log can show: four counts, six cycles, 2 Hz.

    The encoder's own buzz may be as small as half a count.
    """
    if not np.isfinite(made.measured).all():
        return False
    least = 0.5 if thing.cause == "encoder buzz" else 4.0
    swings = _swings(thing, made)
    if swings[-1] < least * thing.resolution or swings[-1] < 0.3 * swings[0]:
        return False
    last = made.velocity[-made.time.size // 3 :]
    power = np.abs(np.fft.rfft((last - last.mean()) * np.hanning(last.size))) ** 2
    peak = int(np.argmax(power))
    return peak >= 6 and peak / (last.size * thing.period) >= 2.0


def quiet(thing: Thing, made: Run) -> bool:
    """True where it has come to rest, or is going to: a tenth of a count, or below half of what it was."""
    if not np.isfinite(made.measured).all():
        return False
    swings = _swings(thing, made)
    return bool(swings[-1] < 0.1 * thing.resolution or (swings[-1] < 0.5 * swings[0] and thing.kick > 0))


def _swings(thing: Thing, made: Run) -> Array:
    """[m; rad] mean peak to peak of the true motion in two thirds of the time: pieces of an eighth, a line
    taken off.
    """
    moved = np.cumsum(made.velocity) * thing.period
    pieces = np.array_split(moved[-2 * made.time.size // 3 :], 8)
    return np.array(
        [np.ptp(p - np.polyval(np.polyfit(np.arange(p.size), p, 1), np.arange(p.size))) for p in pieces]
    )


# ---- draws ---------------------------------------------------------------------------------------------


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


# ---- the logger ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Logged:
    """A file, and what its owner knows of the device: nothing, or numbers that are somewhat wrong."""

    path: Path
    device: zw.Device | None
    columns: str
    every: int


def write_log(rng: np.random.Generator, thing: Thing, made: Run, path: Path) -> Logged:
    """Log it as people do: every sample or fewer, from the start or later, one column of force or both."""
    every = int(rng.choice([1, 1, 1, 1, 2, 3, 4]))
    frequency = _frequency(thing, made)
    while every > 1 and every * thing.period * frequency > 0.12:
        every -= 1
    start = int(made.time.size * rng.choice([0.0, 0.0, 0.3, 0.5]))
    rows = slice(start, None, every)
    which = str(rng.choice(["both", "commanded", "applied"], p=[0.75, 0.15, 0.10]))
    size = float(np.std(made.applied[-made.time.size // 3 :])) or 1.0
    noise = size * float(rng.choice([0.0, 0.003, 0.02])) * rng.normal(size=made.time.size)
    digits = int(np.ceil(-np.log10(size))) + 4
    turn = thing.motion == "rotary"
    columns = {
        "time_s": [f"{t:.6f}" for t in made.time[rows] + rng.uniform(0, 9)],
        ("angle_deg" if turn else "position_mm"): [
            f"{x:.7g}" for x in made.measured[rows] * (180 / np.pi if turn else 1e3)
        ],
    }
    unit = "_N_m" if turn else "_N"
    if which != "applied":
        columns[("commanded_torque" if turn else "commanded_force") + unit] = [
            f"{f:.{max(digits, 0)}f}" for f in made.commanded[rows]
        ]
    if which != "commanded":
        columns[("motor_torque" if turn else "motor_force") + unit] = [
            f"{f:.{max(digits, 0)}f}" for f in (made.applied + noise)[rows]
        ]
    lines = [",".join(columns), *(",".join(row) for row in zip(*columns.values(), strict=True))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Logged(path, _as_its_owner_knows_it(rng, thing), which, every)


def _frequency(thing: Thing, made: Run) -> float:
    last = made.velocity[-made.time.size // 3 :]
    power = np.abs(np.fft.rfft((last - last.mean()) * np.hanning(last.size)))
    return float(np.argmax(power)) / (last.size * thing.period)


def _as_its_owner_knows_it(rng: np.random.Generator, thing: Thing) -> zw.Device | None:
    about = [float(f"{rng.uniform(0.85, 1.15):.3f}") for _ in range(3)]
    if rng.random() < 0.1:
        return None
    return zw.Device(
        motion=thing.motion,  # type: ignore[arg-type]
        mass=(thing.mass + thing.handle_mass) * about[0],
        damping=thing.damping * about[1],
        coulomb_friction=thing.coulomb * about[2],
        resolution=thing.resolution,
        sample_period=thing.period,
    )
