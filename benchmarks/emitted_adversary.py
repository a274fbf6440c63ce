"""Does a hand ever gain from emitted code that is proved passive?  Random walls near their limits.

Springs and damped walls, clamped or not, in double, float and fixed point with coarse words and short force
steps; damping and Coulomb friction hardly more, or hardly less, than wall and rounding need.  Motions that
are repeated run on the emitted C, compiled here: over one encoder edge, in and out at once, sinusoids,
anything.  What a round gains is summed in fractions.  `contradicted` must be 0.

    python benchmarks/emitted_adversary.py [--loops 1000] [--seed 0] [--rounds 60] [--seconds 600]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from firmware.adversary import attacked, random_loop

from zwidth.machine.firmware.verdict import PROVED


def main() -> int:
    """0 where nothing is contradicted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, value in (("loops", 1000), ("seed", 0), ("rounds", 60), ("seconds", 600)):
        parser.add_argument(f"--{name}", type=int, default=value)
    given = parser.parse_args()
    counts: Counter[str] = Counter()
    begin = time.monotonic()
    for k in range(given.loops):
        if time.monotonic() - begin > given.seconds:
            break
        random = Random(given.seed * 1_000_003 + k)
        loop = random_loop(random)
        with tempfile.TemporaryDirectory() as folder:
            most, cycle = attacked(loop, random, given.rounds, Path(folder))
        found = loop.found
        counts["loops"] += 1
        lost = found.ideal.outcome in PROVED and not found.proved
        kind = "proved" if found.proved else "lost to rounding" if lost else "not proved at all"
        counts[f"{kind}, {'a hand gains' if most > 0 else 'no gain found'}"] += 1
        if found.proved and most > 0:
            counts["contradicted"] += 1
            print("CONTRADICTED", k, loop.name, float(most), cycle)
    print("\n".join(f"{n:6}  {what}" for what, n in sorted(counts.items())))
    return 1 if counts["contradicted"] else 0


if __name__ == "__main__":
    sys.exit(main())
