"""Valid documents of every kind, made once by the prover, small ones: what the grammar begins with."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import Any

import control

import zwidth as zw
from zwidth.checker.kinds import KINDS
from zwidth.model import rendering
from zwidth.passivity.storage.hand_bounds import slow_hands
from zwidth.passivity.storage.program import program_of
from zwidth.passivity.storage.storage_function import prove_on_cells
from zwidth.passivity.storage.value_iteration import freely
from zwidth.quantity.text import to_json

Document = dict[str, Any]

LARGEST = 9_000
"""Characters of a document that is kept."""

IDENTITY = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]


def read(path: Path) -> dict[str, list[Document]]:
    """Valid documents by their kind, from a file, which is written first if it is missing."""
    if not path.exists():
        beside = path.with_suffix(".part")
        beside.write_text(json.dumps(with_cases(made(MAKERS))), encoding="utf-8")
        beside.replace(path)
    found: dict[str, list[Document]] = json.loads(path.read_text(encoding="utf-8"))
    return found


def made(names: Iterable[str]) -> dict[str, list[Document]]:
    """What some of the makers make, by its kind."""
    found: dict[str, list[Document]] = {}
    for name in names:
        for document in _small(MAKERS[name]()):
            found.setdefault(document["kind"], []).append(document)
    return found


def with_cases(found: dict[str, list[Document]]) -> dict[str, list[Document]]:
    """Of kinds that no maker makes, the documents that the checker's own cases accept."""
    missing = KINDS.keys() - found.keys()
    if missing:
        sys.path.append(str(Path(__file__).parents[2] / "tests" / "checker"))  # no package
        for case in import_module("cases").all_cases():
            told = None if case.refusal or callable(case.document) else case.document
            if told is not None and told["kind"] in missing:
                found.setdefault(told["kind"], []).extend(_small(iter([told])))
    return found


def default_path() -> Path:
    """Outside the repository; another one whenever this file changes."""
    mark = sha256(Path(__file__).read_bytes()).hexdigest()[:12]
    return Path(tempfile.gettempdir()) / f"zwidth-document-seeds-{mark}.json"


def _small(documents: Iterator[Any]) -> Iterator[Document]:
    for document in documents:
        plain = json.loads(to_json(document))
        if len(json.dumps(plain)) <= LARGEST:
            yield plain


def _device(**numbers: Any) -> zw.Device:
    """Half a millisecond to one, a tenth of a millimetre a count, unless told otherwise."""
    usual = {
        "mass": "0.04",
        "damping": "0.3",
        "coulomb_friction": "0.05",
        "resolution": "0.0001",
        "sample_period": "0.001",
    }
    return zw.Device(**{**usual, **numbers})


def _proof(device: zw.Device, law: Any) -> Iterator[Document]:
    """Every part of a certificate, or what refutes."""
    verdict = zw.check(device, law)
    if verdict.certificate is not None:
        yield from verdict.certificate.documents
    if verdict.violation is not None:
        yield verdict.violation.to_dict()
    if verdict.witness is not None:
        yield verdict.witness.to_dict()


_IDEAL = {"resolution": 0, "coulomb_friction": 0}
_TWO_SIDED = zw.PulseTransferFunction(["180", "-60"], ["1", "-0.4"])


def _springs() -> Iterator[Any]:
    for delay in ("0", "0.001", "0.0013"):
        yield from _proof(_device(delay=delay, damping="0.6"), zw.Wall(200))
    yield from _proof(_device(), zw.PulseTransferFunction([200], [1]))


def _linear() -> Iterator[Any]:
    yield from _proof(_device(**_IDEAL), _TWO_SIDED)
    yield from _proof(_device(**_IDEAL, delay="0.0004"), _TWO_SIDED)
    yield from _proof(_device(**_IDEAL, delay="0.002", damping=1), _TWO_SIDED)
    yield from _proof(_device(**_IDEAL), zw.PulseTransferFunction([40, -30], [1, -1]))


