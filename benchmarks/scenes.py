"""Scenes measured: balance of energy, hands that try to gain, a chain against its modes, cost of a step.

python benchmarks/scenes.py                        all of it, some minutes
python benchmarks/scenes.py --trials 100           quickly
python benchmarks/scenes.py --rival PYTHON         also MuJoCo, in an environment of its own that has it
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
from scipy.linalg import eigh, expm

import zwidth as zw
from zwidth.model.scene import Damper, Mass, SceneRun, Spring

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from random_scenes import random_scene

T = 0.001


def main() -> None:
    """Print a line for each."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trials", type=int, default=10_000)
    parser.add_argument("--rival", help="a Python that has mujoco")
    given = parser.parse_args()
    balance(min(given.trials, 300))
    hands(given.trials)
    chain()
    cost(given.rival)


def balance(scenes: int) -> None:
    """Work of the port less what is stored and lost, over the work that went through."""
    gaps, sizes = [], np.geomspace(3, 300, scenes).astype(int)
    for seed, size in enumerate(sizes):
        run = SceneRun(random_scene(seed, int(size)), T)
        rng = np.random.default_rng(seed)
        x = np.cumsum(rng.normal(size=100) * 10.0 ** rng.uniform(-5, -3))
        f = run.follow(x)
        account = run.account()
        through = float(np.abs(f * np.diff(x, prepend=0.0)).sum() + np.abs(account.work).sum())
        gap = account.attrs["port_work_J"] - float((account.stored + account.lost).sum())
        gaps.append(abs(gap) / through)
    print(
        f"balance: {scenes} scenes of 3 to 300 elements, {np.median(gaps):.1e} of the work, "
        f"{np.quantile(gaps, 0.99):.1e} in 99 of 100, at worst {max(gaps):.1e}"
    )


def hands(trials: int) -> None:
    """Random scenes behind couplings with b = K T/2 + B, no more: the least energy that a hand has put in."""
    least, refuted, begun = 0.0, 0, time.perf_counter()
    for seed in range(trials):
        rng = np.random.default_rng(seed)
        k, damping = 10 ** rng.uniform(1, 3.5), 10 ** rng.uniform(-3, 0.5)
        b = k * T / 2 + damping
        world = random_scene(seed, 3 + seed % 28).elements
        coupling = (Spring("hand", "port", k, name="K"), Damper("hand", "port", b, name="B"))
        run = SceneRun(zw.Scene([*coupling, *world], port="hand"), T)
        jerks = rng.normal(size=120) * 10.0 ** rng.uniform(-5, -2)
        work, force, most = 0.0, 0.0, 0.0
        for i, jerk in enumerate(jerks):
            move = float(jerk) if i % 20 < 5 else -T * force / (2 * b)
            work += force * move + b / T * move * move
            out = work + run.energy_at_first
            most = max(most, abs(work) + run.energy_at_first)
            least = min(least, out / most if most else 0.0)
            refuted += out < -1e-9 * most
            force = run.step(move)
    took = time.perf_counter() - begun
    print(f"hands: {trials} trials in {took:.0f} s, {refuted} gained; least work {least:.1e} of the most")


