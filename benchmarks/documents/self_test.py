"""Can every judge say no?  Documents are written as ever, the checker is not asked, and each is judged."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping

from .examine import judged
from .grammar import SHARES, Valid, write
from .opinion import FALSE


def blind(kind: str, seeds: Mapping[str, Valid], number: int) -> Counter[str]:
    """What the judge of a kind says of so many documents if the checker accepted all of them."""
    said: Counter[str] = Counter()
    for seed in range(number):
        written = write(seed, seeds, kind)
        if not written.ill_formed and isinstance(written.document, dict):
            said[judged(written.document, seed).word] += 1
    return said


def self_test(seeds: Mapping[str, Valid], number: int = 60) -> int:
    """How many judges found nothing false among documents that nobody checked; prints what each said."""
    silent = 0
    for kind in SHARES:
        said = blind(kind, seeds, number)
        silent += not said[FALSE]
        print(f"{kind}: {dict(said)}", flush=True)
    valid = sum(judged(json.loads(text), 0).word == FALSE for some in seeds.values() for text in some.texts)
    print(f"{silent} judges never said false; {valid} valid documents were called false")
    return silent + valid
