"""What a vibration lives on: the energy of a cycle, and who puts it in.

In a motion x = Re Σ X_n exp(jnωt) a force f = Re Σ F_n exp(jnωt), positive against x, gives in each cycle

    W = −∮ f dx = −π Σ n Im(F_n X_n*)                            [J]

A law answers with F_n = Z(nω) X_n, and what is applied of it is F h exp(−jωτ), with the hold
h = sinc(ωT/2) exp(−jωT/2) and the delay τ.  So what goes in comes apart, term by term:

    sampling               the spring, through the hold
    delay                  what exp(−jωτ) adds to spring and damper
    differenced velocity   the damper through its estimate and the hold, where that is positive; or what the
                           impulse B Δ of one count gives the mass, where no more are seen at a time
    friction compensation  the force along the motion
    drive damping          what the drive adds by itself
    actuator limit         what a limited rate adds

and what goes out: b of the device takes π ω b |X|² and its Coulomb friction 4 f_c |X|.  What goes out must
come in: where the known terms fall short, something that was not recorded feeds the motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zwidth.data.diagnosis import drive, law
from zwidth.data.diagnosis.drive import Drive
from zwidth.data.diagnosis.law import Law
from zwidth.data.diagnosis.recording import Recording
from zwidth.data.diagnosis.stated import Stated, compare
from zwidth.data.diagnosis.vibration import Vibration, phasors
from zwidth.model.device import Device, in_one
from zwidth.model.environment.environment import Environment
from zwidth.native.compiled import Array
from zwidth.quantity.exact import middle
from zwidth.quantity.glossary import GLOSSARY

TERMS = (
    "sampling",
    "delay",
    "differenced velocity",
    "friction compensation",
    "drive damping",
    "actuator limit",
)

_ALIKE = 2e-3
"""Share of the applied force's variance by which it may differ from the command and be the same."""


@dataclass(frozen=True, kw_only=True)
class Known:
    """What is known of the device, in plain numbers; None where nobody said it."""

    mass: float | None = None
    damping: float | None = None
    coulomb: float | None = None
    resolution: float | None = None
    period: float | None = None
    delay: float = 0.0

    @classmethod
    def of(cls, device: Device | None) -> Known:
        """The middle of each number of a device, of motor and handle together."""
        if device is None:
            return cls()
        device = in_one(device)
        return cls(
            mass=middle(device.mass),
            damping=middle(device.damping),
            coulomb=middle(device.coulomb_friction),
            resolution=middle(device.resolution) or None,
            period=middle(device.sample_period),
            delay=middle(device.delay) or 0.0,
        )


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """Everything that was measured in a recording of a vibration."""

    vibration: Vibration
    loop_period: float
    """[s] T of the loop."""
    resolution: float
    """[m; rad] Δ; 0 where none is seen."""
    law: Law | None
    drive: Drive | None
    """What lies between the two forces; None where one was recorded."""
    amplitude: float
    """[m; rad] |X|."""
    delay: float
    """[s] from a sample to its force, as far as it is seen or stated."""
    supplied: Mapping[str, float]
    """[J] that each term gives in a cycle, negative where it takes."""
    total: float
    """[J] that the actuator gives in a cycle in all, by the phasors."""
    energy: float
    """[J] the same by the held force along each move, where every sample of the loop is in the file; else
    the total."""
    lost: float | None
    """[J] that the device's friction takes in a cycle; None without a device."""
    apparent_mass: float
    """[kg; kg·m²] Re(F/X)/ω²: the mass that would move so under the force."""
    standing: float
    """Share of the time in which it stands, where a sine does so for a sixteenth."""
    distortion: float
    roles: tuple[str, ...]
    known: Known
    rotary: bool
    """Of a wheel, a knob, a joint."""
    moves_as: complex | None
    """The force that a rigid device of these numbers would take to move so, over the force in the file, as
    amplitude and phase at ω: 1 where nothing else acts.  None where nobody said the mass."""
    bend: complex
    force_bend: complex
    """Third harmonic of the force that the motion takes, and of the one in the file, F₃ (F₁*)³/|F₁|⁴: 1/9
    of a triangle, −1/3 of a square."""
    by_inside: float | None
    """Share of the motor's force that a spring and a damper inside the drive leave over, where the command
    is not in the file."""
    ramps: float | None
    """Share of the time in which the motor's force changes about as fast as it ever does; None without it."""
    stated: Stated | None = None
    """The law as somebody stated it, beside the force; None where nobody did."""
    pulse: float = 0.0
    """[J] (B Δ)²/2m, where the damper reads few counts; else 0."""
    aimed: float | None = None
    """How far the target moves at the frequency, against the motion; None where the file has none."""

    @property
    def recorded(self) -> str:
        """Which forces there are: "both", "command" or "motor"."""
        return "both" if len(self.roles) == 2 else "command" if "commanded" in self.roles else "motor"

    @property
    def sees_delay(self) -> bool:
        """True where the file shows what comes between a sample and its force."""
        return "applied" in self.roles

    def unit(self, name: str) -> str:
        """Of a quantity of the glossary, for this motion."""
        return GLOSSARY[name].unit_for("rotary" if self.rotary else "linear")

    @property
    def counts(self) -> float:
        """Swing from end to end in counts of the encoder; infinite where none is seen."""
        return self.vibration.swing / self.resolution if self.resolution else np.inf


