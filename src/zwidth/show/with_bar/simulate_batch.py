"""`zwidth.simulation.simulate_batch`: loops are counted."""

from __future__ import annotations

import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.loop.batch import simulate_batch as _batch
from zwidth.show.with_bar import with_bar

simulate_batch = with_bar(_batch, "loops")