def _quantized() -> Iterator[Any]:
    yield from _proof(_device(), _TWO_SIDED)
    yield from _proof(_device(delay="0.0004", coulomb_friction="0.2"), zw.Wall(100, "0.05"))
    slow = zw.PulseTransferFunction(["150", "-148"], ["1", "-0.99"])
    yield from _proof(_device(coulomb_friction="0.1", damping=5), slow)


def _delays() -> Iterator[Any]:
    for more in (_IDEAL, {}):
        device = _device(**more, damping=1, delay=zw.Interval("0.0002", "0.0014"))
        yield from _proof(device, _TWO_SIDED)


def _contact() -> Iterator[Any]:
    device = _device(coulomb_friction="0.2")
    yield from _proof(device, zw.Wall(100, "0.05"))
    yield from _proof(device, zw.Wall(100, "0.05", zw.rendering.Window(3)))
    yield from _proof(_device(coulomb_friction="0.2", delay="0.001", damping="0.5"), zw.Wall(100, "0.05"))
    yield from _proof(device, zw.Wall(50, "0.05", zw.rendering.OnePole("0.0004")))


def _relaxing() -> Iterator[Any]:
    for clamped in (False, True):
        yield from _proof(_device(), zw.StandardLinearSolid(100, 50, "0.01", clamped=clamped))


def _multiplier() -> Iterator[Any]:
    for more in ({}, _IDEAL, {"delay": "0.002"}):
        device = _device(**{"coulomb_friction": "0.2", **more})
        yield from _proof(device.replace(damping="0.1"), zw.Wall(10, "0.3", zw.rendering.OnePole("0.01")))


def _nonlinear() -> Iterator[Any]:
    yield from _proof(_device(), zw.NonlinearSpring([-1, 0, "0.5"], [-100, 0, "20"]))
    yield from _proof(_device(delay="0.001"), zw.NonlinearSpring(["-0.1", 0, "0.5"], [-10, 0, "40"]))


def _pull() -> Iterator[Any]:
    yield from _proof(_device(), zw.NonlinearSpring([-1, 0, "0.5"], [1, 0, "20"]))


def _slow() -> Iterator[Any]:
    for law, delay in ((zw.Wall(900), 0), (zw.Wall(400, "0.02"), 0), (zw.Wall(300), "0.0003")):
        found = slow_hands(_device(resolution="0.00001", delay=delay), law, Fraction(1, 5))
        yield from found.documents if found else ()


def _bounding() -> Iterator[Any]:
    law = zw.render(zw.Wall(5000), rendering.ForceBounding())
    yield from zw.formulas.check_bounding(_device(), law).certificate.documents
    yield from zw.formulas.check_bounding(_device(force_resolution="0.01"), law).certificate.documents


def _active_hand() -> Iterator[Any]:
    for wall in (zw.Wall(100, "0.05"), zw.Wall(20, "0.12"), zw.Wall(300)):
        found = zw.stability.tolerated_activity(
            _device(damping="0.15", coulomb_friction="0.12", resolution="2e-5"), wall
        )
        plain = found.to_dict()
        yield from (plain[key]["certificate"] for key in ("contact_kept", "contact_broken"))


def _violations() -> Iterator[Any]:
    weak = _device(damping="0.01")
    yield from _proof(weak, _TWO_SIDED)
    yield from _proof(weak.replace(delay="0.0004"), _TWO_SIDED)
    yield from _proof(weak.replace(**_IDEAL), zw.PulseTransferFunction([-3], [1]))
    yield from _proof(_device(damping=9), zw.PulseTransferFunction([3, 1], [1, "-1.1"]))
    yield from _proof(_device(damping=9, delay="0.0004"), zw.PulseTransferFunction([3, 1], [1, "-1.1"]))


def _motions() -> Iterator[Any]:
    yield from _proof(_device(), zw.Wall(2000))
    yield from _proof(_device(**_IDEAL), zw.Wall(2000))
    yield from _proof(_device(delay="0.0013"), zw.Wall(2000))
    yield from _proof(_device(coulomb_friction="0.001"), zw.Wall(200))
    yield from _proof(_device(coulomb_friction="0.001"), zw.PulseTransferFunction([200], [1]))


