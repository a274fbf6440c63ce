"""Loops in time beyond `zwidth.simulate`: pairs, admittance, many at once, a device of software."""

import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
