"""`zwidth.simulate`: samples are counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.loop import simulate as _loop
from zwidth.show.with_bar import with_bar

if TYPE_CHECKING:  # a decorator keeps one of several signatures
    from zwidth.loop.simulate import simulate as simulate
else:
    simulate = with_bar(_loop.simulate, "samples")