class _Aligned(NamedTuple):
    """The file around the vibration, forces positive against the motion; `steady` is the vibration in it."""

    x: Array
    error: Array
    """From the target to the position; the position where there is no target."""
    commanded: Array | None
    applied: Array | None
    period: float
    loop_period: float
    cycle: float
    steady: slice

    def drive_after(self, commanded: Array | None) -> Drive | None:
        """What lies between a command and what was applied, where there are both."""
        if self.applied is None or commanded is None:
            return None
        return drive.account(commanded, self.applied, self.x, self.period, self.loop_period, self.cycle)


class _Fitted(NamedTuple):
    law: Law | None
    stated: Stated | None
    commanded: Array | None
    """As recorded, else as the stated law asks for."""
    drive: Drive | None
    by_inside: float | None


def gather(
    recording: Recording, vibration: Vibration, device: Device | None, stated: Environment | None = None
) -> Evidence:
    """Measure everything; where the law is stated and the force follows it, by its own numbers."""
    known = Known.of(device)
    file = _aligned(recording, vibration, known)
    fitted = _fitted(file, stated)
    x, period = file.x[file.steady], file.period
    commanded, applied = (None if f is None else f[file.steady] for f in (fitted.commanded, file.applied))
    force = applied if applied is not None else commanded
    assert force is not None
    xs = phasors(x, vibration.frequency, period)
    xs[0] = xs[0] or np.finfo(float).tiny
    X = complex(xs[0])
    delay = _delay(known, fitted, commanded is not None)
    motion = Motion(xs, vibration.angular, file.loop_period, vibration.frequency, period)
    held, needed = motion.phasors(force), motion.needed(known)
    F = held * (1 if applied is not None else motion.late(delay))
    aims = (file.x - file.error)[file.steady]
    resolution = known.resolution or recording.resolution or _count(x)
    supplied = _terms(fitted, motion, delay, force if commanded is None else commanded)
    if pulse := _pulse(fitted.law, known, vibration, resolution, file.loop_period):
        supplied["differenced velocity"] = pulse
    lost = None
    if known.damping is not None:
        lost = motion.viscous(known.damping) + 4 * (known.coulomb or 0.0) * abs(X)
    return Evidence(
        vibration=vibration,
        loop_period=file.loop_period,
        resolution=resolution,
        law=fitted.law,
        drive=fitted.drive,
        amplitude=float(abs(X)),
        delay=delay,
        supplied=supplied,
        total=motion.work(F),
        energy=_along(x, force, 0 if applied is not None else round(delay / period))
        if abs(period - file.loop_period) < 0.01 * period
        else motion.work(F),
        lost=lost,
        apparent_mass=float(np.real(F[0] / X)) / motion.omega**2,
        standing=_standing(x, period, file.cycle),
        distortion=float(np.sqrt((np.abs(xs[1:]) ** 2).sum()) / abs(X)),
        roles=tuple(name for name, f in (("commanded", commanded), ("applied", applied)) if f is not None),
        known=known,
        rotary=recording.motion == "rotary",
        moves_as=None if known.mass is None or not abs(held[0]) else complex(needed[0] / held[0]),
        bend=_bend(needed),
        force_bend=_bend(held),
        by_inside=fitted.by_inside,
        ramps=None if applied is None else drive.ramps(applied),
        stated=fitted.stated,
        pulse=pulse,
        aimed=None
        if recording.target is None
        else float(abs(phasors(aims, vibration.frequency, period)[0]) / abs(X)),
    )