def chain() -> None:
    """A hundred masses on springs, let go: each mode against the one of scipy's eigenproblem."""
    n = 100
    squares, shapes = eigh(400 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)), 0.01 * np.eye(n))
    for steps in (1000, 2000, 4000):
        t = 1.0 / steps
        run = SceneRun(zw.Scene(links(n), port="m0"), t)
        ramp = np.linspace(0, 1e-3, steps // 100 + 1)[1:]
        run.follow([*ramp, *np.full(steps - len(ramp), 1e-3)])
        y = np.array([run.positions[f"m{i}"] for i in range(1, n + 1)])
        print(f"chain of {n}: {steps} steps a second, apart by {apart(y, squares, shapes):.2e} of the push")


def apart(y: np.ndarray, squares: np.ndarray, shapes: np.ndarray) -> float:
    """From the exact answer after a second: pushed in by 1 mm within 10 ms and held."""
    n, push, rise = len(y), 1e-3, 0.01
    drive = shapes.T @ (400 * np.eye(n)[0])  # force of the moved end on each mode, per metre
    omega = np.sqrt(squares)

    def ramp(t: float) -> np.ndarray:
        return drive / squares * (t - np.sin(omega * t) / omega)

    exact = shapes @ (push / rise * (ramp(1.0) - ramp(1.0 - rise)))
    return float(np.abs(y - exact).max() / push)


def links(n: int) -> list[Spring | Mass]:
    """Springs of 400 N/m and masses of 10 g from m0 to the ground."""
    springs = [Spring(f"m{i}", f"m{i + 1}" if i < n else "ground", 400) for i in range(n + 1)]
    return [*springs, *(Mass(f"m{i}", "0.01") for i in range(1, n + 1))]


def cost(rival: str | None) -> None:
    """Time of a step, beside the matrices of a state space in numpy and, where there is one, MuJoCo."""
    for n in (10, 100, 1000):
        run = SceneRun(zw.Scene(links(n), port="m0"), T)
        x = 1e-3 * np.sin(np.arange(20_000) * 0.01)
        run.follow(x[:10])
        own = best(partial(run.follow, x)) / len(x)
        a = np.block([[np.zeros((n, n)), np.eye(n)], [-4e4 * stiffness(n), np.zeros((n, n))]])
        step = expm(a * T) if n <= 100 else np.eye(2 * n) + a * T
        state, force = np.zeros(2 * n), np.zeros(2 * n)

        def matrices(state: np.ndarray = state, step: np.ndarray = step, force: np.ndarray = force) -> None:
            for _ in range(200):
                state = step @ state + force

        theirs = best(matrices) / 200
        print(
            f"cost, {n} masses: {own * 1e6:.2f} µs a step, {own * 1e9 / (2 * n + 1):.1f} ns an element; "
            f"state-space matrices in numpy {theirs * 1e6:.2f} µs"
        )
        if rival:
            done = subprocess.run(
                [rival, "-c", _MUJOCO, str(n)], capture_output=True, text=True, check=True
            ).stdout.strip()
            print(f"  MuJoCo: {done}")


def stiffness(n: int) -> np.ndarray:
    """Of springs of 1 N/m between neighbours."""
    return 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)


def best(function: object, rounds: int = 5) -> float:
    """The quickest of some rounds [s]."""
    times = []
    for _ in range(rounds):
        begun = time.perf_counter()
        function()  # type: ignore[operator]
        times.append(time.perf_counter() - begun)
    return min(times)


_MUJOCO = """
import sys, time
import mujoco
n = int(sys.argv[1])
bodies = "".join(
    f'<body name="b{i}"><joint name="j{i}" type="slide" axis="1 0 0"/><geom type="sphere" size="0.01" '
    'mass="0.01" contype="0" conaffinity="0"/></body>' for i in range(n))
tendons = "".join(
    f'<fixed stiffness="400" springlength="0"><joint joint="j{i}" coef="1"/><joint joint="j{i+1}" coef="-1"/>'
    '</fixed>' for i in range(n - 1))
xml = (f'<mujoco><option timestep="0.001" gravity="0 0 0" integrator="implicitfast"/>'
       f'<worldbody>{bodies}</worldbody><tendon>{tendons}</tendon></mujoco>')
model = mujoco.MjModel.from_xml_string(xml)
data = mujoco.MjData(model)
steps = max(20, 20000 // n)
mujoco.mj_step(model, data, 10)
times = []
for _ in range(3):
    begun = time.perf_counter()
    mujoco.mj_step(model, data, steps)
    times.append((time.perf_counter() - begun) / steps)
print(f"{min(times) * 1e6:.1f} µs a step, version {mujoco.__version__}")
"""


if __name__ == "__main__":
    main()
