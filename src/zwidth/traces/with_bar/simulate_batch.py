"""`zwidth.simulation.simulate_batch`: loops are counted."""

from __future__ import annotations

from zwidth.loop.batch import simulate_batch as _batch
from zwidth.traces.with_bar import with_bar

simulate_batch = with_bar(_batch, "loops")
