"""The record of a simulation as labelled data along `time`, and as an xarray.Dataset where one is asked for.

Values stand at instants.  At a jump (a force applied, an impulse of a kinematic hand) position, velocity and
energies are those before it, forces those just after it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from zwidth import __version__
from zwidth.loop import kernel, two_bodies, two_masses
from zwidth.loop.plant import POSITION
from zwidth.loop.setup import Frame, Setup
from zwidth.loop.start import OF_TWO, Start, held_at_start
from zwidth.model.device.transmission import Transmission
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FORMAT = "zwidth trace 1"

LARGEST = 1e120
"""Where a motion that grows without bound is cut, in SI units: squares of it are still finite."""

UNITS = {
    motion: tuple(GLOSSARY[name].unit_for(motion) for name in ("position", "velocity", "force"))
    for motion in ("linear", "rotary")
}
"""Of position, velocity and force."""


SAMPLED = "a sample is taken at this instant"


class Variable(NamedTuple):
    """A variable of a trace: its symbol, what it means, and 0 position, 1 velocity, 2 force or 3 energy."""

    symbol: str
    long_name: str
    kind: int


VARIABLES = {
    "position": Variable("x", "position, positive inside the wall", 0),
    "velocity": Variable("v", "velocity", 1),
    "measured_position": Variable("x_m", "position as the encoder read it last", 0),
    "commanded_force": Variable("f", "force that the newest sample asks for, positive out of the wall", 2),
    "actuator_force": Variable("f_a", "force of the actuator, positive out of the wall", 2),
    "hand_force": Variable("f_h", "force of the hand on the device, positive into the wall", 2),
    "anchor_position": Variable("x_a", "position that the muscles want", 0),
    "hand_work": Variable("W_h", "energy from the hand into the device", 3),
    "actuator_work": Variable("W_a", "energy from the actuator into the device", 3),
    "viscous_loss": Variable("E_b", "energy lost in the device's viscous friction", 3),
    "coulomb_loss": Variable("E_c", "energy lost in the device's Coulomb friction", 3),
    "kinetic_energy": Variable("E_k", "kinetic energy of the device", 3),
    "hand_source_work": Variable("W_s", "energy from the muscles into the hand", 3),
    "hand_spring_energy": Variable("E_s", "energy in the hand's spring", 3),
    "hand_damper_loss": Variable("E_d", "energy lost in the hand's damper", 3),
    "hand_kinetic_energy": Variable("E_m", "kinetic energy of the hand's mass", 3),
    "motor_position": Variable("x_1", "position of the motor; position is that of the handle", 0),
    "motor_velocity": Variable("v_1", "velocity of the motor; velocity is that of the handle", 1),
    "transmission_force": Variable(
        "f_t", "force of the transmission on the handle, positive into the wall", 2
    ),
    "motor_viscous_loss": Variable("E_b1", "of the viscous loss, that on the motor's side", 3),
    "motor_coulomb_loss": Variable("E_c1", "of the Coulomb loss, that on the motor's side", 3),
    "motor_kinetic_energy": Variable("E_k1", "of the kinetic energy, that of the motor", 3),
    "transmission_energy": Variable("E_t", "energy in the spring of the transmission", 3),
    "transmission_loss": Variable("E_ct", "energy lost in the damper of the transmission", 3),
}
"""Every variable of a trace, in the order of its files; with a transmission energies are of both sides."""

SOMETIMES = {"anchor_position", *(name for name in VARIABLES if name.startswith(("motor_", "transmission_")))}
"""What not every trace has: the one if something draws to it, the others of a device with a transmission."""


class Labelled(NamedTuple):
    """Numbers along named dimensions, and what they are."""

    dims: tuple[str, ...]
    values: NDArray[Any]
    attrs: dict[str, str]


@dataclass(eq=False)
class Trace:
    """What a simulation found, read in the words of the xarray.Dataset that `dataset` makes of it.

    xarray takes longer to load than most touches to simulate, and a report of a touch needs none of it.
    """

    variables: dict[str, Labelled]
    coordinates: dict[str, Labelled]
    attrs: dict[str, Any]

    @property
    def dims(self) -> tuple[str, ...]:
        """What its numbers lie along."""
        return next(iter(self.variables.values())).dims

    def __contains__(self, name: str) -> bool:
        return name in self.variables

    def __getitem__(self, name: str) -> Labelled:
        return self.variables.get(name) or self.coordinates[name]

    def sel(self, *, arm: str) -> Trace:
        """One arm of a pair's."""
        row = self.coordinates["arm"].values.tolist().index(arm)
        own = {
            name: Labelled(part.dims[1:], part.values[row], part.attrs)
            for name, part in self.variables.items()
        }
        rest = {name: part for name, part in self.coordinates.items() if name != "arm"}
        return Trace(own, rest, dict(self.attrs))

    def dataset(self) -> xr.Dataset:
        """It as an xarray.Dataset."""
        import xarray as xr

        return xr.Dataset(self.variables, coords=self.coordinates, attrs=self.attrs)