def _touching() -> Iterator[Any]:
    yield from _proof(_device(**_IDEAL, damping="0.04"), zw.Wall(10, "0.3", zw.rendering.OnePole("0.01")))
    clamped = zw.Wall(10, "0.3", zw.rendering.OnePole("0.01"), clamped=True)
    yield from _proof(_device(**_IDEAL, damping="0.03", delay="0.0004"), clamped)


_BOUNDS = {"penetration": "0.0006", "speed": "0.3"}


def _game(device: zw.Device, law: Any, **more: Any) -> Iterator[Any]:
    found = zw.available_storage(device, law, **{**_BOUNDS, **more})
    for part in (found.certificate, found.witness):
        if part is not None:
            yield from part.documents if hasattr(part, "documents") else (part.to_dict(),)


def _storage() -> Iterator[Any]:
    yield from _game(_device(), zw.Wall(300))


def _more_storage() -> Iterator[Any]:
    yield from _game(_device(damping="0.26"), zw.Wall(200, "0.05", clamped=True))
    yield from _game(_device(), _TWO_SIDED.replace(numerator=["180"], denominator=["1"]))
    yield from _game(_device(damping="0.5", delay="0.001"), zw.Wall(200))
    yield from _game(_device(damping="0.5", delay="0.0004"), zw.Wall(200))
    yield from _game(_device(), zw.StandardLinearSolid(100, 50, "0.01"), penetration="0.0003")
    points = zw.NonlinearSpring(["-4e-4", "-2e-4", 0, "2e-4", "4e-4"], [0, "-0.05", 0, "0.05", 0])
    yield from _game(_device(damping="0.2"), points)
    stepped = _device(damping="0.5", force_resolution="0.04", force_limit="0.2")
    yield from _game(stepped, zw.Wall(300), force_limit=True, force_resolution=True)
    yield from _game(_device(damping="0.9", coulomb_friction="0.08"), zw.HuntCrossley(20000, "1.5", 2))
    curve = zw.FrictionCurve([0, "0.02", "0.1", "0.3"], ["0.09", "0.04", "0.026", "0.05"])
    yield from _game(_device(), zw.Wall(200), friction=curve)


def _contact_motions() -> Iterator[Any]:
    yield from _game(_device(), zw.Wall(900))
    yield from _game(_device(damping="0.1"), zw.Wall(300, "0.1"))
    yield from _game(_device(delay="0.0004"), zw.Wall(900))
    yield from _game(_device(damping="0.05"), zw.StandardLinearSolid(300, 300, "0.01"))


def _rows() -> Iterator[Any]:
    free = rendering.Extrapolation()
    bounds = {"penetration": "0.0004", "speed": "0.2"}
    for stiffness in (150, 900):
        yield from _game(_device(), zw.render(zw.Wall(stiffness), free), **bounds)
    yield from _game(_device(), zw.render(zw.Wall(3000), rendering.Saturation("0.02")), **bounds)


def _coarse() -> Iterator[Any]:
    device = _device(resolution="0.000001", damping="0.4")
    for law, delay in ((zw.Wall(100), 0), (zw.Wall(100), "0.0003"), (zw.Wall(50, "0.02"), 0)):
        game = program_of(device.replace(delay=delay), law, penetration="0.0005", speed="0.1")
        found = prove_on_cells(game.law, game.losses, game.domain, "linear", 2, freely(), None)
        yield from found.documents if found else ()


def _known_hands() -> Iterator[Any]:
    hand = zw.stability.HandImpedance(mass=(0, "0.02"), stiffness=(0, 1000), damping=(0, 3))
    for wall, operator in (
        (zw.Wall(1000, 1), hand),
        (zw.Wall(3000, 1), zw.operators.Finger()),
        (zw.Wall(90_000, 1), zw.operators.Finger()),
        (zw.Wall(1000, 1), zw.stability.HandImpedance(mass=0, stiffness=0, damping=0)),
    ):
        for delay in ("0", "0.0005"):
            found = zw.stability.coupled_stability(_device(delay=delay, **_IDEAL), wall, operator)
            if found.certificate is not None:
                yield from found.certificate.documents


