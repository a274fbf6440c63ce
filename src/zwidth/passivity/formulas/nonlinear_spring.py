"""A spring given by points, proved from its slopes: detents, bump stops, magnets.

    b ≥ (T/2) (w + √(w² + α (1 − α) s²)),   w = L/2 + (d + α) s      f_c ≥ s Δ/2

L ≥ 0 is the largest slope, s the largest |slope|, the delay d whole samples and a part α of one; of whole
samples it is b ≥ w T.  Negative slopes cost nothing without delay, as long as the potential has a lowest
value: beyond its ends the spring must not pull away.  Without delay what Coulomb friction has left over s Δ/2
pays for short rises that are steeper, as `checker.loop.spring` works out.
The proof is in the documentation; where its steepest part is long enough, both conditions are necessary.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import sqrt
from typing import Any

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import Contact, unit_key
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.text import exact_text, quantity_unit, shown


@dataclass(frozen=True)
class SpringNeed:
    """What a nonlinear spring asks of a device, as far as it is proved."""

    largest_slope: Fraction  # L ≥ 0, what the hold multiplies [N/m; N·m/rad]
    steepest: Fraction  # s, the largest |slope|, what an encoder count multiplies [N/m; N·m/rad]
    held: Fraction  # w T, what hold and delay ask for [N·s/m; N·m·s/rad]
    # α (1 − α) s² T²/4, what a force that changes within a sample adds [(N·s/m)²; (N·m·s/rad)²]
    within: Fraction
    coulomb_friction: Fraction  # f_c that is enough [N; N·m]
    bounded: bool  # True if the potential has a lowest value; else no friction is enough here

    @property
    def damping(self) -> float:
        """The least b that is enough [N·s/m; N·m·s/rad], rounded."""
        held = float(self.held)
        return (held + sqrt(held**2 + 4 * float(self.within))) / 2

    def spare(self, damping: Fraction) -> Fraction:
        """Exactly ≥ 0 for a damping that is enough, 0 at the limit."""
        return min(damping - self.held, damping * (damping - self.held) - self.within)


def spring_need(device: Device, spring: Environment) -> SpringNeed:
    """What the slopes of a spring ask of a device."""
    points = [(x.fraction, f.fraction) for x, f in spring.points]
    slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in pairwise(points)]
    largest, steepest = max(*slopes, Fraction(0)), max(map(abs, slopes))
    period = device.exact("sample_period")
    late = device.exact("delay") / period
    part = late % 1
    return SpringNeed(
        largest_slope=largest,
        steepest=steepest,
        held=(largest / 2 + late * steepest) * period,
        within=part * (1 - part) * (steepest * period) ** 2 / 4,
        coulomb_friction=steepest * device.exact("resolution") / 2,
        bounded=points[0][1] <= 0 <= points[-1][1],
    )


@dataclass(frozen=True, repr=False)
class EndlessPull(Evidence):
    """A proof that a spring gives out energy without end: it pulls away, and friction holds less."""

    document: dict[str, Any]  # the loop and the points, for the checker
    pull: float  # the force with which it does [N; N·m]
    unit: str  # of it

    @property
    def witness(self) -> None:
        """No motion ends it: the hand lets itself be pulled, slowly, as far as it likes."""
        return None

    @property
    def contact(self) -> Contact:
        """The spring has no surface."""
        return "both sides"

    def to_dict(self) -> dict[str, Any]:
        """The proof as plain data."""
        return self.document

    def describe(self) -> str:
        """What is wrong, in words."""
        return f"beyond an end the spring pulls away with {shown(self.pull, self.unit, 6)} for ever"


def refute_spring(device: Device, spring: Environment) -> EndlessPull | None:
    """The proof that a spring pulls away for ever, if it does and the checker accepts it."""
    pull = max(spring.points[0][1].fraction, -spring.points[-1][1].fraction)
    unit = quantity_unit("force", device.motion)
    found = EndlessPull(_document(device, spring, "endless pull"), float(pull), unit)
    return found if found.verify() else None


def certify_spring(device: Device, spring: Environment) -> Certificate:
    """The loop and the points; the checker evaluates the conditions."""
    return Certificate((_document(device, spring, "nonlinear spring"),))


def _document(device: Device, spring: Environment, kind: str) -> dict[str, Any]:
    names = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    loop = {unit_key(name, device.motion): exact_text(device.exact(name)) for name in names}
    length, force = (unit_suffix(device.unit(name)) for name in ("position", "force"))
    points = [[exact_text(x.fraction), exact_text(f.fraction)] for x, f in spring.points]
    return {"format": FORMAT, "kind": kind, "loop": loop, "law": {f"points_{length}_{force}": points}}
