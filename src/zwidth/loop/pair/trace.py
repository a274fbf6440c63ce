"""The record of a simulated pair as labelled data along `arm` and `time`.

Each arm's part, ``trace.sel(arm="leader")``, has the variables of the trace of one arm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.loop.pair.setup import Holder, PairSetup
from zwidth.loop.plant import POSITION, STOPS
from zwidth.loop.trace import (
    UNITS,
    VARIABLES,
    Labelled,
    Trace,
    Variable,
    along_time,
    attributes_of,
    before_overflow,
    instants,
    own_version,
    values_of,
)
from zwidth.model.environment.environment import with_unit
from zwidth.model.operator.operator import Operator, Signals

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FORMAT = "zwidth pair trace 1"

ARMS = ("leader", "follower")

_WORDS = {
    "position": "position",
    "commanded_force": "force that the newest readings ask for, against the arm's position",
    "actuator_force": "force of the actuator, against the arm's position",
    "hand_force": "force of the hand, or of the wall, on the arm",
    "hand_spring_energy": "energy in the hand's or the wall's spring",
    "hand_damper_loss": "energy lost in the hand's or the wall's damper",
}
"""Of variables that have no wall of the loop to go by."""


def build_pair_trace(setup: PairSetup, done: int) -> Trace:
    """The trace of the first `done` ticks of the records, up to where the numbers outgrow any meaning."""
    finished = min(setup.columns, done * setup.points if done <= setup.ticks else setup.columns)
    columns = min(before_overflow(arm.record, finished) for arm in setup.arms)
    values = [_values(setup, here, columns) for here in (0, 1)]
    time = instants(setup.frames[0])[:columns]
    sampled = np.arange(columns) % (setup.points * setup.often) == 0
    attributes = _attrs(setup)
    if columns < finished:
        attributes["diverged_at_s"] = float(time[-1])
    elif finished < setup.columns:
        attributes["interrupted_at_s"] = float(time[-1])
    return labelled(values, time, sampled, attributes)


def labelled(
    values: list[dict[str, Array]], time: Array, sampled: NDArray[np.bool_], attributes: dict[str, Any]
) -> Trace:
    """The trace of the variables of leader and follower; nan where only the other has one."""
    units = (*UNITS[attributes["motion"]], "J")
    variables = {
        name: Labelled(
            ("arm", "time"),
            np.stack([part.get(name, np.full(time.size, np.nan)) for part in values]),
            attributes_of(Variable(about.symbol, _WORDS.get(name, about.long_name), about.kind), units),
        )
        for name, about in VARIABLES.items()
        if any(name in part for part in values)
    }
    coordinates = {
        "arm": Labelled(("arm",), np.array(ARMS), {}),
        **along_time(time, sampled, "both arms send at this instant"),
    }
    return Trace(variables, coordinates, attributes)


def _values(setup: PairSetup, here: int, columns: int) -> dict[str, Array]:
    arm, frame = setup.arms[here], setup.frames[here]
    if not arm.wall:
        return values_of(frame, arm.record, columns)
    resting = Signals(anchor=np.zeros(frame.samples + 1))
    values = values_of(frame._replace(plant=arm.inside, signals=resting), arm.record, columns)
    del values["anchor_position"]
    met = values["position"] > 0
    for name in ("hand_force", "hand_spring_energy"):
        values[name] = np.where(met, values[name], 0.0)
    return values


def _attrs(setup: PairSetup) -> dict[str, Any]:
    pair = setup.pair
    result: dict[str, Any] = {
        "format": FORMAT,
        "zwidth_version": own_version(),
        "coupling": pair.describe(),
        "motion": pair.motion,
        "sample_period_s": float(pair.sample_period),
        "own_readings": setup.often,
        "link_delay_there_s": float(pair.there),
        "link_delay_back_s": float(pair.back),
        "power_ratio": float(pair.power_ratio),
        "stored_at_start_J": stored_at_start(setup),
    }
    for name, here in zip(ARMS, (0, 1), strict=True):
        device, frame, arm = (pair.leader, pair.follower)[here], setup.frames[here], setup.arms[here]
        own = {
            "device": device.name,
            "holder": described(setup.holders[here], pair.motion),
            "amplifier": frame.amplifier.describe(),
            "delay_s": float(device.exact("delay")),
            device.key("resolution"): frame.resolution,
            "encoder_phase_counts": arm.law.phase,
            device.key("mass"): arm.plant.mass,
            device.key("damping"): arm.plant.damping,
            device.key("coulomb_friction"): arm.plant.coulomb,
            device.key("stiction"): arm.plant.stiction,
            "stops": int(arm.state[STOPS]),
        }
        result |= {f"{name}_{key}": value for key, value in own.items()}
    return result


def described(holder: Holder, motion: str) -> str:
    """What is on one side, on one line."""
    if isinstance(holder, Operator):
        return holder.describe(motion)
    if holder is None:
        return "nobody"
    parts = [with_unit("stiffness", holder.stiffness, motion)]
    if holder.damping:
        parts.append(with_unit("virtual_damping", holder.damping, motion))
    return f"a real wall, {', '.join(parts)}"


def stored_at_start(setup: PairSetup) -> float:
    """½ K_l (|x_l − x_f| + (Δ_l + Δ_f)/2)², the most that the spring between two arms at rest holds [J].

    A passive pair gives out no more: in readings of the middle of each count its ideal form starts from a
    spring stretched by no more than that, and friction covers what counts add later (docs/theory/pairs.md).
    """
    leader, follower = (float(arm.record[POSITION, 0]) for arm in setup.arms)
    steps = sum(arm.law.resolution for arm in setup.arms)
    return 0.5 * float(setup.pair.felt_stiffness) * (abs(leader - follower) + steps / 2) ** 2
