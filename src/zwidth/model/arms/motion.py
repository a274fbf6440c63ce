"""A closed motion of an arm, and its energy over one round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_ROUNDING = 1e-9
"""Of what is added up: an energy below it may be rounding."""


@dataclass(frozen=True, kw_only=True)
class ArmMotion:
    """A closed motion, and its energy over one round.

    Parameters
    ----------
    joints
        q(k), N × m [rad; m].
    positions
        p(k), N × n [m]; in pose its rotation comes last [rad].
    work
        Of the hand against the wall's force, over one round [J].
    loss
        Of the joints' friction, over one round [J].
    rest
        Where the wall rests, n [m]; in pose its rotation comes last [rad].
    largest_force
        That the wall renders on the way [N].
    largest_moment
        The same of what it gives for rotations, 0 of a point [N·m].
    encoder
        "ideal": position and Jacobian are read without steps. "counted": at the readings of the arm's
        encoders.
    imposed_by
        "end": a hand at the end holds every joint. "links": it does not, as the arm has more joints than the
        hand has coordinates; whoever makes this motion holds the links, too.
    """

    joints: Array
    positions: Array
    work: float
    loss: float
    rest: Array
    largest_force: float
    largest_moment: float = 0.0
    encoder: str = "ideal"
    imposed_by: str = "end"

    @property
    def energy(self) -> float:
        """What the hand puts in, over one round [J]; negative: it takes energy out."""
        return self.work + self.loss

    @property
    def takes_energy(self) -> bool:
        """Whether it does so by more than rounding."""
        return self.energy < -_ROUNDING * (abs(self.work) + self.loss)
