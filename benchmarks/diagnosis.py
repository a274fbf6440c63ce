"""Does the diagnosis name why a thing shakes, and is it quiet once the one number is changed?

    python benchmarks/diagnosis.py FOLDER [--faults 500] [--seed 2027]

Faults are drawn by `shaken_draws.py`, which knows nothing of the diagnosis, with a seed that was not used to
learn its weights.  FOLDER keeps the logs, so that a second call goes on where the first one was stopped.
Every file is read as `zwidth diagnose` reads it.  A change is put into the thing itself, not into what was
identified of it.
"""

from __future__ import annotations

import argparse
import pickle
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from shaken import CAUSES, Thing, quiet, run
from shaken_draws import draw
from shaken_logs import Logged, write_log

import zwidth as zw

CANNOT_TELL = "cannot tell"


def main() -> None:
    """Draw, diagnose, mend."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--faults", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="of the faults, where they are taken in pieces")
    parser.add_argument("--seed", type=int, default=2027)
    given = parser.parse_args()
    given.folder.mkdir(exist_ok=True, parents=True)
    named: Counter[tuple[str, str]] = Counter()
    by_columns: Counter[tuple[str, str]] = Counter()
    by_device: Counter[tuple[bool, str]] = Counter()
    mended: Counter[tuple[str, bool]] = Counter()
    confident: list[tuple[float, bool]] = []
    for k in range(given.first, given.first + given.faults):
        thing, logged = kept(given.folder, given.seed, k)
        found = zw.diagnose(logged.path, logged.device)
        says = found.cause or CANNOT_TELL
        named[thing.cause, says] += 1
        how = "right" if says == thing.cause else CANNOT_TELL if says == CANNOT_TELL else "wrong"
        by_columns[logged.columns, how] += 1
        by_device[logged.device is not None, how] += 1
        if found.cause is not None:
            confident.append((found.confidence, how == "right"))
        if found.change is not None:
            is_quiet = _is_quiet(thing, found.change)
            mended["right" if how == "right" else "wrong", is_quiet] += 1
        if how == "wrong" or (found.change is not None and not is_quiet):
            text = found.change and found.change.text
            print(f"{k}: {thing.cause} is called {says} ({found.confidence:.2f}), change: {text}")
    _table(named)
    for title, counts in (
        ("columns", by_columns),
        ("device given", by_device),
        ("quiet once changed", mended),
    ):
        print(title, dict(sorted(counts.items(), key=str)))
    for low in (0.6, 0.7, 0.8, 0.9):
        inside = [right for p, right in confident if low <= p < low + 0.1 or (low == 0.9 and p == 1.0)]
        if inside:
            print(f"said {low:.1f} to {low + 0.1:.1f}: {len(inside)}, right {100 * np.mean(inside):.0f} %")


def kept(folder: Path, seed: int, k: int) -> tuple[Thing, Logged]:
    """The k-th thing and its log, drawn where they are not there yet."""
    file = folder / f"{k}.pkl"
    if not file.exists():
        rng = np.random.default_rng([seed, k])
        thing, made = draw(rng, CAUSES[k % len(CAUSES)])
        file.write_bytes(pickle.dumps((thing, write_log(rng, thing, made, folder / f"{k}.csv"))))
    found: tuple[Thing, Logged] = pickle.loads(file.read_bytes())
    return found


_FIELDS = {
    "stiffness": "stiffness",
    "damping": "virtual_damping",
    "delay": "delay",
    "drive_damping": "drive_damping",
    "compensation": "compensation",
}


def _is_quiet(thing: Thing, change: Any) -> bool:
    """Whether the thing itself is quiet with that number; the hand presses as deep as before."""
    changes: dict[str, Any] = {_FIELDS[change.parameter]: change.to}
    if change.parameter == "stiffness" and thing.press:
        changes["press"] = thing.press * change.to / thing.stiffness
    changed = replace(thing, **changes)
    return quiet(changed, run(changed))


def _table(named: Counter[tuple[str, str]]) -> None:
    columns = (*CAUSES, CANNOT_TELL)
    print(f"{'':30}" + " ".join(f"{name[:9]:>9}" for name in columns))
    for cause in CAUSES:
        print(f"{cause:30}" + " ".join(f"{named[cause, says] or '·':>9}" for says in columns))
    total = sum(named.values())
    right = sum(named[cause, cause] for cause in CAUSES)
    unsaid = sum(named[cause, CANNOT_TELL] for cause in CAUSES)
    wrong = total - right - unsaid
    shares = (f"{100 * n / total:.1f} %" for n in (right, unsaid, wrong))
    print(f"{total} faults: right {right}, cannot tell {unsaid}, wrong {wrong}:", *shares)


if __name__ == "__main__":
    main()
