"""The command `map`: the Z-width of a device, cell by cell."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.decision import NAMES, device_of_one_value, named_hands
from zwidth.cli.options import DEVICE, FORCE, PLOT, device_parameters, given, whole
from zwidth.cli.output import print_found, print_message, targets
from zwidth.errors import InputError
from zwidth.model.specification.read import LOOP_TABLES, keep_axis, read_tables, specified_in_range
from zwidth.model.specification.table import Table, plain, quoted
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken_data
from zwidth.quantity.text import outward_decimal, shown, told_quantity, unit_text
from zwidth.quantity.units import parse_number
from zwidth.showing import Part
from zwidth.showing import Table as ShownTable

if TYPE_CHECKING:
    import xarray as xr

    from zwidth.model.device import Device
    from zwidth.model.environment.velocity import VelocityEstimator


USAGE = (
    "[SOURCE] --stiffness LOW:HIGH --virtual-damping LOW:HIGH [--cells NxM] [--hands NAMES] "
    "[--PARAMETER VALUE ...] [--json] [--plot FILE] [--certify FILE] "
    "[-o DIRECTORY] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "device of the catalogue, or TOML file with a [device] table; of a wall beside it "
        "the velocity filter is taken"
    },
    "walls",
    {
        "--stiffness LOW:HIGH": "range of K [N/m; rotary N*m/rad]",
        "--virtual-damping LOW:HIGH": "range of B [N*s/m; rotary N*m*s/rad]",
        "--cells NxM": "how many along K and along B (default: 200x200)",
        "--velocity-filter FILTER": "backward-difference, window N, one-pole τ or f, filter",
        "--hands NAMES": f"known hands of {NAMES} (default: all)",
        "--speed SPEED": "up to which a hand must not gain for a wall to count as quiet (default: 0.5)",
    },
    "output",
    {
        "--workers N": "threads (default: one for each processor)",
        "--address ADDRESS": "of a Dask scheduler, tcp://…, whose workers compute instead",
        **PLOT,
        "--certify FILE": "save a certificate of each column's stiffest passive wall, for zwidth verify",
        "--json": "print the summary as JSON, units in the keys",
        "-o DIRECTORY": "zarr store, written as it goes; one that was begun is gone on with",
        **FORCE,
    },
    *DEVICE,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth map`: 0."""
    from zwidth.study.maps import z_width

    plot, proof = targets(arguments.plot, arguments.certify, arguments.force, "--certify")
    tables = read_tables(arguments.sources, LOOP_TABLES)
    if "device" in tables:
        keep_axis(tables["device"], [arguments.stiffness, arguments.virtual_damping])
    device = _device(arguments, tables)
    options = _options(arguments, device.motion, tables.get("environment"))
    try:
        found = z_width(device, **options)
    except KeyboardInterrupt:
        if arguments.save is not None and Path(arguments.save).exists():
            print_message(f"{plain(arguments.save, 200)} keeps what is finished; the same command goes on")
        raise
    if plot is not None:
        from zwidth.show.plots import save_z_width  # matplotlib takes its time

        save_z_width(found, plot, overwrite=True)
    if proof is not None:
        _certify(device, found, options.get("velocity_filter"), proof)
    kept = None if arguments.save is None else Path(arguments.save)
    print_found(arguments.json, partial(_json, found), partial(_report, found), kept, plot, proof)
    return 0


def _certify(device: Device, found: xr.Dataset, velocity: VelocityEstimator | None, path: Path) -> None:
    from zwidth.study.maps import z_width_certificate

    certificate = z_width_certificate(device, found, velocity_filter=velocity)
    if certificate is None:
        raise InputError("--certify: no wall of this map is passive, so there is nothing to certify")
    certificate.save(path)


