"""Documents that are nearly valid: changed, grafted, written from nothing, and ill-formed.

Each is written from one seed and can be written again from it alone.
"""

from __future__ import annotations

import base64
import copy
import json
import zlib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from random import Random
from typing import Any, NamedTuple

import numpy as np

from zwidth.checker.kinds import KINDS as CHECKED

from .fresh import KINDS, family, fresh

Document = dict[str, Any]
Path = tuple[Any, ...]

_SHARES = {
    "spring": 7, "linear": 7, "quantized": 7, "delays": 4, "contact": 7, "relaxing contact": 6,
    "multiplier contact": 3, "nonlinear spring": 6, "endless pull": 4, "slow hands": 5, "force bounding": 4,
    "active hand": 5, "violation": 8, "motion": 5, "touching motion": 3, "contact motion": 3, "row motion": 3,
    "storage": 0.6, "coarse storage": 0.4, "row storage": 0.6, "stability": 0.6, "instability": 0.8,
    "absolute stability": 0.6, "vibration": 4, "arm": 0.5, "positive real": 6, "positive real matrix": 3,
    "extraction": 5, "matrix extraction": 4, "corners": 3,
}  # fmt: skip
SHARES = _SHARES | {kind: 1.0 for kind in CHECKED if kind not in _SHARES}
"""How often each kind is written, rare where a check or a judge takes long."""

ILL_FORMED, FROM_NOTHING, ROTARY = 0.12, 0.4, 0.1
"""Parts of all; the second of kinds that there is a way to write from nothing."""

FLIPS = {
    True: False, False: True, "open loop": "closed loop", "closed loop": "open loop",
    "position": "penetration", "penetration": "none", "none": "position", "input": "output",
    "output": "input",
    "continuous": "discrete", "discrete": "continuous", "ideal": "counted", "counted": "ideal",
    "held": "follows the arm", "follows the arm": "held", "follows the readings": "held",
    "monotone": "odd monotone", "odd monotone": "monotone", "revolute": "prismatic",
    "given": "every orientation", "every orientation": "given", "criterion": "negative static stiffness",
    "negative static stiffness": "unstable environment", "spring": "contact", "contact": "spring",
    "stability": "instability", "instability": "stability", "positive real": "extraction",
    "linear": "quantized", "quantized": "linear", "nonlinear spring": "endless pull",
}  # fmt: skip

STRONGER = {
    "damping": -1, "coulomb_friction": -1, "stiffness": 1, "numerator": 1, "delay": 1, "resolution": 1,
    "largest_speed": 1, "largest_move": 1, "highest_count": 1, "energy": 1, "times": -1, "force_limit": 1,
    "slope": 1, "level": 1, "activity": 1, "below": 1, "largest_force": 1, "high_": 1, "low_": -1,
    "sample_period": 1, "taps": 1, "points": 1, "credit": 1, "mass": 1, "gap": -1, "curvature": -1,
    "out": 1, "up": 1,
}  # fmt: skip
"""The way in which an entry moves for the claim to say more."""


class Written(NamedTuple):
    """A document, how it was made, and whether no checker may accept it, whatever its numbers are."""

    kind: str
    document: Any
    how: str
    ill_formed: bool


class Valid(NamedTuple):
    """Valid documents of a kind as text, from which each is read anew, and the share of each."""

    texts: list[str]
    shares: list[float]

    def one(self, rng: Random) -> Document:
        """Any of them, to be changed."""
        document: Document = json.loads(rng.choices(self.texts, self.shares)[0])
        return document


def ready(documents: Mapping[str, list[Document]]) -> dict[str, Valid]:
    """Valid documents, so that they can be drawn."""
    texts = {kind: [json.dumps(one) for one in some] for kind, some in documents.items()}
    return {kind: Valid(some, [1 / (300 + len(text)) for text in some]) for kind, some in texts.items()}


