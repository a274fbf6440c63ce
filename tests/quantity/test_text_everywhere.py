"""Wherever a public function or class takes a number of a quantity, it takes a text with its unit too."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.model.arms.arm import JOINT_UNITS
from zwidth.quantity.parameter import Parametric, parameters_of

PADDLE, WALL = zw.catalogue.device("haptic-paddle"), zw.Wall(stiffness=300)
CHAIN = zw.arms.PlanarChain(links=(0.3, 0.25, 0.2), damping=(0.1, 0.1, 0.1))
TURNS = zw.Device(motion="rotary", mass="1 g*m^2", damping="1 mN*m*s/rad", rate="1 kHz")
TIME = 0.001 * np.arange(200)
PORT = zw.links.WavePort(PADDLE)
FINGER = zw.operators.Finger()

WITHOUT_UNIT = {
    *("counts", "counts_per_turn", "dpi", "encoder_phase"),
    *(
        "confidence",
        "damping_ratio",
        "forgetting",
        "initial_covariance",
        "largest_trace",
        "margin",
        "precision",
    ),
    *("bilateral_kp", "missed", "regularization", "share", "theta", "tolerance"),
    *("effort", "seconds"),  # of the processor
    *("curvature", "output"),  # the glossary has no such unit: in SI alone
    *("delay_samples", "samples", "rest"),  # of an arm by joint, of a tissue tested below
}
"""Parts, counts and settings, by name."""

OTHERWISE = {
    "Interval": "numbers of no quantity",
    "built_in read_arm": "one number for each joint, tested below",
    "HaplyPantograph": "numbers of its joints",
    "borne_impedance check_controllers check_gains passive_gains read_gains": "tests/gains reads text",
    "identify_finger cut_scene PartRun PortRun Peer": "what they need is made in their own tests",
    "stiffness_over_postures": "reads rate and delay as `workspace` does",
    "run_parts Rows": "readings, in SI",
}
"""What takes its numbers in another way, and why."""

USUAL = {
    "arm": CHAIN, "axes": lambda: Figure().subplots(), "below": "10 Hz",
    "body": zw.simulation.VirtualBody(0.1),
    "branch_damping": "10 N*s/m", "branch_stiffness": "100 N/m", "coulomb_friction": "0.1 N",
    "damping": "0.1 N*s/m", "delay": "1 ms", "device": PADDLE, "displacement": "1 mm", "duration": "5 ms",
    "energies": np.zeros(3), "environment": WALL, "fast": "1 s", "fastest": "1 m/s", "first": True,
    "curvature": 1.0, "force": np.sin(40 * TIME),
    "largest_force": "1 N", "theta": 0.1, "count": "1 mm", "counts": 1000, "full_duty_torque": "1 N*m",
    "torque_per_current": "1 N*m/A",
    "force_noise": "10 mN", "frequencies": [10.0], "greatest": "0.2 N/mm",
    "guess": PADDLE, "hand": FINGER, "initial": ("200 N/m", "200 N/m", "20 N*s/m"), "inputs": np.zeros(2),
    "least": "0 N/m", "line": "line", "memory": "1 ms", "operator": FINGER, "penetration": "1 mm",
    "period": "1 ms", "position": 0.001 * np.sin(40 * TIME), "position_gain": "1 N/m",
    "positions": np.zeros(3),
    "port": PORT, "rate": "1 kHz", "relaxation_times": ("1 ms", "1 s"), "resolution": "20 um",
    "sample_period": "1 ms", "samples": 1,
    "scene": zw.scene.Scene([zw.scene.Mass("handle", 0.1)]), "schedule": zw.links.Schedule(),
    "solid": (300, 150, 10), "speed": "0.5 m/s", "stiffness": "0.3 N/mm", "text": "memory:x", "time": TIME,
    "vary": {"mass": [0.1]}, "velocity_gain": "1 N*s/m", "virtual_damping": ("0 N*s/m", "0.1 N*s/m"),
    "wall": zw.Wall(stiffness=10), "leader": PADDLE, "follower": PADDLE, "delay_samples": 0,
}  # fmt: skip
"""What is given under each name."""

STIFF = {"stiffness": "20 N/mm"}
PAIRS = ("100 N/m", "0.2 N/mm")
OWN: dict[str, dict[str, Any]] = {
    "compare": {"device": TURNS, "environment": zw.Wall(0.1), "handle_radius": "5 cm"},
    "loop_storage": {"damping": 0.1}, "plan": {"force_noise": "10 mN"},
    "links.compare": {}, "null_space": {"stiffness": "1 N*m/rad"}, "wall_need": {"wall": WALL},
    "rotary": {"rate": "1 kHz", "damping": "1 mN*m*s/rad"}, "Device": {"sample_period": "1 ms"},
    "SlopeBounds": {"bounded_below": True}, "edge_crossing": STIFF, "fast_press": STIFF,
    "simulate_admittance": {"operator": zw.operators.ConstantForce(1)},
    "simulate_batch": {"vary": {"device.mass": [0.1]}},
    "simulate_pair": {"pair": zw.Pair(PADDLE, PADDLE, stiffness=10), "leader": FINGER, "follower": None},
    "links.simulate": {"leader": PORT, "follower": PORT, "leader_hand": FINGER, "follower_hand": None},
    "transformed_condition": {"environment": zw.coupling.SlopeBounds(0, 100, bounded_below=True)},
    "z_width": {"stiffness": PAIRS}, "maps.z_width": {"stiffness": PAIRS},
    "z_width_factors": {
        "stiffness": PAIRS, "rate": ("1 kHz", "2 kHz"), "damping": ("0.1 N*s/m", "0.2 N*s/m"),
        "resolution": ("10 um", "20 um"),
    },
}  # fmt: skip
"""In the place of that, for one function."""


def _rooms(room: ModuleType) -> Iterator[tuple[str, Any]]:
    for name in dir(room):
        one = getattr(room, name)
        if isinstance(one, ModuleType):
            yield from _rooms(one) if name in getattr(room, "__all__", ()) else ()
        elif callable(one):
            yield f"{room.__name__.rpartition('.')[2]}.{name}", one


def _reads(one: Any) -> bool:
    """Functions, and classes that read what they are given; the others are results, or tested by field."""
    written = inspect.isfunction(one.__init__) and one.__init__.__code__.co_filename != "<string>"
    return not isinstance(one, type) or written


def _numbers(one: Any) -> list[str]:
    parameters = inspect.signature(one).parameters.values()
    typed = [(p.name, re.sub(r"Callable\[\[.*?\], \w+\]", "", str(p.annotation))) for p in parameters]
    return [
        name
        for name, kind in typed
        if re.search(r"\b(float|RealLike|Given)\b", kind) and name not in WITHOUT_UNIT
    ]


FOUND = {
    (one, number): name
    for name, one in _rooms(zw)
    if not any(name.rpartition(".")[2] in names.split() for names in OTHERWISE) and _reads(one)
    for number in _numbers(one)
}


def _given(name: str, one: Callable[..., Any]) -> dict[str, Any]:
    own = OWN.get(name, OWN.get(name.rpartition(".")[2], {}))
    parameters = inspect.signature(one).parameters.values()
    needed = [p.name for p in parameters if p.default is p.empty and p.kind is not p.VAR_KEYWORD]
    given = {**{key: USUAL.get(key) for key in needed}, **own}
    return {key: value() if inspect.isfunction(value) else value for key, value in given.items()}


@pytest.mark.parametrize(("one", "number"), FOUND, ids=[f"{name}({key})" for (_, key), name in FOUND.items()])
def test_a_wrong_unit_is_refused_by_name(one: Callable[..., Any], number: str) -> None:
    """One message, of the parameter and the unit that is wanted, before anything is computed."""
    given = _given(FOUND[one, number], one)
    if number == "rate":
        given.pop("sample_period", None)  # of a device either is given
    usual = given.get(number, USUAL.get(number))
    wrong = ("3 kg*s",) * len(usual) if isinstance(usual, tuple) else "3 kg*s"
    with pytest.raises(zw.InputError, match=rf"({number}|slope).* (is|in|such as) ") as refused:
        one(**{**given, number: wrong})
    assert "kg*s" in str(refused.value)


READ = {
    one: name for (one, _), name in FOUND.items() if re.match("formulas|coupling|stability|simulation", name)
}


@pytest.mark.parametrize("one", READ, ids=READ.values())
def test_a_text_with_its_unit_is_a_number(one: Callable[..., Any]) -> None:
    """What is usual is given as text: 0.3 N/mm, 20 µm, 1 ms."""
    given = _given(READ[one], one)
    one(**{**{key: USUAL[key] for key in _numbers(one) if key in USUAL}, **given})


def test_fields_of_classes_read_texts() -> None:
    """Of devices, laws, hands, links, …: each number by the reader of its field."""
    classes = {one for _, one in _rooms(zw) if isinstance(one, type) and issubclass(one, Parametric)}
    read = 0
    for kind in classes:
        for name, field in parameters_of(kind).items():
            if field.is_number and field.quantity.unit != "1":
                read += 1
                three = -3 if field.bound == "≤ 0" else 3
                assert float(field.read(f"{three} {field.quantity.unit}", name)) == three, (kind, name)
                with pytest.raises(zw.InputError, match=name):
                    field.read("3 kg*s", name)
    assert len(classes) > 60
    assert read > 150


def test_numbers_of_joints_read_texts() -> None:
    """One for each joint, or one for all; a matrix of damping; a wrong unit is refused by joint."""
    chain = zw.arms.PlanarChain(links=(0.3, 0.25), damping=["20 mN*m*s/rad", 0.01], resolution=("1 deg", 0))
    assert (chain.damping, chain.resolution) == ((0.02, 0.01), (pytest.approx(np.pi / 180), 0))
    shared = zw.arms.built_in("two-link", damping=[["20 mN*m*s/rad", 0.005], [0.005, "0.01 N*m*s/rad"]])
    assert shared.damping == ((0.02, 0.005), (0.005, 0.01))
    for key, unit in JOINT_UNITS.items():
        given = {"damping": "1 N*m*s/rad", key: f"3 {unit[0]}"}
        assert getattr(zw.arms.built_in("two-link", **given), key) == (3, 3)
        with pytest.raises(zw.InputError, match=f"{key} of q1 is in .*kg"):
            zw.arms.built_in("two-link", **{**given, key: "3 kg"})
