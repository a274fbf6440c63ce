"""What the ports that send waves share: the impedance w of the waves."""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.errors import InputError
from zwidth.links.memory import COULOMB, DAMPING, OWN_NUMBERS, PERIOD
from zwidth.links.port import Port
from zwidth.quantity.exact import Exact, ends
from zwidth.quantity.parameter import CertainOrNone, parameter


@dataclass(frozen=True)
class Waves(Port):
    """A port that sends waves of impedance w."""

    impedance: CertainOrNone = parameter(
        "wave_impedance", None, kept=Exact, bound="> 0", why="a wave of no impedance carries no force"
    )

    def complete(self) -> None:
        """Where no impedance is given it is the device's damping."""
        if self.impedance is None:
            damping = ends(self.device.damping)[0]
            if damping == 0:
                raise InputError(
                    "impedance must be > 0, got none and a device without damping, whose own is the default: "
                    "a passive port needs damping in the device; give impedance where another law is tried"
                )
            self._keep(impedance=Exact(damping))

    def telling_ways(self) -> list[float]:
        """Quick enough, where w > b, that (w − b) Δx²/T is twice what Coulomb friction takes."""
        p = self.numbers
        more = p[OWN_NUMBERS] - p[DAMPING]
        quick = [2.0 * p[COULOMB] * p[PERIOD] / more] if more > 0 else []
        return [*super().telling_ways(), *quick]