def _device(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> Device:
    overrides = given(arguments, [p.key for p in device_parameters()])
    if ":" in overrides.get("damping", ""):
        raise InputError(
            "--damping is the friction of the device itself, one value; the range of the wall's damping is "
            "--virtual-damping LOW:HIGH"
        )
    return device_of_one_value(specified_in_range(tables, overrides).device)


def _filter_of(table: Table | None, motion: str) -> VelocityEstimator | None:
    """The velocity filter of a wall in a file, of which the rest is what the map goes through."""
    if table is None:
        return None
    from zwidth.model.environment import Wall
    from zwidth.model.specification.environments import build_environment

    wall = build_environment(table, motion)
    if not isinstance(wall, Wall):
        raise InputError(f"{table.label}: a map is of walls, stiffness by damping; give a file without it")
    return wall.velocity_filter


def _options(arguments: argparse.Namespace, motion: str, environment: Table | None) -> dict[str, Any]:
    from zwidth.model.specification.values import velocity_filter

    options: dict[str, Any] = {
        "stiffness": _range(arguments.stiffness, "stiffness", "stiffness", motion),
        "virtual_damping": _range(arguments.virtual_damping, "virtual-damping", "virtual_damping", motion),
        "path": arguments.save,
        "address": arguments.address,
    }
    if arguments.cells is not None:
        options["cells"] = _cells(arguments.cells)
    if arguments.velocity_filter is not None:
        options["velocity_filter"] = velocity_filter(arguments.velocity_filter)
    elif (filtered := _filter_of(environment, motion)) is not None:
        options["velocity_filter"] = filtered
    if arguments.hands is not None:
        options["hands"] = named_hands(arguments.hands, motion)
    if arguments.speed is not None:
        options["speed"] = float(
            parse_number(arguments.speed, GLOSSARY["velocity"].unit_for(motion), "speed")
        )
    if arguments.workers is not None:
        options["workers"] = whole(arguments.workers, "--workers")
    return options


def _range(typed: str | None, option: str, quantity: str, motion: str) -> tuple[Any, Any]:
    if typed is None:
        raise InputError(f"--{option} LOW:HIGH is missing: the range of the map, such as 0:3000")
    low, colon, high = typed.partition(":")
    if not colon:
        raise InputError(f"--{option} is a range, LOW:HIGH, got {quoted(typed)}")
    low, high, unit = low.strip(), high.strip(), GLOSSARY[quantity].unit_for(motion)
    behind = high.lstrip("+-.0123456789eE ")
    if behind and not any(map(str.isalpha, low)):  # "0:1 N*m/deg": the unit is of both
        low = f"{low} {behind}"
    return parse_number(low, unit, option), parse_number(high, unit, option)


def _cells(typed: str) -> tuple[int, int]:
    along_k, cross, along_b = typed.lower().replace("×", "x").partition("x")
    if not cross:
        raise InputError(f"--cells is written NxM, such as 200x200, got {quoted(typed)}")
    return whole(along_k, "--cells"), whole(along_b, "--cells")


def _report(found: xr.Dataset) -> Iterator[Part]:
    """The regions, widest claim first, and what is felt in free air."""
    found = spoken_data(found)
    unit = unit_text(found["largest_stiffness"].attrs["units"])
    heads = [("region", f"largest K [{unit}]", "area of the map")]
    yield ShownTable(heads=heads, rows=[_row(str(name), found) for name in found["region"].values], lefts=1)
    if found.attrs["not_covered"]:
        spring = shown(float(found["spring_limit"]), found["spring_limit"].attrs["units"])
        yield (
            f"not covered, contact made and broken: {found.attrs['not_covered']}; "
            f"a spring alone, B = 0, is passive up to {spring}"
        )
    free = [
        shown(float(found[key]), found[key].attrs["units"])
        for key in ("free_mass", "free_damping", "free_friction")
        if found[key].notnull()  # the mass of a handle may be unknown
    ]
    yield f"free air: {', '.join(free)}"


def _row(name: str, found: xr.Dataset) -> tuple[str, str, str]:
    """A region, its stiffest wall, and how much of the map it is."""
    count = int(found[name].values.sum())
    if not count and name in _BROKEN and found.attrs["not_covered"]:
        return _region(name, found), "not covered", ""
    most = float(found["largest_stiffness"].sel(region=name))
    largest = f"{outward_decimal(most, False, 6):.6g}" if count else "none"
    return _region(name, found), largest, f"{count / found['passive'].size:.1%}"


_BROKEN = ("passive", "quiet")
"""The regions in which contact is made and broken."""


def _region(name: str, found: xr.Dataset) -> str:
    if name in ("passive", "passive_sustained"):
        this = "" if found.attrs["transmission"] != "as given" else ", this transmission"
        any_ = "" if found.attrs["transmission"] == "rigid" else ", any transmission"
        return f"passive, every hand{any_}" if name == "passive" else f"passive, contact kept{this or any_}"
    if name == "quiet":
        speed = told_quantity(found["quiet"].attrs["speed"], "velocity", found.attrs["motion"], 4)
        return f"no gain up to {speed}"
    hand = name.removeprefix("stable_")
    return "stable, no hand" if hand == "none" else f"stable, {hand}"


def _json(found: xr.Dataset) -> str:
    """The regions and the free device, units in the keys."""
    from zwidth.quantity.glossary import unit_suffix
    from zwidth.quantity.text import to_json

    unit = unit_suffix(found["largest_stiffness"].attrs["units"])
    regions: dict[str, dict[str, Any]] = {}
    for name in map(str, found["region"].values):
        cells = int(found[name].values.sum())
        covered = bool(cells) or name not in _BROKEN or not found.attrs["not_covered"]
        largest = float(found.sel(region=name)["largest_stiffness"]) if covered else None
        regions[name] = {
            f"largest_stiffness_{unit}": largest,
            "cells": cells,
            "covered": covered,
            "scope": json.loads(found[name].attrs["scope"]),
        }
    free = {
        f"{key}_{unit_suffix(found[key].attrs['units'])}": float(found[key])
        for key in ("free_mass", "free_damping", "free_friction")
        if found[key].notnull()
    }
    return to_json(
        {
            "device": found.attrs["device"],
            "cells": found["passive"].size,
            "regions": regions,
            "not_covered": found.attrs["not_covered"] or None,
            f"spring_limit_{unit}": float(found["spring_limit"]),
            **free,
        }
    )