def write(seed: int, seeds: Mapping[str, Valid], only: str | None = None) -> Written:
    """The document of a seed, of one kind `only` if told; `seeds` are valid documents by their kind."""
    rng = Random(seed)
    kind = only or rng.choices(list(SHARES), list(SHARES.values()))[0]
    if kind == "corners":
        return _corners(rng, seeds)
    if kind in KINDS and rng.random() < FROM_NOTHING:
        document, how = fresh(kind, rng), "from nothing"
    else:
        document, how = seeds[kind].one(rng), "a seed"
        for _ in range(rng.choices((1, 2, 3), (6, 3, 1))[0]):
            how = f"{how}, {_changed(rng, document, seeds[kind])}"
    if kind not in ("arm", "null space") and rng.random() < ROTARY:
        document, how = turned(document), f"{how}, rotary"
    if rng.random() < ILL_FORMED:
        words = _spoilt(rng, document)
        return Written(kind, document, f"{how}, {words}", bool(words))
    return Written(kind, document, how, False)


_ROTARY = {
    "N_s_per_m": "N_m_s_per_rad", "N_per_m": "N_m_per_rad", "N_N_s_per_m": "N_m_N_m_s_per_rad", "kg": "kg_m2",
    "m_per_s_N": "rad_per_s_N_m", "m_per_s": "rad_per_s", "per_m": "per_rad", "m_N": "rad_N_m", "m": "rad",
    "N": "N_m",
}  # fmt: skip
"""Units that metres and newtons become of a wheel, the longer ones first."""


def turned(value: Any) -> Any:
    """The same document of a wheel: every unit another one."""
    if isinstance(value, dict):
        return {_of_a_wheel(key): turned(inner) for key, inner in value.items()}
    return [turned(inner) for inner in value] if isinstance(value, list) else value


def _of_a_wheel(key: str) -> str:
    for unit, other in _ROTARY.items():
        if key.endswith(f"_{unit}"):
            return f"{key.removesuffix(unit)}{other}"
    return key


def _corners(rng: Random, seeds: Mapping[str, Valid]) -> Written:
    """Any proofs, or proofs around one device, of which one may be of another; or one of them twice."""
    if rng.random() < 0.5:
        parts, how = family(rng), "corners around one device"
        if rng.random() < 0.4:
            part = rng.choice(parts)
            how = f"{how}, {_otherwise(rng, part)}"
    else:
        parts, how = [_any_corner(rng, seeds) for _ in range(rng.randint(1, 3))], "several corners"
    twice = rng.random() < 0.15
    if twice:
        parts.insert(rng.randint(0, len(parts)), _in_other_words(rng, rng.choice(parts)))
    if rng.random() < ROTARY:
        parts, how = turned(parts), f"{how}, rotary"
    document: Document = {"kind": "corners", "corners": parts}
    if rng.random() < ILL_FORMED:
        words = _spoilt(rng, document)
        return Written("corners", document, f"{how}, {words}", twice or bool(words))
    return Written("corners", document, f"{how}, the same corner twice" if twice else how, twice)


def _any_corner(rng: Random, seeds: Mapping[str, Valid]) -> Document:
    kind = rng.choice(("spring", "linear", "contact", "violation", "quantized", "instability"))
    part = seeds[kind].one(rng)
    if rng.random() < 0.5:
        _changed(rng, part, seeds[kind])
    return part


def _otherwise(rng: Random, corner: Document) -> str:
    """Another device, law or unit of force of one corner: mixes are of one device alone."""
    loop = corner["loop"]
    key = rng.choice([k for k in loop if k != "denominator"] + ["denominator"] * 3)
    if key == "unilateral":
        loop[key] = not loop[key]
    elif key in ("numerator", "denominator"):
        factor = rng.choice((Fraction(2), Fraction(-1), near_one(rng)))
        for side in ("numerator", "denominator") if rng.random() < 0.7 else (key,):
            loop[side] = [str(factor * Fraction(c)) for c in loop[side]]
    else:
        loop[key] = str(Fraction(loop[key]) * rng.choice((1, 2, 1 + abs(near_one(rng) - 1), near_one(rng))))
    return f"{key} of another"


