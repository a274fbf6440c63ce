"""What commands on measurements found, for whoever prints it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from zwidth.data.identification.device.identify import Identified
    from zwidth.data.logs import Log
    from zwidth.data.tissue import TissueTest
    from zwidth.model.device import Device
    from zwidth.model.environment import Environment
    from zwidth.model.environment.discretization import Discretization
    from zwidth.passivity.bracket import Bracket
    from zwidth.passivity.interval_devices import OverRanges
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

    `ranges`: what holds over the ranges that the catalogue states, where it states some.
    `bracket`: of the factor on every force; None where nothing decides it, and then `reason` says why.
    `kept`: the same of hands that stay inside, where more is proved of them; else None.
    `throughout`: of a device with intervals, by contact, whether it is proved for every value of them.
    `box`: of all that the intervals of the tissue allow; None where they are not to be trusted.
    """

    device: Device
    verdict: Verdict
    ranges: OverRanges | None
    bracket: Bracket | None = None
    kept: Bracket | None = None
    reason: str = ""
    throughout: Mapping[str, bool] = MappingProxyType({})
    box: Verdict | None = None

    def of_which(self, bracket: Bracket) -> str:
        """The end of "proved passive": of which contact, of which hands, nothing of all; of which values."""
        said = "" if bracket.hand == "every hand" else f" for {bracket.hand}"
        if bracket.scope.contact == "kept":
            said = " while contact is kept"
        if (throughout := self.throughout.get(bracket.scope.contact)) is not None:
            said += f" ({'for every value' if throughout else 'at the worst ends'} of the device's intervals)"
        return said


class FittedTissue(NamedTuple):
    """A test, how its tissue is discretized, and what a device makes of it."""

    test: TissueTest
    rule: Discretization
    wall: OnDevice | None
