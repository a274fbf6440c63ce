"""The verdict on an arm in words, from what it covers."""

from __future__ import annotations

from typing import NamedTuple

from zwidth.model.arms.encoders import EncoderSteps, in_words
from zwidth.passivity.workspace.account import Account


class Covers(NamedTuple):
    """What a verdict on an arm is about."""

    region: str
    torque: str
    encoder: str
    forces: tuple[float, ...]
    why_ideal: str  # why the steps of an arm that has some are not counted
    can_be_refuted: bool
    has_friction: bool  # whether any Coulomb friction is given


def claim(outcome: str, covers: Covers, account: Account, without: str, steps: EncoderSteps | None) -> str:
    """One sentence on what holds, others on what is not counted."""
    part = 100 * account.proved.mean()
    where = f"{covers.region}{_up_to(covers)}"
    if outcome == "passive":
        text = f"No motion of the hand takes energy out with {where}, proved."
    elif outcome == "passive without encoder steps":
        text = f"Read without steps, no motion of the hand would take energy out with {where}, proved."
    elif outcome == "theorem":
        text = f"No motion of the hand takes energy out with {where}, by a proof on paper."
    elif outcome == "active":
        text = "At one point of this map a motion of the hand takes energy out."
        if not covers.can_be_refuted:
            text = (
                "At one point of this map a motion of the joints takes energy out. It is made by hands that "
                "hold the links, such as one at the elbow and one at the end; a hand at the end alone cannot "
                "make every joint follow, and of it nothing is said."
            )
        if covers.encoder == "counted" and not covers.has_friction:
            text += " Coulomb friction is not given and taken as 0."
    elif covers.encoder == "counted" and without and (account.margins >= 0).all():
        text = f"Whether a motion takes energy out behind these encoders is not known: {without}."
        without = ""
    elif (account.margins >= 0).all():
        text = (
            f"The condition holds at every point; between the points {part:.4g} % of the region are proved."
        )
    else:
        text = (
            f"{part:.4g} % of the region are proved; at other points the condition fails, and no motion was "
            "found that takes energy out."
        )
    if outcome in ("theorem", "undecided") and without:
        text += f" There is no certificate: {without}."
    if not account.reached.all():
        text += " Parts of the region are out of reach; a smaller region may be proved."
    return f"{text} {_counted(covers, outcome)}{_beyond(covers, steps, outcome)}"


def _counted(covers: Covers, outcome: str) -> str:
    """How the arm is read, and what becomes of the torque within a period."""
    up_to = _up_to(covers) if outcome == "undecided" else ""  # what is proved says it first
    if covers.encoder == "counted":
        torque = (
            "is held over a period" if covers.torque == "held" else "follows the readings within a period"
        )
        read = "force and Jacobian are those of the readings"
        return f"Encoder steps are counted{up_to}: {read}, and the torque {torque}."
    torque = (
        f"held over a period{up_to}" if covers.torque == "held" else "taken to follow the arm within a period"
    )
    steps = f" Encoder steps are not counted: {covers.why_ideal}." if covers.why_ideal else ""
    return f"The arm is taken to be read without steps.{steps} The torque is {torque}."


def _up_to(covers: Covers) -> str:
    if not covers.forces or in_words(covers.forces) == "any":
        return ""
    return f", for wall forces up to {in_words(covers.forces)}"


def _beyond(covers: Covers, steps: EncoderSteps | None, outcome: str) -> str:
    """From which force on a motion across the edges of the encoders is known."""
    if steps is None or steps.refuted is None or outcome == "active":
        return ""
    return f" From {steps.refuted:.4g} N on a motion across their edges takes energy out."
