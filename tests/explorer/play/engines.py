"""The engine of the page in node, moved by pointers that a test makes up; and the simulator beside it."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from firmware.emulated.built import called
from firmware.emulated.required import tool
from numpy.typing import NDArray

import zwidth as zw
from zwidth.model.operator import LinearHand, Tracking
from zwidth.show.explorer.play import Played
from zwidth.show.explorer.play.loop import plant_text

Array = NDArray[np.float64]

OURS = files("zwidth.show.explorer.play")

QUANTITIES = ("position", "velocity", "actuator_force", "hand_work", "actuator_work")
"""Of the simulator, in the order of the recording's columns; what friction took is the sum of two."""


class Job(NamedTuple):
    """A loop and what the hand does: a position at each sample, and whether it holds the handle there."""

    loop: Played
    pointer: Array
    held: Array | None = None


def run_node(script: str, folder: Path) -> Any:
    """What a script prints as JSON; OURS in it is where the page's modules are."""
    place = Path(str(OURS)).as_uri()
    (folder / "run.mjs").write_text(script.replace("OURS", place), encoding="utf-8")
    return json.loads(called([tool("node"), "run.mjs"], folder))


def played(jobs: list[Job], folder: Path) -> list[Array]:
    (folder / "plant.mjs").write_text(plant_text(), encoding="utf-8")
    (folder / "two.mjs").write_text(plant_text(two=True), encoding="utf-8")
    given = []
    for i, job in enumerate(jobs):
        (folder / f"law{i}.mjs").write_text(job.loop.law or "export const none = 0;\n", encoding="utf-8")
        held = np.ones(len(job.pointer)) if job.held is None else job.held
        hand = {"pointer": job.pointer.tolist(), "held": held.tolist()}
        given.append({"facts": job.loop.facts(), "law": bool(job.loop.law), **hand})
    (folder / "jobs.json").write_text(json.dumps(given), encoding="utf-8")
    return [np.array(rows) for rows in run_node(_RUN, folder)]


_RUN = """\
import { readFileSync } from "node:fs";
import { Engine } from "OURS/engine.mjs";
import { Recording } from "OURS/recording.mjs";
import * as one from "./plant.mjs";
import * as two from "./two.mjs";
const plant = { ...one, two };
const done = [];
for (const [i, { facts, law, pointer, held }] of JSON.parse(readFileSync("jobs.json")).entries()) {
    const engine = new Engine(facts, plant, law ? await import(`./law${i}.mjs`) : null);
    const recording = new Recording(facts, Infinity);
    pointer.forEach((_, k) => {
        engine.grip(held[k] > 0);
        engine.step(pointer[Math.min(k + 1, pointer.length - 1)], (e) => recording.note(e));
    });
    done.push(recording.rows);
}
console.log(JSON.stringify(done));
"""


def moved(loop: Played, seconds: float, seed: int) -> Array:
    """A pointer that is somewhere else at each frame of a screen, straight between; first where it starts."""
    random = np.random.default_rng(seed)
    frames = np.arange(0.0, seconds + 0.1, 1 / 60)
    turns = np.arange(0.0, seconds + 1.0, 0.4)
    slow = np.interp(frames, turns, random.uniform(-0.7, 0.7, turns.size))
    places = loop.reach * (slow + 0.02 * random.normal(size=frames.size))
    places[0] = loop.start
    period = loop.arms[0]["period"]
    return np.interp(np.arange(round(seconds / period) + 1) * period, frames, places)


def tracking(pointer: Array, hand: LinearHand) -> Tracking:
    return Tracking(pointer, stiffness=hand.stiffness, damping=hand.damping, mass=hand.mass)


def simulated(loop: Played, pointer: Array) -> Array:
    """What the simulator makes of the same hand: the columns of the recording behind "held"."""
    samples = len(pointer) - 1
    if len(loop.loop) == 1:
        pair = loop.loop[0]
        ticks = pair.sample_period / pair.own_readings
        follower = tracking(np.array([loop.start]), loop.follower)
        trace = zw.simulate(pair, tracking(pointer, loop.hand), follower, samples * ticks)
        return np.concatenate([_columns(trace.sel(arm=arm)) for arm in ("leader", "follower")], 1)
    device, environment = loop.loop
    trace = zw.simulate(
        device, environment, tracking(pointer, loop.hand), samples * device.exact("sample_period")
    )
    return _columns(trace)


def _columns(trace: Any) -> Array:
    friction = trace["viscous_loss"].values + trace["coulomb_loss"].values
    if "transmission_loss" in trace:
        friction = friction + trace["transmission_loss"].values
    return np.stack([*(trace[name].values for name in QUANTITIES), friction], 1)
