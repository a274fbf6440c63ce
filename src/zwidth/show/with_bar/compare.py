"""`zwidth.compare`: laws are counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import zwidth.loop.traces.accessor  # noqa: F401 - gives every trace its `.zwidth`
from zwidth.show.with_bar import with_bar
from zwidth.study.bench import bench as _bench

if TYPE_CHECKING:  # a decorator keeps one of several signatures
    from zwidth.study.bench.bench import compare as compare
else:
    compare = with_bar(_bench.compare, "laws")
