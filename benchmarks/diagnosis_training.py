"""Learn the weights of the diagnosis from simulated faults, and write them into the package.

    python benchmarks/diagnosis_training.py FOLDER [--faults 900] [--seed 100] [--write]

FOLDER keeps the logs that were drawn, so that a second call goes on where the first one was stopped.  The
seed must be another than that of `diagnosis.py`.  Printed: how often the right cause is the likeliest, and
what a threshold costs, by five-fold cross-validation.
"""

from __future__ import annotations

import argparse
import pickle
from pathlib import Path

import numpy as np
from scipy.optimize import minimize
from shaken import CAUSES, Logged, draw, write_log

from zwidth.diagnosis import evidence, features, recording, vibration

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
    looked = [
        found for k in range(given.faults) if (found := _looked(given.folder, given.seed, k)) is not None
    ]
    names = tuple(sorted({name for _, numbers in looked for name in numbers}))
    table = np.array([features.vector(numbers, names) for _, numbers in looked])
    truth = np.array([CAUSES.index(cause) for cause, _ in looked])
    middle, spread = table.mean(axis=0), table.std(axis=0) + 1e-9
    z = np.column_stack([np.ones(len(table)), np.clip((table - middle) / spread, -FURTHEST, FURTHEST)])
    _cross_validate(z, truth)
    weights = learn(z, truth)
    text = "\n".join(_lines(names, middle, spread, weights, len(looked), given.seed)) + "\n"
    if given.write:
        Path(evidence.__file__).with_name("weights.csv").write_text(text, encoding="utf-8")


def _looked(folder: Path, seed: int, k: int) -> tuple[str, dict[str, float]] | None:
    kept = folder / f"{k}.pkl"
    if kept.exists():
        thing, logged = pickle.loads(kept.read_bytes())
    else:
        rng = np.random.default_rng([seed, k])
        thing, made = draw(rng, CAUSES[k % len(CAUSES)])
        logged = write_log(rng, thing, made, folder / f"{k}.csv")
        kept.write_bytes(pickle.dumps((thing, logged)))
    numbers = look(logged)
    return None if numbers is None else (thing.cause, numbers)


def look(logged: Logged) -> dict[str, float] | None:
    """The features of a log; None where it does not vibrate."""
    read = recording.read(logged.path)
    shaking = vibration.find(read.time, read.position, read.period)
    return None if shaking is None else features.features(evidence.gather(read, shaking, logged.device))


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


def _lines(names, middle, spread, weights, count, seed):  # type: ignore[no-untyped-def]
    yield f"# Learnt by benchmarks/diagnosis_training.py from {count} simulated faults of seed {seed}"
    yield ",".join(["feature", "middle", "spread", *CAUSES])
    yield ",".join(["constant", "0", "1", *(f"{w:.4f}" for w in weights[0])])
    for k, name in enumerate(names):
        yield ",".join([name, f"{middle[k]:.6g}", f"{spread[k]:.6g}", *(f"{w:.4f}" for w in weights[k + 1])])


if __name__ == "__main__":
    main()
