"""How long `verify` takes over documents of every kind, beside the time to prove them.

Each maker of documents is run once so that everything is loaded, and then timed: from one
document to the next is the time to prove, the prover's own check with it.  Documents that are written down
without a search, as those of some arms, have none.  Verifying is timed five times, and the shortest counts.
Processor time.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from statistics import median
from time import process_time

from documents.seeds import MAKERS

import zwidth as zw
from zwidth.model.arms import BUILT_IN, built_in
from zwidth.quantity.text import to_json

TIMES = 5
WRITTEN_DOWN = ("arm",)
"""Kinds whose makers search for nothing."""


def made() -> Iterator[tuple[float, dict]]:
    """Documents, and how long each took to prove [s]."""
    for maker in MAKERS.values():
        list(maker())
        begun = process_time()
        for document in maker():
            yield process_time() - begun, json.loads(to_json(document))
            begun = process_time()
    for name in BUILT_IN:
        arm = built_in(name, damping=0.003, resolution=0)
        limit = zw.workspace(arm, zw.Wall(100), rate=1000, points=30).largest_stiffness
        begun = process_time()
        found = zw.workspace(arm, zw.Wall(0.9 * limit), rate=1000, points=30)
        taken = process_time() - begun
        if found.certificate is not None:
            yield taken, json.loads(to_json(found.certificate.documents[0]))


def verified(document: dict) -> float:
    """The shortest time that it takes [s]."""
    times = []
    for _ in range(TIMES):
        begun = process_time()
        found = zw.verify(document)
        times.append(process_time() - begun)
    assert found.valid, (document["kind"], found.reason)
    return min(times)


def main() -> None:
    """Measure and print."""
    proving: dict[str, list[float]] = {}
    verifying: dict[str, list[float]] = {}
    for taken, document in made():
        kind = document["kind"]
        written = kind in WRITTEN_DOWN and taken < 1e-3
        proving.setdefault(kind, []).extend([] if written else [taken])
        verifying.setdefault(kind, []).append(verified(document))
    print("| kind | documents | verify, median | worst | prove, median | worst | prove/verify |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for kind in sorted(verifying, key=lambda k: median(verifying[k])):
        checked, proved = verifying[kind], proving[kind] or [float("nan")]
        ratio = median(proved) / median(checked)
        numbers = (median(checked), max(checked), median(proved), max(proved))
        cells = " | ".join(f"{1000 * t:.3g} ms" for t in numbers)
        print(f"| `{kind}` | {len(checked)} | {cells} | {ratio:.0f} |")


if __name__ == "__main__":
    main()
