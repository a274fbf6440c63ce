"""Every Python block of the docs runs, one after the other down its page; what cannot is named below."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from pages import NAMES, read

import zwidth as zw

RECORDING = "it reads a recording of one's own"
HARDWARE = "it opens a device, or waits for somebody"
ELSEWHERE = "a test of that page runs it"


def _all(pages: str, reason: str) -> dict[str, str]:
    return {f"docs/{page}.md": reason for page in pages.split()}


NOT_RUN = {
    "README.md": ELSEWHERE,
    **_all("gain-files limit links quickstart scenes theory/certificates tissue", ELSEWHERE),
    **_all("identification logs recording", RECORDING),
    **_all("explore firmware", HARDWARE),
    "docs/serve.md 1": "two seconds of real time, in which a busy machine may be late",
    "docs/serve.md 2": "it measures for seconds; tests/servo runs such",
    "docs/arms.md 2": "it reads a robot description of one's own",
    "docs/json.md 1": "it reads documents that were written before",
    "docs/json.md 2": ELSEWHERE,
}
"""Pages, or the n-th block of one, and why they are not run: their syntax is read all the same."""

BLOCK = re.compile(r"^```python\n(.*?)^```", re.M | re.S)


@cache
def _given() -> dict[str, Any]:
    paddle, wall = zw.catalogue.device("haptic-paddle"), zw.Wall(100, 0.02)
    finger = zw.simulate(paddle, wall, zw.operators.Finger(), 0.2)
    dowel = zw.simulate(paddle, wall, zw.operators.Dowel(), 0.2)
    motion = {"torques": [1.0], "positions": [0.0, 0.1], "energies": [0.0, 0.1]}
    known = {"zw": zw, "device": paddle, "paddle": paddle, "wall": wall, "trace": finger, "T": 0.001}
    return {**known, **motion, "finger": finger, "dowel": dowel, "damping": 0.15}


CASES = [name for name in NAMES if BLOCK.search(read(name))]


@pytest.mark.parametrize("page", CASES)
def test_the_blocks_of_a_page(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page", **({} if page in NOT_RUN else _given())}
    for number, block in enumerate(BLOCK.findall(read(page)), 1):
        code = compile(block, f"{page}, block {number}", "exec")
        if page not in NOT_RUN and f"{page} {number}" not in NOT_RUN:
            exec(code, names)


def test_what_is_not_run_is_there() -> None:
    """A page that has gone, or has fewer blocks, needs no excuse."""
    blocks = {f"{name} {n + 1}" for name in CASES for n in range(len(BLOCK.findall(read(name))))}
    assert set(NOT_RUN) <= {*CASES, *blocks}