def _absolute() -> Iterator[Any]:
    hand = zw.operators.LinearHand(stiffness=400, mass="0.001")
    plants = [(_device(damping="0.8", delay=delay, **_IDEAL), hand) for delay in ("0", "0.0005")]
    six = zw.PulseTransferFunction([2, "0.92"], [1, "-0.5", 0])
    for plant in (*plants, (six,)):
        found = zw.stability.absolute_stability(*plant, reach=2, motions=len(plant) == 1)
        yield from (row.certificate.documents[0] for row in found.proved if row.certificate is not None)
        for motion in (found.pressing, found.resting):
            yield from motion.certificate.documents if motion is not None else ()
    yield {
        "kind": "vibration",
        "plant": {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]},
        "slope": "0.92",
        "gap": "-1",
        "inside": [True, False, False],
    }


def _ports() -> Iterator[Any]:
    for sides in (([1, 3], [1, 2]), ([1, 0.25, 1], [1, 1, 1]), ([1, 0.5], [1, -0.5], 1)):
        yield from _indices(zw.ports.passivity_indices(control.tf(*sides)))


def _matrix_ports() -> Iterator[Any]:
    for dt in (0, 1):
        lag, cross = ([1, 3], [1, 2]), ([0.5], [1, 2])
        if dt:
            lag, cross = ([1, 0.5], [1, -0.5]), ([0.25], [1, -0.5])
        rows = [[lag, cross], [([0], [1]), lag]]
        sides = ([[entry[k] for entry in row] for row in rows] for k in (0, 1))
        yield from _indices(zw.ports.passivity_indices(control.tf(*sides, dt)))


def _indices(found: Any) -> Iterator[Any]:
    for index in (found.input, found.output):
        if index.exact is None and index.bounds is None:
            continue
        level = index.exact if index.exact is not None else index.bounds[0]
        yield from index.certificate(level).documents
        yield from index.certificate(level - Fraction(1, 8)).documents
        motion = index.refute(level + Fraction(1, 8))
        if motion is not None:
            yield motion.to_dict()


_FOLLOWS = {"sample_period_s": "0.001", "delay_samples": 0, "encoder": "ideal", "torque": "follows the arm"}


def _matrix(rows: list[list[float]]) -> list[list[str]]:
    return [[repr(x) for x in row] for row in rows]


def _wall(
    rows: list[list[float]], units: tuple[str, str, str] = ("N_per_m", "N_s_per_m", "N_s_per_m")
) -> Any:
    none = _matrix([[0.0] * len(rows) for _ in rows])
    names = ("stiffness", "virtual_damping", "damping_bound")
    return {f"{n}_{u}": m for n, u, m in zip(names, units, (_matrix(rows), none, none), strict=True)}


def _joint(x: str, low: str, high: str, damping: str, **more: str) -> Document:
    return {
        "kind": "revolute",
        "rotation": IDENTITY,
        "translation_m": [x, "0", "0"],
        "low_rad": low,
        "high_rad": high,
        "damping_N_m_s_per_rad": damping,
        **more,
    }


def _chain(*joints: Document) -> Document:
    return {"geometry": "chain", "joints": list(joints), "end_m": ["0.09", "0", "0"]}


def _arms() -> Iterator[Any]:
    planar = _chain(_joint("0", "0", "0.5", "0.02"), _joint("0.1", "1", "1.5", "0.013"))
    wall = _wall([[600.0, 30.0], [30.0, 500.0]])
    yield _arm(planar, wall, _FOLLOWS)
    damped = {**wall, "virtual_damping_N_s_per_m": _matrix([[0.05, 0.0], [0.0, -0.05]])}
    yield _arm(planar, {**damped, "damping_bound_N_s_per_m": _matrix([[0.05, 0.0], [0.0, 0.05]])}, _FOLLOWS)
    held = {**_FOLLOWS, "torque": "held", "largest_force_N": "2", "curvature_m_per_rad2": "0.26"}
    yield _arm(planar, wall, held)
    yield _counted_arm(wall)
    yield _slider(wall)
    for stiffness in (500.0, 735.0):
        yield _arm(_pantograph(), _wall([[stiffness, 0.0], [0.0, stiffness]]), _FOLLOWS)
    yield from _in_pose()


