"""What `zwidth tissue` found, for whoever prints it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from zwidth.data.tissue import TissueTest
    from zwidth.model.device import Device
    from zwidth.model.environment.discretization import Discretization
    from zwidth.passivity.bracket import Bracket
    from zwidth.passivity.verdict import Verdict


class Wall(NamedTuple):
    """The tissue on a device.

    Parameters
    ----------
    verdict
        Of the estimates.
    bracket
        Of the factor on every force; None where nothing decides it, and then `reason` says why.
    box
        Of all that the intervals allow; None where they are not to be trusted.
    """

    device: Device
    verdict: Verdict
    bracket: Bracket | None
    reason: str
    box: Verdict | None


class Result(NamedTuple):
    """A test, how its tissue is discretized, and what a device makes of it."""

    test: TissueTest
    rule: Discretization
    wall: Wall | None
