"""What commands on measurements found, for whoever prints it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from zwidth.data.identification.device.identify import Identified
    from zwidth.data.logs import Log
    from zwidth.data.tissue import TissueTest
    from zwidth.model.device import Device
    from zwidth.model.environment import Environment
    from zwidth.model.environment.discretization import Discretization
    from zwidth.passivity.bracket import Bracket
    from zwidth.passivity.verdict import Verdict


class Identification(NamedTuple):
    """What a log says, and of one environment."""

    log: Log
    identified: Identified
    confidence: float
    others: Mapping[str, Any]
    environment: Environment | None
    passive_for: float | None
    verdict: Verdict | None


class OnDevice(NamedTuple):
    """The tissue on a device.

    `bracket`: of the factor on every force; None where nothing decides it, and then `reason` says why.
    `kept`: the same of hands that stay inside, where more is proved of them; else None.
    `box`: of all that the intervals allow; None where they are not to be trusted.
    """

    device: Device
    verdict: Verdict
    bracket: Bracket | None
    kept: Bracket | None
    reason: str
    box: Verdict | None


def of_which(bracket: Bracket) -> str:
    """The end of "proved passive": of which contact, of which hands; nothing of all."""
    if bracket.scope.contact == "kept":
        return " while contact is kept"
    return "" if bracket.hand == "every hand" else f" for {bracket.hand}"


class FittedTissue(NamedTuple):
    """A test, how its tissue is discretized, and what a device makes of it."""

    test: TissueTest
    rule: Discretization
    wall: OnDevice | None
