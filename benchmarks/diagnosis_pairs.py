"""Does the diagnosis name why two arms shake, and are they quiet once the one number is changed?

    python benchmarks/diagnosis_pairs.py FOLDER [--faults 180] [--seed 3027]
    python benchmarks/diagnosis_pairs.py FOLDER --faults 180 --seed 300 --learn

Pairs are drawn by `shaken_pairs.py`, which knows nothing of the diagnosis.  FOLDER keeps the logs.  `--learn`
prints the exponent γ of `zwidth.data.diagnosis.pairs.diagnose` that makes the drawn causes likeliest; its
seed must be another than that of the count.  A change is put into the arms themselves, not into what was
identified.
"""

from __future__ import annotations

import argparse
import pickle
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar
from shaken_pairs import CAUSES, Arms, Logged, draw, quiet, run, write_log

from zwidth.data.diagnosis import PairDiagnosis, diagnose_pair
from zwidth.data.diagnosis.pairs.diagnose import STEEPNESS

CANNOT_TELL = "cannot tell"
_FIELDS = ("stiffness", "damping", "local_damping", "compensation")


def main() -> None:
    """Draw, diagnose, mend."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--faults", type=int, default=180)
    parser.add_argument("--seed", type=int, default=3027)
    parser.add_argument("--learn", action="store_true", help="the exponent, instead of a count")
    given = parser.parse_args()
    given.folder.mkdir(exist_ok=True, parents=True)
    drawn = (kept(given.folder, given.seed, k) for k in range(given.faults))
    pairs = ((arms, logged, diagnose_pair(logged.path, logged.pair)) for arms, logged in drawn)
    if given.learn:
        print(f"γ = {_steepness([(arms.cause, found) for arms, _, found in pairs]):.2f}")
        return
    named: Counter[tuple[str, str]] = Counter()
    by_columns: Counter[tuple[str, str]] = Counter()
    mended: Counter[tuple[str, bool]] = Counter()
    confident: list[tuple[float, bool]] = []
    for k, (arms, logged, found) in enumerate(pairs):
        says = found.cause or CANNOT_TELL
        named[arms.cause, says] += 1
        how = "right" if says == arms.cause else CANNOT_TELL if says == CANNOT_TELL else "wrong"
        by_columns[logged.columns, how] += 1
        if found.cause is not None:
            confident.append((found.confidence, how == "right"))
        if how == "wrong":
            print(f"{k}: {arms.cause} is called {says} ({found.confidence:.2f}), {logged.columns}")
        if found.change is not None:
            assert found.change.parameter in _FIELDS
            changed = replace(arms, **{found.change.parameter: found.change.to})
            is_quiet = quiet(changed, run(changed))
            mended[how, is_quiet] += 1
            if not is_quiet:
                print(f"{k}: {arms.cause} is called {says}, not quiet: {found.change.text}")
    for cause in CAUSES:
        print(f"{cause:24}", {says: n for (was, says), n in named.items() if was == cause})
    total = Counter(how for (_, how), n in by_columns.items() for _ in range(n))
    print(dict(total), dict(sorted(by_columns.items())), "quiet once changed", dict(mended))
    for low, high in ((0.6, 0.8), (0.8, 0.95), (0.95, 1.01)):
        if inside := [right for p, right in confident if low <= p < high]:
            print(f"said {low} to {min(high, 1):.2f}: {len(inside)}, right {100 * np.mean(inside):.0f} %")


def kept(folder: Path, seed: int, k: int) -> tuple[Arms, Logged]:
    """The k-th pair and its log, drawn where they are not there yet."""
    file = folder / f"{k}.pkl"
    if not file.exists():
        rng = np.random.default_rng([seed, k])
        arms, made = draw(rng, CAUSES[k % len(CAUSES)])
        file.write_bytes(pickle.dumps((arms, write_log(rng, arms, made, folder / f"{k}.csv"))))
    found: tuple[Arms, Logged] = pickle.loads(file.read_bytes())
    return found


def _steepness(looked: list[tuple[str, PairDiagnosis]]) -> float:
    """γ of the greatest likelihood, of those in which the right term gives anything."""
    now = STEEPNESS
    rows = []
    for cause, found in looked:
        if found.likely.get(cause, 0.0) > 0:
            size = np.log(np.array([p for p in found.likely.values() if p > 0])) / now
            rows.append((np.log(found.likely[cause]) / now, size))
    print(f"{len(rows)} of {len(looked)} give anything by the right term")

    def loss(steep: float) -> float:
        return sum(np.log(np.exp(steep * (every - own)).sum()) for own, every in rows)

    return float(minimize_scalar(loss, bounds=(0.1, 20), method="bounded").x)


if __name__ == "__main__":
    main()
