"""The same about an axis: one document of each kind with angles, torques and inertias is accepted just so."""

from __future__ import annotations

from typing import Any

from . import Case, accepted
from .absolute import HAND as TOUCHED
from .active_hand import REDUCED
from .contact import DAMPED
from .contact_motion import DAMPED as PUSHED
from .contact_motion import QUARTER as PUSHED_LATE
from .contact_motion import curved
from .force_bounding import BOUND
from .motion import QUARTER, THERE
from .multiplier_contact import WALL
from .nonlinear_spring import RISING, RUNS_AWAY
from .quantized import FILTERED
from .relaxing_contact import ONE
from .rest import RESTS
from .row_motion import THERE as ROW
from .slow_hands import SPRING as SLOW
from .spring import spring
from .storage import STORAGES
from .touching_motion import QUARTER as TOUCHING
from .vibration import HEAVY, hand
from .wave_port import PORT

_UNITS = {
    "m_per_s_N": "rad_per_s_N_m",
    "N_N_s_per_m": "N_m_N_m_s_per_rad",
    "N_s_per_m": "N_m_s_per_rad",
    "N_per_m": "N_m_per_rad",
    "m_per_s": "rad_per_s",
    "rate_per_m": "rate_per_rad",
    "m_N": "rad_N_m",
    "kg": "kg_m2",
    "N": "N_m",
    "m": "rad",
}


def turned(document: Any) -> Any:
    """Every unit in a key changed for that of an axis."""
    if isinstance(document, dict):
        return {_key(key): turned(value) for key, value in document.items()}
    return [turned(entry) for entry in document] if isinstance(document, list) else document


def _key(key: str) -> str:
    unit = next((unit for unit in _UNITS if key.endswith(f"_{unit}") or key == unit), None)
    return key if unit is None else key.removesuffix(unit) + _UNITS[unit]


def energy(document: Any, joules: Any) -> Any:
    return {**document, "energy_J": joules}


DOCUMENTS = {
    "a spring": spring(4),
    "a damped wall": DAMPED,
    "a law that relaxes": ONE,
    "a law fed with the position": WALL,
    "a filter, its encoder counted": FILTERED,
    "a spring through points": RISING,
    "an endless pull": RUNS_AWAY,
    "slow hands": SLOW,
    "force bounding": BOUND,
    "wave port": PORT,
    "an active hand": REDUCED,
    "a known hand": RESTS,
    "any wall of a hand": TOUCHED,
    "a vibration": hand(2, 1, 1, 5, **HEAVY),
    "a motion": energy(THERE, 1),
    "a motion, part of a sample late": energy(QUARTER, "1/2"),
    "a motion that touches": energy(TOUCHING, "1/2"),
    "a motion with rounds": {
        **energy(PUSHED, 6),
        "bounds": {"depth_m": 1, "outside_m": 0, "speed_m_per_s": 1},
    },
    "a motion with rounds, part of a sample late": energy(PUSHED_LATE, "3/2"),
    "a motion with a friction curve": energy(curved([0, 1], [1, "1/2"], [2, 1]), 3),
    "a motion of laws in a chain": energy(ROW, 3),
    **{
        f"storage, {name}": STORAGES[name]["document"]
        for name in ("limited", "stepped", "grows", "points", "solid", "curve", "row", "coarse")
    },
}

WORDS = {"slow hands": "3 rad/s", "storage, coarse": "rad/s"}

CASES: list[Case] = [accepted(name, turned(told), WORDS.get(name, "")) for name, told in DOCUMENTS.items()]