AnyTrace: TypeAlias = "xr.Dataset | Trace"
"""What is read of a trace, both have."""


def build_trace(setup: Setup, record: Array, done: int, *, stops: int) -> Trace:
    """The trace of the first `done` samples of a record, up to where the numbers outgrow any meaning."""
    whole = setup.frame.columns
    finished = min(whole, done * setup.frame.points if done <= setup.frame.samples else whole)
    columns = before_overflow(record, finished)
    values = (
        values_of(setup.frame, record, columns)
        if setup.two is None
        else _values_of_two(setup, record, columns)
    )
    device = setup.device
    units = (*UNITS[device.motion], "J")
    variables = {
        name: Labelled(("time",), values[name], attributes_of(variable, units))
        for name, variable in VARIABLES.items()
        if name in values
    }
    time = instants(setup.frame)[:columns]
    sampled = np.arange(columns) % setup.frame.points == 0
    coordinates = along_time(time, sampled, SAMPLED)
    attributes = {**_attrs(setup, stops), **_stored(setup, values)}
    if columns < finished:
        attributes["diverged_at_s"] = float(time[-1])
    elif finished < whole:
        attributes["interrupted_at_s"] = float(time[-1])
    return Trace(variables, coordinates, attributes)


def along_time(time: Array, sampled: NDArray[np.bool_], meaning: str) -> dict[str, Labelled]:
    """The instants of a trace, and at which of them what happens."""
    about = {"units": "s", "long_name": "time since sample 0", "symbol": "t"}
    return {
        "time": Labelled(("time",), time, about),
        "sampled": Labelled(("time",), sampled, {"long_name": meaning}),
    }


def before_overflow(record: Array, columns: int) -> int:
    """How many of the columns, one at least, come before the first number that is not below `LARGEST`."""
    if (np.abs(record[:, columns - 1]) < LARGEST).all():
        return columns  # what has grown so large does not come back: the energies sum up all that was
    beyond = ~(np.abs(record[:, :columns]).max(axis=0) < LARGEST)  # NaN is not below either
    return max(1, int(np.argmax(beyond)))


def attributes_of(variable: Variable, units: tuple[str, ...]) -> dict[str, str]:
    """Unit, meaning and symbol."""
    return {"units": units[variable.kind], "long_name": variable.long_name, "symbol": variable.symbol}


def instants(frame: Frame) -> Array:
    if frame.points == 1:
        return frame.times
    share = np.arange(frame.points) / frame.points
    inside = frame.times[:-1, None] + np.diff(frame.times)[:, None] * share
    return np.append(inside.ravel(), frame.times[-1])


def values_of(frame: Frame, record: Array, columns: int) -> dict[str, Array]:
    """The variables of a trace, from the record of an arm."""
    k, p = kernel, frame.plant
    rows = {
        "position": k.R_POSITION,
        "velocity": k.R_VELOCITY,
        "measured_position": k.R_READING,
        "commanded_force": k.R_COMMAND,
        "actuator_force": k.R_ACTUATOR,
        "hand_work": k.R_HAND_WORK,
        "actuator_work": k.R_ACTUATOR_WORK,
        "viscous_loss": k.R_VISCOUS,
        "coulomb_loss": k.R_COULOMB,
        "hand_source_work": k.R_SOURCE_WORK,
        "hand_damper_loss": k.R_HAND_LOSS,
    }
    values = {name: record[row, :columns] for name, row in rows.items()}
    x, v = values["position"], values["velocity"]
    values["kinetic_energy"] = 0.5 * p.mass * v * v
    values["hand_kinetic_energy"] = 0.5 * p.hand_mass * v * v
    anchor, speed = _anchor(frame, columns)
    if anchor is None:
        values["hand_spring_energy"] = np.zeros(columns)
    else:
        values["anchor_position"] = anchor
        values["hand_spring_energy"] = 0.5 * p.stiffness * (anchor - x) ** 2
    if frame.signals.position is not None:
        values["hand_force"] = _needed_force(frame, values)
    else:
        values["hand_force"] = _hand_force(frame, values, anchor, speed)
    return values


