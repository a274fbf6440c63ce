"""What people do with a trace: look, listen, save, load, compare; and what they wait for, with a bar."""

import zwidth.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)
