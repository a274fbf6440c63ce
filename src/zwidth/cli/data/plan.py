"""The command `plan`: how to move a device by hand so that its limit becomes known."""

from __future__ import annotations

import argparse
from typing import Any

from zwidth.cli.options import DEVICE, device_parameters, given
from zwidth.cli.output import print_text
from zwidth.errors import InputError
from zwidth.model.specification.read import LOOP_TABLES, read_tables, specified_in_range
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.units import parse_number

USAGE = "[SOURCE ...] --force-noise NOISE [--length L] [--slow TIME] [--PARAMETER VALUE ...]"
OPTIONS = (
    {"sources=SOURCE*": "device of the catalogue, or TOML file with a [device] table: the guess"},
    "experiment",
    {
        "--force-noise σ": "standard deviation of the load cell per sample [N; rotary N*m]",
        "--length L": "of a stroke, as long as the workspace allows [m; rotary rad] (default: 6 cm)",
        "--slow TIME": "of a slow stroke [s] (default: 1)",
        "--fast TIME": "of the fastest stroke that a person can make [s] (default: 0.25)",
        "--speed V": "up to which friction is to be seen, both ways [m/s; rotary rad/s]",
        "--precision PART": "half-width of the interval, in parts of the value (default: 0.05)",
        "--confidence PART": "of that interval (default: 0.95)",
    },
    *DEVICE,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth plan`: 0."""
    from zwidth.data.identification.device.plan import plan_identification

    tables = read_tables(arguments.sources, LOOP_TABLES)
    device = specified_in_range(tables, given(arguments, [p.key for p in device_parameters()])).device
    plan = plan_identification(device, **_numbers(arguments, device.motion))
    print_text(plan)
    return 0


_NOISE = {"linear": "0.1 N", "rotary": "0.01 N*m"}
"""For example, by the motion of the device."""


def _numbers(arguments: argparse.Namespace, motion: str) -> dict[str, Any]:
    quantities = {"force_noise": "force", "length": "position", "speed": "friction_speed"}
    units = {name: GLOSSARY[quantity].unit_for(motion) for name, quantity in quantities.items()}
    units |= {"slow": "s", "fast": "s", "precision": "1", "confidence": "1"}
    typed = {name: getattr(arguments, name) for name in units}
    if typed["force_noise"] is None:
        raise InputError(
            f'the noise of the force is needed: --force-noise "{_NOISE[motion]}", the standard deviation of '
            "the load cell at rest; without one no run is planned: push the handle and let go, some sixty "
            "times, for zwidth identify with --mass"
        )
    if motion == "rotary" and typed["length"] is None:
        raise InputError('the length of a stroke is needed: --length "90 deg", as far as the device turns')
    return {
        name: float(parse_number(text, units[name], name)) for name, text in typed.items() if text is not None
    }