def _in_other_words(rng: Random, corner: Document) -> Document:
    """The same, its numbers written as other fractions."""
    same: Document = json.loads(json.dumps(corner))
    if rng.random() < 0.5:
        for path, value in leaves(same):
            if isinstance(value, str) and is_number(value):
                exact = Fraction(value)
                _inner(same, path[:-1])[path[-1]] = f"{3 * exact.numerator}/{3 * exact.denominator}"
    return same


def leaves(value: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every entry that is no object and no list, with the way to it."""
    if isinstance(value, (dict, list)):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inner in items:
            yield from leaves(inner, (*path, key))
    else:
        yield path, value


def _inner(document: Any, path: Path) -> Any:
    for key in path:
        document = document[key]
    return document


@lru_cache(maxsize=100_000, typed=True)
def is_number(value: Any) -> bool:
    """A number as documents write it."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return False
    try:
        Fraction(str(value))
    except (ValueError, ZeroDivisionError):
        return False
    return True


def _changed(rng: Random, document: Document, others: Valid) -> str:
    """Change one thing in place; in words."""
    packed = [
        path for path, v in leaves(document) if isinstance(v, str) and len(v) > 30 and path[-1] != "format"
    ]
    if packed and rng.random() < 0.35:
        return _repacked(rng, document, rng.choice(packed))
    changes = (_nudged, _strengthened, _listed, _flipped, _grafted, _retyped)
    return rng.choices(changes, (8, 9, 3, 2, 3, 1))[0](rng, document, others)


def _numbers(document: Document) -> list[Path]:
    return [path for path, value in leaves(document) if is_number(value)]


def near_one(rng: Random) -> Fraction:
    """1 ± ε, of any size."""
    return 1 + rng.choice((-1, 1)) * Fraction(
        rng.randint(1, 99), 10 ** rng.choice((2, 3, 3, 5, 8, 11, 14, 17))
    )


def _nudged(rng: Random, document: Document, others: Valid) -> str:
    paths = _numbers(document)
    if not paths:
        return "nothing"
    path = rng.choice(paths)
    inner, key = _inner(document, path[:-1]), path[-1]
    old = Fraction(str(inner[key]))
    kind = rng.choices(("near", "sign", "zero", "other", "scale", "exact", "whole"), (12, 2, 2, 3, 3, 2, 3))[
        0
    ]
    if kind == "other":
        old = Fraction(str(_inner(document, rng.choice(paths))))
    new = {
        "near": old * near_one(rng), "sign": -old, "zero": Fraction(0), "other": old,
        "scale": old * Fraction(10) ** rng.randint(-9, 9),
        "exact": old + Fraction(rng.randint(-3, 3), rng.choice((3, 7, 997))),
        "whole": old + rng.choice((-1, 1)),
    }[kind]  # fmt: skip
    inner[key] = _as_written(new, inner[key])
    return f"{'.'.join(map(str, path))} {kind}"


def _as_written(value: Fraction, like: Any) -> Any:
    if isinstance(like, int) and value.denominator == 1:
        return int(value)
    return str(value)


def _strengthened(rng: Random, document: Document, others: Valid) -> str:
    """The claim says more, by a little; its proof stays."""
    found = []
    for path in _numbers(document):
        names = [key for key in path if isinstance(key, str)]
        way = next((w for n, w in STRONGER.items() if names and names[-1].startswith(n)), 0)
        if way and "proof" not in names:
            found.append((path, way, names[-1]))
    if not found:
        return _nudged(rng, document, others)
    _, way, name = rng.choice(found)
    by = 1 + way * Fraction(rng.randint(1, 99), 10 ** rng.choice((2, 2, 3, 4, 6, 9, 12, 15)))
    for path, _, other in found:
        if other == name:
            inner = _inner(document, path[:-1])
            old = Fraction(str(inner[path[-1]]))
            changed = old + way if isinstance(inner[path[-1]], int) else old * by
            inner[path[-1]] = _as_written(changed, inner[path[-1]])
    return f"{name} stronger"


def _lists(value: Any) -> Iterator[list[Any]]:
    if isinstance(value, list):
        yield value
    if isinstance(value, (dict, list)):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _lists(inner)


def _listed(rng: Random, document: Document, others: Valid) -> str:
    """Terms taken away, doubled, put in, exchanged."""
    found = list(_lists(document))
    if not found:
        return _nudged(rng, document, others)
    some = rng.choice(found)
    kind = rng.choice(("without", "twice", "exchanged", "none", "turned", "one more"))
    at = rng.randrange(len(some)) if some else 0
    if kind == "without" and some:
        del some[at]
    elif kind == "twice" and some:
        some.insert(at, copy.deepcopy(some[at]))
    elif kind == "exchanged" and some:
        other = rng.randrange(len(some))
        some[at], some[other] = some[other], some[at]
    elif kind == "none":
        some.clear()
    elif kind == "turned":
        some.reverse()
    else:
        some.append("0")
    return f"a list {kind}"


def _flipped(rng: Random, document: Document, others: Valid) -> str:
    found = [(path, v) for path, v in leaves(document) if isinstance(v, (bool, str)) and v in FLIPS]
    if not found:
        return _nudged(rng, document, others)
    path, value = rng.choice(found)
    _inner(document, path[:-1])[path[-1]] = FLIPS[value]
    return f"{'.'.join(map(str, path))} turned over"


def _grafted(rng: Random, document: Document, others: Valid) -> str:
    """A part of another document of the kind in its place."""
    other = others.one(rng)
    ways = [(key,) for key in document if key not in ("kind", "format")]
    ways += [(k, inner) for (k,) in list(ways) if isinstance(document[k], dict) for inner in document[k]]
    path = rng.choice(ways)
    try:
        part = _inner(other, path)
    except (KeyError, TypeError, IndexError):
        return "nothing"
    _inner(document, path[:-1])[path[-1]] = part
    return f"{'.'.join(path)} of another"


def _retyped(rng: Random, document: Document, others: Valid) -> str:
    """A list or an object is something else."""
    ways = [path for path, _ in _objects(document) if path]
    ways += [path for path, value in _entries(document) if isinstance(value, list)]
    if not ways:
        return _nudged(rng, document, others)
    path = rng.choice(ways)
    _inner(document, path[:-1])[path[-1]] = rng.choice(
        (None, [], {}, "x", 1, True, [[1]], {"kind": "spring"})
    )
    return f"{'.'.join(map(str, path))} of another type"


def _entries(value: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield (*path, key), inner
        yield from _entries(inner, (*path, key))


def _repacked(rng: Random, document: Document, path: Path) -> str:
    """A packed table with a few numbers moved."""
    inner, key = _inner(document, path[:-1]), path[-1]
    try:
        raw = zlib.decompress(base64.b64decode(inner[key]))
    except (ValueError, zlib.error):
        return "nothing"
    values = np.frombuffer(raw, dtype="<f8" if key == "forces" else "<i8").copy()
    size = float(np.abs(values).max()) or 1.0
    kind = rng.choice(("one", "all", "zero", "less"))
    if kind == "all":
        values = (values * float(near_one(rng))).astype(values.dtype)
    elif kind == "zero":
        values[:] = 0
    else:
        for _ in range(rng.choice((1, 1, 3))):
            at = rng.randrange(len(values))
            step = -1 if kind == "less" else rng.choice((-1, 1)) * size * 10.0 ** -rng.randint(0, 9)
            values[at] += step if key == "forces" else int(step) or -1
    inner[key] = base64.b64encode(zlib.compress(values.tobytes())).decode("ascii")
    return f"{key} {kind}"


NO_NUMBERS: tuple[Any, ...] = (
    "٣", "１２", "NaN", "nan", "inf", "-Infinity", " 1", "1 ", "1_000", "0x10", "1/0", "1//2", "", "one",
    "−1", None, True, {}, "1e", "e5", "+", "²", "1,5", "1.5.2", float("inf"), float("nan"), [[[[]]]],
)  # fmt: skip

UNITS = {
    "_N_N_s_per_m": "_N_m_N_m_s_per_rad", "_N_m_N_m_s_per_rad": "_N_N_s_per_m",
    "_m_per_s_N": "_rad_per_s_N_m", "_rad_per_s_N_m": "_m_per_s_N", "_N_m_s_per_rad": "_N_s_per_m",
    "_N_s_per_m": "_N_m_s_per_rad", "_N_m_per_rad": "_N_per_m", "_N_per_m": "_N_m_per_rad",
    "_rad_per_s": "_m_per_s", "_m_per_s": "_rad_per_s", "_rad_N_m": "_m_N", "_m_N": "_rad_N_m",
    "_per_rad": "_per_m", "_per_m": "_per_rad", "_N_m": "_N", "_rad": "_m", "_kg_m2": "_kg", "_kg": "_kg_m2",
    "_N": "_N_m", "_m": "_rad", "_Hz": "_rad_per_s", "_s": "_ms", "_J": "_mJ",
}  # fmt: skip
"""Another unit for each, the longer ones first."""


def _objects(value: Any, path: Path = ()) -> Iterator[tuple[Path, dict[str, Any]]]:
    if isinstance(value, dict):
        yield path, value
    if isinstance(value, (dict, list)):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _objects(inner, (*path, key))


def _spoilt(rng: Random, document: Document) -> str:
    """Against the format, so that it must be refused; "" where nothing was found to spoil."""
    return rng.choices((_no_number, _unread, _other_unit, _deep), (5, 4, 4, 1))[0](rng, document)


def _no_number(rng: Random, document: Document) -> str:
    paths = _numbers(document)
    if not paths:
        return ""
    path, value = rng.choice(paths), rng.choice(NO_NUMBERS)
    _inner(document, path[:-1])[path[-1]] = value
    return f"{'.'.join(map(str, path))} is {value!r}"


def _unread(rng: Random, document: Document) -> str:
    path, table = rng.choice(list(_objects(document)))
    name = rng.choice(("comment", "Kind", "damping2", "note_N", "corners", "proofs", "unilateral_", "kind "))
    if name in table:
        return ""
    table[name] = rng.choice(("1", 1, True, None, [], {"kind": "spring"}, "free text"))
    return f"{name} in {'.'.join(map(str, path)) or 'the document'}"


def _other_unit(rng: Random, document: Document) -> str:
    """One key of a quantity in another unit, or in none, or given twice."""
    found = [
        (table, key, next(unit for unit in UNITS if key.endswith(unit)))
        for _, table in _objects(document)
        for key in table
        if len(table) > 1 and isinstance(key, str) and key.endswith(tuple(UNITS))
    ]
    if not found:
        return ""
    table, key, old = rng.choice(found)
    stem = key.removesuffix(old)
    other = rng.choice((stem + UNITS[old], stem, f"{key}s"))
    value = table[key]
    if rng.random() < 0.6:
        del table[key]
    table[other] = value
    return f"{other} for {key}"


def _deep(rng: Random, document: Document) -> str:
    paths = _numbers(document)
    if not paths:
        return ""
    path = rng.choice(paths)
    value: Any = "1"
    for _ in range(rng.choice((3, 50, 900))):
        value = [value]
    if rng.random() < 0.4:
        value = rng.choice(("1e999999999", "1" * 30_000, "-1e-99999999", 10**6000, "9" * 19_000 + "/7"))
        _inner(document, path[:-1])[path[-1]] = value
        return ""  # a number all the same, and it may be right
    _inner(document, path[:-1])[path[-1]] = value
    return f"{'.'.join(map(str, path))} nested"