def _arm(machine: Document, wall: Document, loop: Document) -> Document:
    return {"kind": "arm", "arm": machine, "wall": wall, "loop": loop}


def _counted_arm(wall: Document) -> Document:
    steps = {"resolution_rad": "0.0005", "coulomb_friction_N_m": "0.02", "largest_column_m_per_rad": "0.2"}
    first = _joint("0", "0", "0.5", "0.02", **steps)
    second = _joint("0.1", "1", "1.5", "0.013", **{**steps, "largest_column_m_per_rad": "0.1"})
    loop = {**_FOLLOWS, "encoder": "counted", "torque": "follows the readings", "largest_force_N": "4"}
    return _arm(_chain(first, second), wall, loop)


def _slider(wall: Document) -> Document:
    slide = {
        "kind": "prismatic",
        "rotation": [["0", "0", "1"], ["0", "1", "0"], ["-1", "0", "0"]],
        "translation_m": ["0.05", "0", "0"],
        "low_m": "0",
        "high_m": "0.1",
        "damping_N_s_per_m": "2",
    }
    return _arm(_chain(_joint("0", "0", "0.5", "0.02"), slide), wall, _FOLLOWS)


def _pantograph() -> Document:
    legs = [
        {
            "base_m": [x, "0"],
            "out": ["1", "0"],
            "up": ["0", "1"],
            "link_m": "0.07",
            "rod_m": "0.09",
            "offset_m": "0",
            "bend": bend,
            "damping_N_m_s_per_rad": "0.003",
        }
        for x, bend in (("-0.019", 1), ("0.019", -1))
    ]
    return {"geometry": "legs", "legs": legs, "low_m": ["-0.02", "0.08"], "high_m": ["0.02", "0.1"]}


def _in_pose() -> Iterator[Any]:
    units = ("N_m_rad", "N_m_s_rad", "N_m_s_rad")
    flat = _wall([[200.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 1.0]], units)
    joints = [_joint(x, "0", "0.3", "0.02") for x in ("0", "0.1", "0.1")]
    yield _arm(_chain(*joints), {**flat, "turns": 1, "rest": "every orientation"}, _FOLLOWS)
    rows = [[0.0] * 6 for _ in range(6)]
    for i in range(6):
        rows[i][i] = 100.0 if i < 3 else 1.0
    tilted = [["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]]
    joints = [_joint("0.05", "0", "0.2", "0.05", rest_rad="0.1") for _ in range(3)]
    joints[1]["rotation"] = tilted
    for rest in ("given", "every orientation"):
        kept = [
            dict(j) if rest == "given" else {k: v for k, v in j.items() if k != "rest_rad"} for j in joints
        ]
        yield _arm(_chain(*kept), {**_wall(rows, units), "turns": 3, "rest": rest}, _FOLLOWS)


MAKERS: dict[str, Callable[[], Iterator[Any]]] = {
    "springs": _springs,
    "linear": _linear,
    "quantized": _quantized,
    "delays": _delays,
    "contact": _contact,
    "relaxing": _relaxing,
    "multiplier": _multiplier,
    "nonlinear": _nonlinear,
    "pull": _pull,
    "slow": _slow,
    "bounding": _bounding,
    "active hand": _active_hand,
    "violations": _violations,
    "motions": _motions,
    "touching": _touching,
    "storage": _storage,
    "more storage": _more_storage,
    "contact motions": _contact_motions,
    "rows": _rows,
    "coarse": _coarse,
    "known hands": _known_hands,
    "absolute": _absolute,
    "ports": _ports,
    "matrix ports": _matrix_ports,
    "arms": _arms,
}
