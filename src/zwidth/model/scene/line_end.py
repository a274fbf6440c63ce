"""Where a line to another part of a scene ends: a matched damper, and the force of the wave that comes in.

    f̄ = w v̄ − f

f is held over the step, as a port of `zwidth.links` gives it; w is the damping that such a port counts on.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from zwidth.model.environment.wording import with_unit
from zwidth.model.scene.element import GROUND, Element, label, node
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, parameter


@dataclass(frozen=True)
class LineEnd(Element):
    """The end of a line at a node, ``f̄ = w v̄ − f``.

    What it takes in goes into the line, and what comes out of the line it gives: its losses may be negative.

    Parameters
    ----------
    node
        Where it ends.
    impedance
        w > 0 [N·s/m; N·m·s/rad].
    name
        Of the line.
    """

    symbol: ClassVar[str] = "w"
    leads_elsewhere: ClassVar[bool] = True

    node: str = node("where the line ends")
    impedance: Certain = parameter(
        "wave_impedance", kept=Exact, bound="> 0", why="a wave of no impedance carries no force"
    )
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        """The node, and the frame in which it moves."""
        return self.node, GROUND

    @property
    def title(self) -> str:
        """The line's name, or its node."""
        return self.name or f"line at {self.node}"

    def resistance(self, period: Fraction) -> Fraction:
        """w."""
        return self.impedance.fraction

    def describe(self, motion: str = "linear") -> str:
        """The line with its impedance."""
        return f"{self.title} {with_unit('wave_impedance', self.impedance, motion)}"
