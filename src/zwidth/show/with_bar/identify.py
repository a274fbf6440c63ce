"""`zwidth.identify`: samples are counted."""

from __future__ import annotations

from zwidth.data.identification.device.identify import identify as _identify
from zwidth.show.with_bar import with_bar

identify = with_bar(_identify, "samples")
