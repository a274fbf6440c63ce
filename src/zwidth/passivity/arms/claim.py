"""The verdict on an arm in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from zwidth.device.arm import Arm, Sites
from zwidth.passivity.arms.account import Account
from zwidth.passivity.arms.held import in_words

Array = npt.NDArray[np.float64]


def claim(
    outcome: str,
    sites: Sites,
    account: Account,
    arm: Arm,
    held: float | Sequence[float] | None,
    without: str,
) -> str:
    """One sentence on what holds, others on what is not counted."""
    part = 100 * account.proved.mean()
    if outcome == "passive":
        text = f"No motion of the hand takes energy out with {sites.region}, proved."
    elif outcome == "theorem":
        text = f"No motion of the hand takes energy out with {sites.region}, by a proof on paper."
    elif outcome == "active":
        text = "At one point of this map a motion of the hand takes energy out."
    elif (account.margins >= 0).all():
        text = (
            f"The condition holds at every point; between the points {part:.4g} % of the region are proved."
        )
    else:
        text = (
            f"{part:.4g} % of the region are proved; where the condition fails, no motion was found "
            "that takes energy out."
        )
    if outcome in ("theorem", "undecided") and without:
        text += f" There is no certificate: {without}."
    if not account.reached.all():
        text += " Parts of the region are out of reach; a smaller region may be proved."
    return text + (
        " The torque is taken to follow the arm within a period."
        if held is None
        else f" The torque is held over a period, with wall forces up to {in_words(held)}."
    )


def encoders(arm: Arm, friction: Array, held: bool) -> str:
    """Whether the friction that covers the encoder steps is there; nothing of an arm without encoders."""
    if not friction.size:
        return ""
    own = arm.coulomb_friction or (0.0,) * len(friction)
    if held or not (friction <= own).all():
        return " Encoder steps are not counted."
    return " Encoder steps are counted: Coulomb friction covers them, by a proof on paper."
