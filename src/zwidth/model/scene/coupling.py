"""Virtual couplings before a scene, as elements of it.

    f_k = K u_k + B (u_k − u_{k−1})/T,  u the stretch,

is a spring K of the scene with a damper B + K T/2 beside it: K T/2 is what backward Euler loses more than the
midpoint rule.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from zwidth.model.environment.environment import CouplingLaw
from zwidth.model.scene.element import Element


@dataclass(frozen=True)
class CouplingPart(Element):
    """Spring or damper of a coupling, of any sign: whether it is passive is not the scene's to say."""

    symbol: ClassVar[str] = "Z"

    ends: tuple[str, str]
    number: Fraction
    reflects: int

    @property
    def reflection(self) -> int:  # type: ignore[override]  # it has either
        """1 of the spring, 0 of the damper."""
        return self.reflects

    @property
    def nodes(self) -> tuple[str, str]:
        """The hand's side first."""
        return self.ends

    @property
    def title(self) -> str:
        """What it is."""
        return f"coupling's {'spring' if self.reflects else 'damper'}"

    def resistance(self, period: Fraction) -> Fraction:
        """K T/2, or the damping."""
        return self.number

    def describe(self, motion: str = "linear") -> str:
        """What it is; the coupling itself says its numbers."""
        return self.title


def coupled(
    elements: Sequence[Element], port: str, couplings: Sequence[CouplingLaw], period: Fraction
) -> tuple[tuple[Element, ...], str]:
    """The elements with those of the couplings, the hand's first; and the hand's node, the new port."""
    if not couplings:
        return tuple(elements), port
    hands = [" " * (i + 1) for i in range(len(couplings))]  # no node of a person's is called so
    more = [
        part
        for (k, b), ends in zip(couplings, zip(hands, [*hands[1:], port], strict=True), strict=True)
        for part in (
            CouplingPart(ends, k * period / 2, 1),
            CouplingPart(ends, b + k * period / 2, 0),
        )
        if part.number
    ]
    return (*more, *elements), hands[0]
