"""A file, a key or a name that is not there: which of those that are may have been meant?"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from itertools import islice
from pathlib import Path

from zwidth.showing import one_line

_MOST = 2000
"""Files of a folder that are looked at."""


def near_file(path: Path, others: Iterable[str] = ()) -> str | None:
    """The name nearest to that of a missing file; None where none is near.

    Parameters
    ----------
    path
        What is not there. Files beside it count that end as it does, .toml where it has no ending.
    others
        What may have been meant as well and is no file.
    """
    ending = path.suffix or ".toml"
    known = {name.removesuffix(ending): str(path.with_name(name)) for name in _beside(path, ending)}
    named = {name: name for name in others} | known
    near = get_close_matches(path.name.removesuffix(ending)[:100], list(named), n=1)
    return named[near[0]] if near else None


def did_you_mean(path: Path) -> str:
    """The end of a message about a missing file: "; did you mean …?", or nothing."""
    near = near_file(path)
    return "" if near is None else f'; did you mean "{near}"?'


def _beside(path: Path, ending: str) -> list[str]:
    try:
        with os.scandir(path.parent) as entries:
            return sorted(e.name for e in islice(entries, _MOST) if e.name.endswith(ending))
    except (OSError, ValueError):
        return []


def suggestion(text: str, known: Iterable[str], option: str = "", more: str = "") -> str:
    """What may have been meant, as a key or an `option`, or else `more`: everything that is possible.

    What people call a quantity is answered by its keys alone, and by no other word that is spelled alike.
    """
    names = list(known)
    found = _called(text, names)
    if not found:
        found = get_close_matches(text[:60], names, n=1, cutoff=_ALIKE if found is None else _THE_SAME)
    if found:
        written = (
            option.format(one.replace("_", "-")) if option else f'"{one_line(one, 60)}"' for one in found
        )
        return f"did you mean {' or '.join(written)}?"
    return more or f"choose from: {', '.join(names)}"


_ALIKE, _THE_SAME = 0.6, 0.85
"""How near a word must be; one that people call something else is answered where it is but misspelled."""


def _called(text: str, names: Sequence[str]) -> list[str] | None:
    """Of what people call so the names that there are, of those between bars the first; else None."""
    part, dot, last = text.lower().replace("-", "_").rpartition(".")  # of a cable, transmission.friction
    known = {name.replace("-", "_"): name for name in names}
    for keys, words in _WORDS.items():
        if last in words.split():
            each = ([f"{part}{dot}{one}" for one in either.split("|")] for either in keys.split())
            found = (next((known[one] for one in either if one in known), None) for either in each)
            return list(dict.fromkeys(one for one in found if one is not None))
    return None


_WORDS = {
    "handle_damping|damping|joint_damping|plant "
    "handle_coulomb_friction|coulomb_friction|joint_friction|plant": "friction",
    "handle_damping|damping|joint_damping|plant": "viscous viscosity viscous_friction viscous_damping "
    "device_damping",
    "handle_coulomb_friction|coulomb_friction|joint_friction|plant": "coulomb dry_friction static_friction",
    "counts_per_turn|encoder resolution|joint_resolution|plant": "counts ppr cpr counts_per_rev "
    "counts_per_revolution pulses_per_revolution",
    "resolution|joint_resolution|encoder|plant counts_per_turn": "encoder encoder_resolution "
    "position_resolution",
    "delay link_delay": "latency lag dead_time time_delay",
    "force_limit|torque_limit": "max_torque max_force torque_limit maximum_torque maximum_force "
    "peak_torque peak_force",
    "rate cutoff": "frequency sample_rate sampling_rate sample_frequency loop_rate update_rate fs",
    "sample_period|rate": "dt time_step sample_time sampling_time",
    "stiffness": "k kp spring spring_constant spring_stiffness wall_stiffness",
    "virtual_damping|damping local_damping": "kd damper",
    "damping virtual_damping": "b",
    "virtual_damping": "damping wall_damping",
}
"""What people call a quantity, by the keys that it has here."""
