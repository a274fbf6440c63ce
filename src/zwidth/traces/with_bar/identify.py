"""`zwidth.identify`: samples are counted."""

from __future__ import annotations

from zwidth.identification.recording import identify as _identify
from zwidth.traces.with_bar import with_bar

identify = with_bar(_identify, "samples")
