"""The impedance of a linear scene: by node equations, by the modes of a chain, by the exact checker."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from random_scenes import LINEAR, random_scene
from scipy.linalg import eigh
from strategies import seeds

import zwidth as zw
from zwidth.model.environment import RationalFunction
from zwidth.model.scene import Damper, Lever, Mass, SceneRun, Spring

T = Fraction(1, 1000)


def at(z: complex, function: RationalFunction) -> complex:
    num, den = ([float(c) for c in side] for side in function)
    return complex(np.polyval(num, z) / np.polyval(den, z))


def node_matrix_impedance(scene: zw.Scene, z: complex) -> complex:
    """Z of the masses, springs and dampers, by solving for the velocities of all nodes in floats."""
    nodes = list(scene.nodes)
    p = 2 / float(T) * (z - 1) / (z + 1)
    ties = [e for e in scene.elements if e.ratio is not None]
    size = len(nodes) + len(ties)
    a, b = np.zeros((size, size), complex), np.zeros(size, complex)
    for element in scene.elements:
        row = np.zeros(size, complex)
        for sign, name in zip((1, -1), element.nodes, strict=True):
            if name != "ground":
                row[nodes.index(name)] = sign
        if element.ratio is not None:
            i = len(nodes) + ties.index(element)
            first, second = (nodes.index(name) for name in element.nodes)
            row[:] = 0
            row[second], row[first] = 1, -float(element.ratio)
            a[i] += row
            a[:, i] += row
            continue
        own = {"mass": p, "stiffness": 1 / p, "damping": 1}
        number = sum(getattr(element, key) * factor for key, factor in own.items() if hasattr(element, key))
        a += complex(number) * np.outer(row, row)
    port = nodes.index(scene.port)
    b[port] = 1.0
    return complex(1.0 / np.linalg.solve(a, b)[port])


@seeds(20)
def test_it_is_that_of_the_node_equations(seed):
    """Levers, loops and all, at points around the unit circle; E(z) is that of positions."""
    scene = random_scene(seed, 3 + seed % 12, LINEAR)
    z = np.exp(1j * (0.1 + seed % 1000 / 330)) * 1.05
    assert at(z, scene.impedance(T)) == pytest.approx(node_matrix_impedance(scene, z), rel=1e-7)
    of_positions = at(z, scene.impedance(T)) * (z - 1) / (float(T) * z)
    assert at(z, scene.pulse_transfer_function(T)) == pytest.approx(of_positions, rel=1e-7)


@seeds(12)
def test_the_step_is_the_filter(seed):
    scene = random_scene(seed, 3 + seed % 8, LINEAR)
    num, den = scene.pulse_transfer_function(T)
    num = (Fraction(0),) * (len(den) - len(num)) + num
    response: list[Fraction] = []
    for k in range(30):
        past = sum((den[i] * response[k - i] for i in range(1, min(k, len(den) - 1) + 1)), Fraction(0))
        response.append(((num[k] if k < len(num) else 0) - past) / den[0])
    forces = SceneRun(scene, T).follow(np.eye(30)[0])
    exact = np.array([float(f) for f in response])
    assert np.abs(forces - exact).max() <= 1e-11 * np.abs(exact).max()


@seeds(12)
def test_it_is_positive_real_by_the_exact_checker(seed):
    """ν ≥ 0 with a certificate, from velocity to force."""
    scene = random_scene(seed, 3 + seed % 8, LINEAR)
    port = zw.PulseTransferFunction(*scene.impedance(T), sample_period=T)
    device = zw.Device(damping=1, sample_period=T)
    assert zw.ports.passivity_indices(port, device).outcome == "passive"


def chain(masses: int) -> zw.Scene:
    """Masses of 10 g and springs of 400 N/m, one after the other, the far end on the ground."""
    springs = [Spring(f"m{i}", f"m{i + 1}" if i < masses else "ground", 400) for i in range(masses + 1)]
    return zw.Scene([*springs, *(Mass(f"m{i}", "0.01") for i in range(1, masses + 1))], port="m0")


def test_a_chain_of_a_hundred_masses_swings_as_its_modes_do():
    """A mode of scipy's generalized eigenproblem, held and let go, goes round at tan(ωT/2) = ω_c T/2."""
    n, t = 100, 0.001
    stiffness = 400 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    squares, shapes = eigh(stiffness, 0.01 * np.eye(n))
    run = SceneRun(chain(n), t)
    for _ in range(30):
        run.step(1e-4)
    run.follow(np.zeros(1))
    names = [f"m{i}" for i in range(1, n + 1)]
    seen = []
    for _ in range(300):
        places = run.positions
        seen.append([places[name] for name in names])
        run.follow(np.zeros(1))
    modal = np.array(seen) @ shapes
    turn = 2 * np.arctan(np.sqrt(squares) * t / 2)
    # each mode goes round by itself: y_{k+1} + y_{k−1} = 2 cos ωT y_k
    error = modal[2:] + modal[:-2] - 2 * np.cos(turn) * modal[1:-1]
    assert np.abs(error).max() <= 1e-11 * np.abs(modal).max()


def test_levers_may_close_a_loop():
    """Ties that agree are one tie; ties that contradict each other hold the node."""
    body = [
        Spring("handle", "a", 300),
        Mass("a", 1),
        Lever("a", "b", 2),
        Lever("b", "c", 3),
        Mass("c", "0.1"),
    ]
    agreeing = zw.Scene([*body, Lever("a", "c", 6)])
    assert agreeing.impedance(T) == zw.Scene(body).impedance(T)
    held = zw.Scene([*body, Lever("a", "c", 5)])
    assert held.impedance(T) == zw.Scene([Spring("handle", "ground", 300)]).impedance(T)


def test_a_hidden_part_cancels():
    seen = [Spring("handle", "a", 300), Mass("a", "0.2"), Damper("a", "ground", "0.1")]
    more = [Mass("far", "0.3"), Spring("far", "ground", 20)]
    assert zw.Scene([*seen, *more]).impedance(T) == zw.Scene(seen).impedance(T)
