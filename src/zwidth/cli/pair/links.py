"""The command `links`: which port joins two devices over a link that loses packets?"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from zwidth.cli.options import ANGLES_TOLD, given, output
from zwidth.cli.output import give_out, targets
from zwidth.cli.parsing import Parameter, heed_angles
from zwidth.errors import InputError
from zwidth.model.specification.read import load_device


def link_parameters() -> Iterator[Parameter]:
    from zwidth.links.schedule import Schedule
    from zwidth.quantity.parameter import parameters_of

    for name, own in parameters_of(Schedule).items():
        unit = "" if own.quantity.unit == "1" else f" [{own.quantity.unit}]"
        yield Parameter(name, own.quantity.symbol or name.upper(), f"{own.meaning}{unit}")


USAGE = (
    "SOURCE [SOURCE] [--delay TIME] [--jitter TIME] [--loss SHARE] [--burst N] "
    "[--duplicates SHARE] [--seed N] [--impedance w] [--smoothing s] [--hold-back] [--json] "
    "[--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "one device for both ends, or leader and follower: each of the catalogue, or a "
        "TOML file with a [device] table; each with a mass",
        "--impedance w": "of the waves [N*s/m; rotary N*m*s/rad] (default: the smaller damping of both "
        "devices)",
        "--smoothing s": "time constant that smooths the force of the port with a ledger [s] (default: 0)",
        "--hold-back": "of devices whose delay ends within a sample: their loops keep each force back until "
        "it ends",
        **ANGLES_TOLD,
    },
    "link",
    link_parameters,
    "output",
    output("the scores", "the plot", "the scores as JSON"),
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth links`: 0."""
    if not 1 <= len(arguments.sources) <= 2:
        raise InputError(
            "a link has two ends: name one device for both, or leader and follower; "
            f"got {len(arguments.sources)}"
        )
    from zwidth.links import Schedule, compare
    from zwidth.progress import progress_bar

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    heed_angles(arguments)
    devices = [load_device([source], {}) for source in arguments.sources]
    link = Schedule(**given(arguments, [p.key for p in link_parameters()]))
    more = {
        "impedance": arguments.impedance,
        "smoothing": arguments.smoothing or 0,
        "hold_back": arguments.hold_back,
    }
    with progress_bar("ports") as progress:
        found = compare(devices[0], devices[-1], link, **more, progress=progress)
    give_out(found, save, plot, arguments.json)
    return 0
