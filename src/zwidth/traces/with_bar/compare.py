"""`zwidth.compare`: laws are counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from zwidth.bench import bench as _bench
from zwidth.traces.with_bar import with_bar

if TYPE_CHECKING:  # a decorator keeps one of several signatures
    from zwidth.bench.bench import compare as compare
else:
    compare = with_bar(_bench.compare, "laws")
