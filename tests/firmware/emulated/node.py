"""A law as a JavaScript module, run by node: `init(counts)` gives a state, `step(state, counts)` a force."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from firmware.emulated.answers import as_counts
from firmware.emulated.built import called
from numpy.typing import NDArray

HERE = Path(__file__).parent


def run(module: str, counts: object, start: int = 0) -> NDArray[np.float64]:
    given = as_counts(counts)
    with TemporaryDirectory(prefix="zwidth-node-") as name:
        law, source, answer = (Path(name) / file for file in ("law.mjs", "counts", "forces"))
        law.write_text(module, encoding="utf-8")
        np.append(np.int32(start), given).tofile(source)
        called(["node", str(HERE / "node_main.mjs"), str(law), str(source), str(answer)])
        return np.fromfile(answer, np.float64)
