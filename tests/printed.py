"""Text with numbers in it, compared as a reader compares it: `from printed import shows`."""

from __future__ import annotations

import re
from decimal import Decimal

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def shows(printed: str, expected: str) -> bool:
    """Whether the expected words stand there, each number of three digits or more to one in its last place.

    Another processor or library may round the last digit otherwise; words and small counts are the same.
    """
    pattern = _NUMBER.pattern.join(map(re.escape, _NUMBER.split(expected)))
    wanted = _NUMBER.findall(expected)
    return any(
        all(map(_alike, _NUMBER.findall(found.group()), wanted)) for found in re.finditer(pattern, printed)
    )


def _alike(one: str, other: str) -> bool:
    shown = Decimal(other).as_tuple()
    assert isinstance(shown.exponent, int)
    last = Decimal(1).scaleb(shown.exponent) if len(shown.digits) > 2 else Decimal(0)
    return abs(Decimal(one) - Decimal(other)) <= last
