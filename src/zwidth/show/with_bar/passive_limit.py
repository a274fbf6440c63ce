"""`zwidth.limit`: loops are counted."""

from __future__ import annotations

from zwidth.passivity.bracket.passive_limit import passive_limit as _limit
from zwidth.show.with_bar import with_bar

passive_limit = with_bar(_limit, "loops")
