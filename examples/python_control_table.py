"""The table that says why zwidth exists: python-control's `ispassive` beside zwidth's verdict.

A device of m = 0.1 kg and b = 0.1 N·s/m renders the wall H(z) = K + B (z − 1)/(T z)
at T = 1 ms.  The device alone is passive and the wall alone is passive, and
`ispassive` says so in every row.  The loop of the two, sampled and held, is
another matter: stability of that loop does not answer it either.

Run it in an environment with the test extra, which brings python-control:

    python examples/python_control_table.py
"""

from __future__ import annotations

import sys
from typing import Any, NamedTuple

import control

import zwidth as zw

MASS, DAMPING, PERIOD = 0.1, 0.1, 0.001
WALLS = ((150, 0.02), (150, 0.20), (1000, 0.05), (1000, 0.50))
"""(K [N/m], B [N·s/m])"""


class Row(NamedTuple):
    """One wall: what the criterion needs, what zwidth says, what the loop and python-control say."""

    stiffness: float
    damping: float
    needed: float
    outcome: str
    spectral_radius: float
    device_is_passive: bool
    wall_is_passive: bool


def rows() -> list[Row]:
    """The four rows, computed now."""
    device = zw.Device(mass=MASS, damping=DAMPING, sample_period=PERIOD)
    body = control.ss(control.tf([1], [MASS, DAMPING]))  # force → velocity
    return [_row(device, body, k, b) for k, b in WALLS]


def _row(device: zw.Device, body: Any, stiffness: float, damping: float) -> Row:
    verdict = zw.check(device, zw.Wall(stiffness=stiffness, damping=damping))
    return Row(
        stiffness,
        damping,
        verdict.required_damping or float("nan"),
        verdict.outcome,
        spectral_radius(stiffness, damping),
        control.ispassive(body),
        control.ispassive(pulse_wall(stiffness, damping)),
    )


def pulse_wall(stiffness: float, damping: float) -> Any:
    """H(z) = K + B (z − 1)/(T z), position → force."""
    rate = damping / PERIOD
    return control.ss([[0]], [[1]], [[-rate]], [[stiffness + rate]], PERIOD)


def spectral_radius(stiffness: float, damping: float) -> float:
    """Largest |pole| of the loop: the body behind a zero-order hold, the wall in feedback."""
    to_position = control.ss([[0, 1], [0, -DAMPING / MASS]], [[0], [1 / MASS]], [[1, 0]], [[0]])
    sampled = control.sample_system(to_position, PERIOD, "zoh")
    loop: Any = control.feedback(sampled, pulse_wall(stiffness, damping))
    return float(max(abs(loop.poles())))


def table() -> str:
    """The rows as a Markdown table."""
    lines = [
        "| K [N/m] | B [N·s/m] | needs b ≥ | zwidth: the loop is | loop spectral radius "
        "| `ispassive(device)` | `ispassive(wall)` |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows():
        radius = f"{row.spectral_radius:.6f}" + (", unstable" if row.spectral_radius > 1 else "")
        lines.append(
            f"| {row.stiffness:g} | {row.damping:.2f} | {row.needed:.3f} | {row.outcome} | {radius} "
            f"| {row.device_is_passive} | {row.wall_is_passive} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.buffer.write(f"{table()}\n".encode())