def _values_of_two(setup: Setup, record: Array, columns: int) -> dict[str, Array]:
    """The variables of motor and handle: those of a mass that the transmission pushes, and the motor's."""
    assert setup.two is not None
    two, own = two_bodies.packed_two(setup.two), record[:, :columns].copy()
    x1, v1 = own[two_masses.R_MOTOR], own[two_masses.R_MOTOR_VELOCITY]
    twist, apart = x1 - own[kernel.R_POSITION], v1 - own[kernel.R_VELOCITY]
    inside = two.spring * twist + two.damper * apart
    own[kernel.R_ACTUATOR] = -inside
    values = values_of(setup.frame._replace(plant=two.handle), own, columns)
    values["actuator_force"] = record[kernel.R_ACTUATOR, :columns]
    motor = 0.5 * two.motor.mass * v1 * v1
    values["kinetic_energy"] = values["kinetic_energy"] + motor
    return {
        **values,
        "motor_position": x1,
        "motor_velocity": v1,
        "transmission_force": inside,
        "motor_viscous_loss": own[two_masses.R_MOTOR_VISCOUS],
        "motor_coulomb_loss": own[two_masses.R_MOTOR_COULOMB],
        "motor_kinetic_energy": motor,
        "transmission_energy": 0.5 * two.spring * twist * twist,
        "transmission_loss": own[two_masses.R_INSIDE_LOSS],
    }


def _held(values: Array, points: int, columns: int) -> Array:
    """One value per interval at every instant; the last interval's at the end."""
    repeated = np.repeat(values, points)
    return np.append(repeated, repeated[-1])[:columns]


def _anchor(frame: Frame, columns: int) -> tuple[Array | None, Array | float]:
    anchor = frame.signals.anchor
    if anchor is None:
        return None, 0.0
    speed = np.diff(anchor) / np.diff(frame.times)
    if frame.points == 1:
        return anchor[:columns], _held(speed, 1, columns)
    share = np.arange(frame.points) / frame.points
    inside = anchor[:-1, None] + np.diff(anchor)[:, None] * share
    return np.append(inside.ravel(), anchor[-1])[:columns], _held(speed, frame.points, columns)


def _hand_force(frame: Frame, values: dict[str, Array], anchor: Array | None, speed: Array | float) -> Array:
    """F + k (x_a − x) + c (ẋ_a − v) − m_h v̇, with v̇ just after the instant."""
    p, v = frame.plant, values["velocity"]
    columns = v.size
    applied: Array = np.zeros(columns) if anchor is None else p.stiffness * (anchor - values["position"])
    applied = applied + p.hand_damping * (speed - v)
    if frame.signals.force is not None:
        applied = applied + _held(frame.signals.force, frame.points, columns)
    if p.hand_mass == 0.0:
        return applied
    external = applied - values["actuator_force"]
    resting = (v == 0.0) & (np.abs(external) <= p.stiction)
    side = np.where(v != 0.0, np.sign(v), np.sign(external))
    acceleration = (external - p.damping * v - p.coulomb * side) / (p.mass + p.hand_mass)
    return applied - p.hand_mass * np.where(resting, 0.0, acceleration)


def _needed_force(frame: Frame, values: dict[str, Array]) -> Array:
    """What a prescribed motion takes just after the instant, impulses left out: f_a + f_c sgn v + b v."""
    p, columns = frame.plant, values["position"].size
    target, bend = frame.signals.position, frame.signals.switch_position
    assert target is not None
    h = np.diff(frame.times)
    if bend is None:
        speeds = np.diff(target) * frame.pieces / np.repeat(h, frame.pieces)
        at = np.arange(columns) * frame.pieces // frame.points
        speed = speeds[np.minimum(at, speeds.size - 1)]
    else:
        before = _held((bend - target[:-1]) / frame.offset, frame.points, columns)
        after = _held((target[1:] - bend) / (h - frame.offset), frame.points, columns)
        into = np.arange(columns) % frame.points / frame.points * float(frame.lengths[0])
        speed = np.where(into < frame.offset, before, after)
    return values["actuator_force"] + p.coulomb * np.sign(speed) + p.damping * speed


