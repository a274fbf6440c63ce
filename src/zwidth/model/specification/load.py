"""What files describe, in Python: `zw.check(*zw.load("wheel.toml", "bumpstop.toml"))`.

Of two arms that follow each other it is `zw.check(zw.load("pair.toml"))`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import Environment
from zwidth.model.specification.environments import build_environment
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.pairs import pair_of
from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, keep_axis, read_tables, specified_device


class Loaded(NamedTuple):
    """What files describe: a device, and what it renders."""

    device: Device
    environment: Environment | None
    """Behind its laws, if the files have [[law]] tables; None if they have no [environment]."""


def load(*sources: Path | str) -> Loaded | Any:
    """The device and the environment, or the pair of arms, that specifications describe.

    Parameters
    ----------
    sources
        TOML files with [device], [environment] and [[law]] tables, each in one of them; a name of the
        catalogue stands for a [device].  Or one file with a [coupling], and [leader] and [follower] or one
        [device] for both arms.

    Returns
    -------
    Loaded
        Device and environment; of a file with a [coupling], or with a [leader] and a [follower], a `Pair`.

    Raises
    ------
    InputError
        If a file cannot be read, there is no device, or a key or value cannot be used: it says which,
        where it stands and what is allowed.
    """
    if not sources:
        raise InputError("no file is given: name TOML files with a [device], or a device of the catalogue")
    tables = read_tables(sources, (*WITH_LAWS, *PAIR_TABLES))
    if joined := [tables[key] for key in PAIR_TABLES if key in tables]:
        for key in ("environment", "law"):
            if key in tables:
                raise InputError(f"{tables[key].label}: two arms meet each other, and no environment")
        if len(sources) > 1:
            raise InputError(f"{joined[0].label}: a file of two arms that follow each other is read alone")
        return pair_of(tables)
    if "environment" in tables and "device" in tables:
        keep_axis(tables["device"], tables["environment"].values)
    device, laws = specified_device(tables, {}), tables.get("law")
    if "environment" not in tables:
        if laws is not None:
            raise InputError("[[law]] stands behind an environment, and no file has an [environment] table")
        return Loaded(device, None)
    environment = build_environment(tables["environment"], device.motion)
    return Loaded(device, with_laws(environment, laws, None, device.motion))
