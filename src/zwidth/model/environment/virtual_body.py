"""What a display of admittance renders: a body that answers the hand's force with a velocity.

    implicit   (M + B T + K T²) v_k = M v_{k−1} + T (φ_k − K y_k)
    explicit   M v_k = M v_{k−1} + T (φ_{k−1} − B v_{k−1} − K y_{k−1})
               y_{k+1} = y_k + T v_k

φ is the force that was read, y where the body is; its spring ends at y = 0.  Both
are the body M v̇ + B v + K y = f in one step of Euler, backward and forward: the
explicit one answers a sample later.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, Parametric, parameter, word

Integration = Literal["implicit", "explicit"]

INTEGRATIONS: tuple[Integration, ...] = ("implicit", "explicit")

_GIVES_OUT = "the body itself would give out energy"


@dataclass(frozen=True)
class VirtualBody(Parametric):
    """A mass with a damper and a spring to the ground, ``M v̇ + B v + K y = f``, stepped with the samples.

    Parameters
    ----------
    mass
        M > 0 [kg].
    damping
        B ≥ 0 [N·s/m].
    stiffness
        K ≥ 0, to y = 0 [N/m].
    integration
        "implicit" (default), Euler backward; "explicit", forward, a sample later.

    Raises
    ------
    InputError
        If a number is outside its bound, or integration is none of the two.
    """

    mass: Certain = parameter(
        "mass",
        kept=Exact,
        bound="> 0",
        why="a body without mass follows every jump of the force; a light one is unstable against a stiff "
        "hand, see zwidth.stability.stable_virtual_masses",
    )
    damping: Certain = parameter("virtual_damping", 0, kept=Exact, bound="≥ 0", why=_GIVES_OUT)
    stiffness: Certain = parameter("stiffness", 0, kept=Exact, bound="≥ 0", why=_GIVES_OUT)
    integration: Integration = word(*INTEGRATIONS)

    def describe(self) -> str:
        """The body with its numbers, on one line."""
        parts = [f"{self.mass:.6g} kg"]
        parts += [f"{self.damping:.6g} N·s/m"] if self.damping else []
        parts += [f"{self.stiffness:.6g} N/m"] if self.stiffness else []
        return f"virtual body, {', '.join(parts)}, {self.integration}"
