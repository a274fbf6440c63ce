"""What `zwidth identify` found, for whoever prints it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from zwidth.data.identification.device.identify import Identified
    from zwidth.data.logs import Log
    from zwidth.model.environment import Environment
    from zwidth.passivity.verdict import Verdict


class Result(NamedTuple):
    """What a log says, and of one environment."""

    log: Log
    identified: Identified
    confidence: float
    others: Mapping[str, Any]
    environment: Environment | None
    passive_for: float | None
    verdict: Verdict | None
