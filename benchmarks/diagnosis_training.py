"""Learn the weights of the diagnosis from simulated faults, and write them into the package.

    python benchmarks/diagnosis_training.py FOLDER [--faults 900] [--seed 100] [--write]

FOLDER keeps the logs that were drawn and what was seen in them, so that a second call goes on where the
first one was stopped; after a change of what is seen, remove its `*-seen.pkl`.  The seed must be another
than that of `diagnosis.py`.  There is a table of weights for files with both forces, with the command alone
and with the motor's force alone; a file with both is learnt from in all three ways.  Printed: how
often the right cause is the likeliest, and what a threshold costs, by five-fold cross-validation.
"""

from __future__ import annotations

import argparse
import pickle
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagnosis import kept
from scipy.optimize import minimize
from shaken import CAUSES
from shaken_logs import Logged

from zwidth.data.diagnosis import causes, evidence, recording, vibration

PENALTY = 0.3
FOLDS = 5
FURTHEST = 4.0


def main() -> None:
    """Draw, look, learn."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--faults", type=int, default=900)
    parser.add_argument("--seed", type=int, default=100)
    parser.add_argument("--write", action="store_true", help="into the package, not only printed")
    given = parser.parse_args()
    given.folder.mkdir(exist_ok=True, parents=True)
    looked = [seen for k in range(given.faults) for seen in _looked(given.folder, given.seed, k)]
    lines = [
        f"# Learnt by benchmarks/diagnosis_training.py from {given.faults} simulated faults "
        f"of seed {given.seed}",
        ",".join(["recorded", "feature", "middle", "spread", *CAUSES]),
    ]
    for kind in ("both", "command", "motor"):
        own = [(cause, numbers) for recorded, cause, numbers in looked if recorded == kind]
        print(f"{kind}:", end=" ")
        lines += [f"{kind},{line}" for line in _learnt(own)]
    if given.write:
        Path(evidence.__file__).with_name("weights.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _learnt(looked: list[tuple[str, dict[str, float]]]) -> list[str]:
    """Lines of the table of one kind of file."""
    names = tuple(sorted({name for _, numbers in looked for name in numbers}))
    table = np.array([causes.vector(numbers, names) for _, numbers in looked])
    truth = np.array([CAUSES.index(cause) for cause, _ in looked])
    middle, spread = np.nanmean(table, axis=0), np.nanstd(table, axis=0) + 1e-9
    z = np.clip(np.nan_to_num((table - middle) / spread), -FURTHEST, FURTHEST)
    z = np.column_stack([np.ones(len(table)), z])
    _cross_validate(z, truth)
    weights = learn(z, truth)
    rows = [("constant", 0.0, 1.0), *zip(names, middle, spread, strict=True)]
    return [
        ",".join([name, f"{m:.6g}", f"{s:.6g}", *(f"{w:.4f}" for w in row)])
        for (name, m, s), row in zip(rows, weights, strict=True)
    ]


def _looked(folder: Path, seed: int, k: int) -> Iterator[tuple[str, str, dict[str, float]]]:
    """What is recorded, the cause, the features: of the file as it is, and without either of two forces."""
    file = folder / f"{k}-seen.pkl"
    if not file.exists():
        thing, logged = kept(folder, seed, k)
        file.write_bytes(pickle.dumps([(*seen, thing.cause) for seen in look(logged)]))
    for recorded, numbers, cause in pickle.loads(file.read_bytes()):
        yield recorded, cause, numbers


def look(logged: Logged) -> Iterator[tuple[str, dict[str, float]]]:
    """The features of a log; none where it does not vibrate."""
    read = recording.read(logged.path)
    shaking = vibration.find(read.position, read.period)
    if shaking is None:
        return
    files = [read]
    if read.commanded is not None and read.applied is not None:
        files += [replace(read, applied=None), replace(read, commanded=None)]
    for one in files:
        seen = evidence.gather(one, shaking, logged.device)
        yield seen.recorded, causes.features(seen)


def learn(z: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Weights of the multinomial logistic law, a ridge on all but the constants."""
    size = (z.shape[1], len(CAUSES))

    def loss(flat: np.ndarray) -> tuple[float, np.ndarray]:
        w = flat.reshape(size)
        scores = z @ w
        top = scores.max(axis=1, keepdims=True)
        whole = top[:, 0] + np.log(np.exp(scores - top).sum(axis=1))
        p = np.exp(scores - whole[:, None])
        p[np.arange(truth.size), truth] -= 1
        slope = z.T @ p
        slope[1:] += 2 * PENALTY * w[1:]
        value = (whole - scores[np.arange(truth.size), truth]).sum() + PENALTY * (w[1:] ** 2).sum()
        return float(value), slope.ravel()

    found = minimize(loss, np.zeros(size).ravel(), jac=True, method="L-BFGS-B", options={"maxiter": 1000})
    return np.asarray(found.x).reshape(size)


def _cross_validate(z: np.ndarray, truth: np.ndarray) -> None:
    p = np.zeros((truth.size, len(CAUSES)))
    for fold in range(FOLDS):
        held = np.arange(truth.size) // len(CAUSES) % FOLDS == fold
        scores = z[held] @ learn(z[~held], truth[~held])
        odds = np.exp(scores - scores.max(axis=1, keepdims=True))
        p[held] = odds / odds.sum(axis=1, keepdims=True)
    likeliest, most = p.argmax(axis=1), p.max(axis=1)
    print(f"{truth.size} faults; the likeliest is right in {100 * (likeliest == truth).mean():.1f} %")
    for least in (0.4, 0.5, 0.6, 0.7, 0.8):
        named = most >= least
        right = (named & (likeliest == truth)).mean()
        print(f"  p ≥ {least}: right {100 * right:.1f} %, wrong {100 * (named.mean() - right):.1f} %")
    for low in np.arange(0.3, 1.0, 0.1):
        inside = (most >= low) & (most < low + 0.1)
        if inside.any():
            good = 100 * (likeliest == truth)[inside].mean()
            print(f"  p of {low:.1f} to {low + 0.1:.1f}: {inside.sum()}, right {good:.0f} %")


if __name__ == "__main__":
    main()
