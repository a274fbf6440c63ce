"""Parts of a scene that lines join: the whole again but for their mass, and no energy whatever is lost.

Between a fast device and a slow scene a line is felt with the stiffness w/τ and the mass w τ, τ = (N + 1) T/2
where the scene steps once in N samples and packets are used at once.
"""

import random

import numpy as np
import pytest

import zwidth as zw
from zwidth.links import WavePort
from zwidth.machine.network import PartRun, run_parts
from zwidth.model.scene import Contact, Damper, LineEnd, Mass, Scene, Spring
from zwidth.model.scene.parts import Part, best_parts, cut_scene
from zwidth.model.scene.run import SceneRun

T = 1e-3


def chain(n, soft, wall=False):
    elements = [Spring("handle", "m0", 300), Damper("handle", "m0", 0.2)]
    for i in range(n):
        to = f"m{i + 1}" if i < n - 1 else "ground"
        elements += [Mass(f"m{i}", 0.1), Spring(f"m{i}", to, 100 if i in soft else 500)]
        elements += [Damper(f"m{i}", "ground", 0.3)]
    if wall:
        elements.append(Contact(f"m{n - 1}", "ground", 2000, gap=0.002))
    return Scene(elements)


def running(made, period=T):
    return {part.name: PartRun(part, period) for part in made.parts}


def swing(period, duration=1.0):
    t = np.arange(1, round(duration / period) + 1) * period
    return 0.01 * np.sin(2 * np.pi * 2 * t) * (1 - np.exp(-t / 0.05))


def test_the_parts_are_the_whole_but_for_the_mass_of_the_lines():
    """It is K τ²: a delay half as long leaves a quarter of the difference."""
    scene = chain(5, {1, 3})
    apart = []
    for period in (T, T / 2, T / 4):
        x = swing(period)
        runs = running(cut_scene(scene, best_parts(scene, 3), period), period)
        felt = run_parts(runs, np.diff(x, prepend=0.0))
        apart.append(np.abs(felt - SceneRun(scene, period).follow(x)).max())
    assert apart[0] < 0.02
    assert [a / b for a, b in zip(apart, apart[1:], strict=False)] == pytest.approx([4, 4], rel=0.25)


def test_the_order_in_which_parts_are_stepped_changes_no_bit():
    scene = chain(6, {1, 3}, wall=True)
    made = cut_scene(scene, best_parts(scene, 3), T)
    moves = np.diff(swing(T, 0.5), prepend=0.0)
    one = run_parts(running(made), moves)
    other = run_parts(dict(reversed(running(made).items())), moves)
    assert one == other


@pytest.mark.parametrize("late", [1, 3, 17])
def test_every_joule_is_in_a_part_or_on_its_way(late):
    scene = chain(4, {1}, wall=True)
    runs = running(cut_scene(scene, best_parts(scene, 2), "1 ms"))
    moves = np.diff(swing(T), prepend=0.0)
    felt = np.array(run_parts(runs, moves, dict.fromkeys(["spring m1–m2"], late)))
    accounts = [run.account() for run in runs.values()]
    taken = sum(float(account["stored"].sum() + account["lost"].sum()) for account in accounts)
    assert float(felt @ moves) == pytest.approx(taken, rel=1e-9)
    line = sum(float(account["lost"].sel(element="spring m1–m2")) for account in accounts)
    assert line > -1e-12


def test_parts_of_different_rates_and_a_bad_link_make_no_energy():
    """One part is five times slower; packets are lost, doubled and out of order."""
    scene = chain(4, {1})
    draw = random.Random(7)
    for _ in range(20):
        made = cut_scene(scene, best_parts(scene, 2), "5 ms")
        fast, slow = (PartRun(p, T if p.scene.port else 5 * T) for p in made.parts)
        coming = {"fast": [], "slow": []}
        put_in, x = 0.0, 0.0
        name = made.lines[0].name
        for k in range(600):
            for run, own, other, due in ((fast, "fast", "slow", True), (slow, "slow", "fast", k % 5 == 4)):
                if not due:
                    continue
                heard = [p for when, p in coming[own] if when <= k]
                coming[own] = [(when, p) for when, p in coming[own] if when > k]
                move = 0.0
                if own == "fast":
                    move = draw.gauss(0, 1e-3)
                    x += move
                packets = run.step({name: heard}, move)
                put_in += run.felt * move
                for _ in range(draw.choice([0, 0, 1, 1, 2])):
                    coming[other].append((k + draw.randrange(1, 40), packets[name]))
            assert put_in > -1e-12


W = 0.15
DEVICE = zw.Device(mass=0.036, damping=W, coulomb_friction=0, resolution=0, sample_period=T)


def forces(positions, often, *elements):
    """The port's force over each sample of a device that is led along the positions."""
    port = WavePort(DEVICE)
    part = PartRun(Part("room", Scene([LineEnd("tool", W, "line"), *elements], "")), often * T)
    port.meet(part.ports["line"].run)
    part.ports["line"].meet(port.run)
    told, asked, found = [], [], []
    for k, move in enumerate(np.diff(positions)):
        found.append(port.receive(told))
        told = []
        if k % often == 0:
            told = [part.step({"line": asked})["line"]]
            asked = []
        asked.append(port.send(move))
    return np.array(found)


@pytest.mark.parametrize("often", [1, 2, 5, 10])
@pytest.mark.parametrize("stiffness", [50, 200, 100_000])
def test_a_spring_is_felt_in_series_with_the_line(often, stiffness):
    x = 0.005 * (1 - np.cos(np.pi * np.minimum(np.arange(3501) / 2000, 1)))
    found = forces(
        x, often, Mass("tool", 0.02), Damper("tool", "ground", 0.5), Spring("tool", "ground", stiffness)
    )
    felt = -found[-500:].mean() / x[-1]
    line = W / ((often + 1) / 2 * T)
    assert felt == pytest.approx(1 / (1 / stiffness + 1 / line), rel=1e-6)


@pytest.mark.parametrize("often", [1, 2, 5])
def test_a_body_is_felt_with_the_mass_of_the_line_and_without_the_device_s_damping(often):
    mass, omega = 0.02, 2 * np.pi
    t = np.arange(20_001) * T
    found = forces(0.01 * np.sin(omega * t) * np.minimum(t / 4, 1) ** 2, often, Mass("tool", mass))
    middle = t[-10_001:-1] + T / 2
    waves = np.c_[np.sin(omega * middle), np.cos(omega * middle)]
    inertia, drive = np.linalg.lstsq(waves, found[-10_000:], rcond=None)[0]
    delay = (often + 1) / 2 * T
    stretched = mass**2 * omega**2 / (W / delay)  # what the line's stiffness adds at this frequency
    assert inertia / (0.01 * omega**2) == pytest.approx(mass + W * delay + stretched, rel=1e-3)
    assert drive / (0.01 * omega) == pytest.approx(W, rel=2e-3)  # it drives what the damping takes