def _aligned(recording: Recording, vibration: Vibration, known: Known) -> _Aligned:
    around, period = vibration.around, recording.period
    steady = slice(vibration.rows.start - around.start, vibration.rows.stop - around.start)
    x = recording.position[around]
    error = x if recording.target is None else x - recording.target[around]
    forces = [None if f is None else f[around] for f in (recording.commanded, recording.applied)]
    seen = next(f for f in forces if f is not None)
    sign = _sign(error[steady], seen[steady])
    commanded, applied = (None if f is None else sign * f for f in forces)
    loop_period = known.period or _loop_period(commanded, period)
    return _Aligned(x, error, commanded, applied, period, loop_period, 1 / vibration.frequency, steady)


def _fitted(file: _Aligned, stated: Environment | None) -> _Fitted:
    """Over all of the file; what an Evidence keeps of it is of the vibration alone."""
    force = file.applied if file.commanded is None else file.commanded
    assert force is not None
    seen = file.error, force, file.period, file.loop_period, _lags(file)
    told = None
    if stated is not None and np.ptp(force):
        told = _accounted(file, compare(stated, *seen, file.commanded is not None))
    if told is None or not told.holds:
        commanded, found = file.commanded, law.fit(*seen) if np.ptp(force) else None
    else:
        commanded = told.asked if file.commanded is None else force
        found = told.as_law(commanded, file.loop_period)
    between = file.drive_after(commanded)
    return _Fitted(
        found and replace(found, compensated=found.compensated[file.steady]),
        told,
        commanded,
        between and replace(between, applied=between.applied[file.steady]),
        drive.inside(force, file.error, file.period, file.cycle) if commanded is None else None,
    )


def _accounted(file: _Aligned, told: Stated) -> Stated:
    """With the share of a motor's force alone that the command leaves over, as a drive suits it best."""
    if file.commanded is not None or (between := file.drive_after(told.asked)) is None:
        return told
    return replace(told, accounted=min(between.by_delay, between.by_damper, between.by_rate))


