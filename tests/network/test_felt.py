"""What is felt through a line between a fast device and a slow scene: its stiffness w/τ and its mass w τ.

τ = (N + 1) T/2 where the scene steps once in N samples and packets are used at once.
"""

import numpy as np
import pytest

import zwidth as zw
from zwidth.links import WavePort
from zwidth.machine.network.runs import PartRun
from zwidth.model.scene import Damper, LineEnd, Mass, Scene, Spring
from zwidth.model.scene.parts import Part

T, W = 1e-3, 0.15
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