def _stored(setup: Setup, values: dict[str, Array]) -> dict[str, Any]:
    """The most that was stored at the start, or why that is not known."""
    frame, x, v = setup.frame, values["position"], values["velocity"]
    at = Start(
        law=setup.environment,
        plant=frame.plant,
        actuation=frame.actuation,
        period=frame.period,
        delay=setup.device.exact("delay"),
        resolution=frame.resolution,
        phase=setup.encoder_phase,
        position=float(setup.state[POSITION]),
        regular=setup.timing is None,
    )
    deepest = float(values["measured_position"].max())
    held = held_at_start(at, deepest)
    if setup.two is not None:
        smooth = replace(at, plant=frame.plant._replace(damping=0.0, coulomb=0.0))
        if held.force or held != held_at_start(smooth, deepest):
            return {"stored_at_start_unknown": OF_TWO}
    whole = frame.arrivals.shape[1] == 0 and frame.offset == 0.0
    first = frame.late if frame.arrivals.shape[1] == 0 else int(frame.arrivals[0, 0])
    early = first * frame.points + 1
    helped = 0.0
    if not whole and held.force:  # the first force comes between two samples: the hand may turn there
        early += frame.points
        helped = abs(held.force) * _beyond_samples(setup, v[:early])
    bound = held.bound(x - at.position, early)
    if bound is None:
        return {"stored_at_start_unknown": held.unknown}
    return {"stored_at_start_J": bound + helped}


def _beyond_samples(setup: Setup, velocity: Array) -> float:
    """How far the hand may get within a sample beyond where it is at both ends."""
    frame = setup.frame
    if frame.signals.position is None:
        return float(np.abs(velocity).max() * frame.lengths.max())
    bend = frame.signals.switch_position
    if frame.pieces > 1:
        inside = frame.signals.position[:-1].reshape(-1, frame.pieces)
        return float(np.max(np.ptp(inside, axis=1), initial=0.0))
    if bend is None:
        return 0.0
    ends = np.maximum(frame.signals.position[:-1], frame.signals.position[1:])
    low = np.minimum(frame.signals.position[:-1], frame.signals.position[1:])
    return float(np.max(np.maximum(bend - ends, low - bend), initial=0.0))


def _attrs(setup: Setup, stops: int) -> dict[str, Any]:
    device, plant = setup.device, setup.frame.plant
    result: dict[str, Any] = {
        "format": FORMAT,
        "zwidth_version": __version__,
        "device": device.name,
        "environment": setup.environment.describe(device.motion),
        "operator": setup.operator.describe(device.motion),
        "amplifier": setup.frame.amplifier.describe(),
        "timing": "regular" if setup.timing is None else setup.timing.describe(),
        "motion": device.motion,
        "sample_period_s": float(device.exact("sample_period")),
        "delay_s": float(device.exact("delay")),
        device.key("resolution"): float(device.exact("resolution")),
        "encoder_phase_counts": setup.encoder_phase,
        device.key("mass"): plant.mass,
        device.key("damping"): plant.damping,
        device.key("coulomb_friction"): plant.coulomb,
        device.key("stiction"): plant.stiction,
        f"hand_{device.key('mass')}": plant.hand_mass,
        f"hand_{device.key('stiffness')}": plant.stiffness,
        f"hand_{device.key('damping')}": plant.hand_damping,
        "stops": stops,
    }
    if device.transmission is not None:
        kinds = parameters_of(Transmission)
        for key, value in device.transmission.parameters().items():
            result[f"transmission_{kinds[key].quantity.key_for(device.motion)}"] = float(value)  # type: ignore[arg-type]
        result["encoder"] = device.transmission.encoder
    if device.force_limit is not None:
        result[device.key("force_limit")] = float(device.exact("force_limit"))
    return result