class Motion(NamedTuple):
    """The motion as phasors of the frequency and its harmonics, and what a held force does along it."""

    xs: NDArray[np.complex128]
    omega: float
    loop_period: float
    frequency: float
    period: float

    @property
    def orders(self) -> Array:
        """n = 1, 2, …"""
        return np.arange(1.0, self.xs.size + 1)

    def late(self, delay: float) -> NDArray[np.complex128]:
        """exp(−jnωτ)."""
        return np.asarray(np.exp(-1j * self.orders * self.omega * delay))

    def phasors(self, force: Array) -> NDArray[np.complex128]:
        """Of a sampled force that is held."""
        return self.held(phasors(force, self.frequency, self.period))

    def needed(self, known: Known) -> NDArray[np.complex128]:
        """The force under which a rigid device alone would move so, −m ẍ − b ẋ − f_c sgn ẋ; of any mass,
        where nobody said which."""
        n = self.orders * self.omega
        ahead = 1j * self.xs[0] / abs(self.xs[0])
        square = np.zeros_like(self.xs)
        square[0], square[2] = 4 / np.pi * ahead, -4 / (3 * np.pi) * ahead**3
        mass = known.mass or 1.0
        rubs = (known.damping or 0.0, known.coulomb or 0.0) if known.mass else (0.0, 0.0)
        return np.asarray((mass * n**2 - 1j * n * rubs[0]) * self.xs - rubs[1] * square)

    def work(self, force: NDArray[np.complex128]) -> float:
        """[J] in a cycle, −π Σ n Im(F_n X_n*)."""
        return float(-np.pi * (self.orders * np.imag(force * np.conj(self.xs))).sum())

    def viscous(self, damping: float) -> float:
        """[J] that a damper takes in a cycle, π ω b Σ |n X_n|²."""
        return float(np.pi * self.omega * damping * (np.abs(self.orders * self.xs) ** 2).sum())

    def held(self, asked: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """The same through the hold."""
        half = 0.5 * self.orders * self.omega * self.loop_period
        return np.asarray(asked * np.sinc(half / np.pi) * np.exp(-1j * half))


def _bend(force: NDArray[np.complex128]) -> complex:
    """Third harmonic against the first, F₃ (F₁*)³/|F₁|⁴: 1/9 of a triangle, −1/3 of a square."""
    size = abs(force[0])
    return complex(force[2] / size * (np.conj(force[0]) / size) ** 3) if size else 0j


def _along(x: Array, force: Array, late: int) -> float:
    """[J] −Σ f_k (x_k+1 − x_k) in a cycle, from the first to the last rise through the middle."""
    middle = 0.5 * (np.percentile(x, 5) + np.percentile(x, 95))
    reach = 0.25 * (np.percentile(x, 95) - np.percentile(x, 5))
    crossings, below = [], False
    for k, value in enumerate(x):
        if below and value > middle:
            crossings.append(k)
        below = value < middle - reach or (below and value <= middle)
    if len(crossings) < 2:
        return 0.0
    first, last = crossings[0], crossings[-1]
    moves = np.diff(x)[first:last]
    held = force[max(0, first - late) : max(0, first - late) + moves.size]
    return -float(held @ moves) / (len(crossings) - 1)


def _loop_period(commanded: Array | None, period: float) -> float:
    """T: rows, or as many rows as a command usually stays the same for."""
    if commanded is None:
        return period
    changes = np.flatnonzero(np.diff(commanded))
    if changes.size < 20:
        return period
    usual = int(np.median(np.diff(changes)))
    return period * max(1, usual) if usual >= 2 and (np.diff(changes) % usual == 0).mean() > 0.9 else period


def _sign(x: Array, force: Array) -> float:
    """+1 where the force pushes back, as a spring does that comes less than a quarter of a cycle late."""
    slope = float(np.cov(x - x.mean(), force)[0, 1])
    return 1.0 if slope >= 0 else -1.0


def _lags(file: _Aligned) -> list[float]:
    """Lags to try: some samples of bookkeeping for a command, most of half a cycle for what was applied."""
    if file.commanded is not None:
        return [k * file.loop_period for k in range(3)]
    most = max(2, int(0.45 * file.cycle / file.loop_period))
    return [float(k) * file.loop_period for k in np.unique(np.linspace(0, most, min(most + 1, 25)).round())]


def _delay(known: Known, fitted: _Fitted, commanded: bool) -> float:
    if fitted.drive is not None:
        return fitted.drive.delay_to_a_sample
    if not commanded and fitted.law is not None:
        return fitted.law.lag
    return known.delay


def _terms(fitted: _Fitted, motion: Motion, delay: float, seen: Array) -> dict[str, float]:
    """[J] in a cycle by each term."""
    found, between = fitted.law, fitted.drive
    supplied = dict.fromkeys(TERMS, 0.0)
    if found is None:
        return supplied
    helping = motion.phasors(found.compensated)
    spring = motion.held(found.stiffness * motion.xs)
    damper = motion.held(found.damper(motion.orders * motion.omega, motion.loop_period) * motion.xs)
    asked = abs(motion.phasors(seen)[0] - helping[0])
    share = min(1.0, asked / (abs(spring[0] + damper[0]) or np.inf))  # less where it is cut off or away
    supplied["sampling"] = share * motion.work(spring)
    supplied["differenced velocity"] = share * motion.work(damper)
    supplied["friction compensation"] = motion.work(helping)
    supplied["delay"] = share * motion.work((spring + damper) * (motion.late(delay) - 1))
    if between is not None:
        accounts = {
            "delay": between.by_delay,
            "drive damping": between.by_damper,
            "actuator limit": between.by_rate,
        }
        least = min(accounts, key=lambda name: accounts[name])
        if accounts["delay"] <= _ALIKE:
            least = "delay"  # the simplest of those that account for it
        added = motion.work(motion.phasors(between.applied - seen))
        supplied |= dict.fromkeys(accounts, 0.0)
        if between.by_nothing > _ALIKE:
            supplied[least] = added
    return supplied


def _count(x: Array) -> float:
    """[m; rad] between the few places at which all of a motion is; 0 where those are many."""
    places = np.unique(x)
    return float(np.diff(places).min()) if 1 < places.size < min(8, x.size / 8) else 0.0


def _pulse(found: Law | None, known: Known, vibration: Vibration, resolution: float, period: float) -> float:
    """[J] (B Δ)²/2m, where the largest speed, π f times the swing, is of at most three counts in a window."""
    speed = np.pi * vibration.frequency * vibration.swing
    if found is None or not known.mass or speed * found.window * period > 3 * resolution:
        return 0.0
    return (found.damping * resolution) ** 2 / (2 * known.mass)


def _standing(x: Array, period: float, cycle: float) -> float:
    """Share of time below a tenth of the largest speed, speeds being means over a sixteenth of a cycle."""
    step = max(1, round(cycle / 16 / period))
    speed = np.abs(x[step:] - x[:-step])
    top = float(np.percentile(speed, 98)) if speed.size else 0.0
    return float((speed < 0.1 * top).mean()) if top else 1.0
