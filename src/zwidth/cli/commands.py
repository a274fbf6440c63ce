"""The subcommands.  `COMMANDS` is the registry: a new command is one row and one function."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from zwidth.cli.decision import decided, exit_status
from zwidth.cli.options import (
    Once,
    add_contact_option,
    add_law_option,
    add_output,
    add_parameters,
    contact,
    overrides,
)
from zwidth.cli.output import print_json, say_written, targets, writing
from zwidth.errors import InputError

if TYPE_CHECKING:
    from zwidth.passivity.finite_stiffness import FiniteStiffnessReplay
    from zwidth.passivity.verdict import Verdict
    from zwidth.specification.read import Specification
    from zwidth.stability.active_hand import ToleratedActivity


class Command(NamedTuple):
    """A subcommand: what it does, how its arguments are set up, and the function that runs it."""

    meaning: str
    description: str
    epilog: str
    configure: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]


def _configure_check(parser: argparse.ArgumentParser) -> None:
    parser.usage = (
        "%(prog)s [SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--json] [--plot FILE] [--replay] "
        "[--active-below FREQUENCY] [--contact KIND] [-o FILE] [--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="device of the catalogue, or TOML file with a [device] table, an [environment] table or both",
    )
    add_law_option(parser)
    add_contact_option(parser)
    output = add_output(parser, "the verdict", "the plots", "verdict and evidence as JSON, for zwidth verify")
    output.add_argument(
        "--replay", action="store_true", help="replay the motion by hands of finite stiffness; needs a mass"
    )
    output.add_argument(
        "--active-below",
        metavar="FREQUENCY",
        action=Once,
        help="how active a hand may be below this frequency that is passive above it, such as 10 Hz",
    )
    add_parameters(parser)


def _check(arguments: argparse.Namespace) -> int:
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    loop = _loop(arguments)
    active = _tolerated(loop, arguments.active_below)
    verdict = decided(loop, contact(arguments))
    if save is not None:
        with writing(save):
            verdict.save(save, {} if active is None else {"active_hand": active.to_dict()})
    if plot is not None:
        verdict.plot(plot)
    replayed = _replayed(verdict) if arguments.replay else None
    if arguments.json:
        print_json(_in_full(verdict, real_hand=replayed, active_hand=active))
    else:
        from zwidth.cli.report import print_verdict

        print_verdict(verdict, replayed, active)
        say_written(save, plot)
    return exit_status(verdict.outcome)


def _loop(arguments: argparse.Namespace) -> Specification:
    """The device, and the environment behind its laws."""
    from zwidth.specification.laws import with_laws
    from zwidth.specification.read import WITH_LAWS, Specification, read_tables, specified

    tables = read_tables(arguments.sources, WITH_LAWS)
    given = specified(tables, overrides(arguments))
    rendered = with_laws(given.environment, tables.get("law"), arguments.law, given.device.motion)
    return Specification(given.device, rendered)


def _replayed(verdict: Verdict) -> FiniteStiffnessReplay:
    from zwidth.cli.compile_notice import warn_of_compiling
    from zwidth.passivity.finite_stiffness import replay  # the simulator takes its time

    warn_of_compiling()
    return replay(verdict)


def _tolerated(loop: Specification, below: str | None) -> ToleratedActivity | None:
    if below is None:
        return None
    from zwidth.quantity.units import parse_number
    from zwidth.stability.active_hand import tolerated_activity

    return tolerated_activity(loop.device, loop.environment, parse_number(below, "Hz", "active_below"))


def _in_full(verdict: Verdict, **reports: FiniteStiffnessReplay | ToleratedActivity | None) -> str:
    from zwidth.passivity.document import to_json

    given = {name: report.to_dict() for name, report in reports.items() if report is not None}
    return to_json({**verdict.to_dict(), **given})


def _configure_devices(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", nargs="?", help="only this device, with every value")
    parser.add_argument("--json", action="store_true", help="print JSON, units in the keys")


def _devices(arguments: argparse.Namespace) -> int:
    from zwidth.device import catalogue

    names = catalogue.names() if arguments.name is None else (arguments.name,)
    entries = [catalogue.entry(name) for name in names]
    from zwidth.cli.devices import entries_json, print_entries

    if arguments.json:
        print_json(entries_json(entries))
    else:
        print_entries(entries, in_full=arguments.name is not None)
    return 0


def _configure_verify(parser: argparse.ArgumentParser) -> None:
    parser.usage = "%(prog)s FILE\n       %(prog)s --schema KIND"
    parser.add_argument(
        "file", metavar="FILE", nargs="?", help="certificate, witness, verdict or limit saved as JSON"
    )
    parser.add_argument(
        "--schema",
        metavar="KIND",
        action=Once,
        help="print the JSON Schema of the documents of a kind, such as spring or corners",
    )


def _verify(arguments: argparse.Namespace) -> int:
    if arguments.schema is not None:
        return _schema(arguments)
    if arguments.file is None:
        raise InputError("which FILE is to be checked? Or --schema KIND for what one must look like")
    from zwidth.cli.verification import print_verifications, verifications
    from zwidth.passivity.certificate import read_document

    found = verifications(read_document(arguments.file))
    print_verifications(found)
    return 0 if all(part.verification.valid for part in found) else 1


def _schema(arguments: argparse.Namespace) -> int:
    if arguments.file is not None:
        raise InputError("--schema prints what a document must look like, and checks no FILE")
    from zwidth.cli.schemas import schema

    print_json(schema(arguments.schema))
    return 0


def _configure_limit(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.limit import configure_limit

    configure_limit(parser)


def _limit(arguments: argparse.Namespace) -> int:
    from zwidth.cli.limit import run_limit

    return run_limit(arguments)


def _configure_map(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.map import configure_map

    configure_map(parser)


def _map(arguments: argparse.Namespace) -> int:
    from zwidth.cli.map import run_map

    return run_map(arguments)


def _configure_identify(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.identification import configure_identify

    configure_identify(parser)


def _identify(arguments: argparse.Namespace) -> int:
    from zwidth.cli.identification import run_identify

    return run_identify(arguments)


def _configure_compare(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.comparison import configure_compare

    configure_compare(parser)


def _compare(arguments: argparse.Namespace) -> int:
    from zwidth.cli.comparison import run_compare

    return run_compare(arguments)


def _configure_simulate(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.simulation import configure_simulate  # knows the hands, which load numpy

    configure_simulate(parser)


def _simulate(arguments: argparse.Namespace) -> int:
    from zwidth.cli.simulation import run_simulate

    return run_simulate(arguments)


def _configure_traces(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.simulation import configure_traces

    configure_traces(parser)


def _traces(arguments: argparse.Namespace) -> int:
    from zwidth.cli.simulation import run_traces

    return run_traces(arguments)


def _configure_workspace(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.workspace import configure_workspace

    configure_workspace(parser)


def _workspace(arguments: argparse.Namespace) -> int:
    from zwidth.cli.workspace import run_workspace

    return run_workspace(arguments)


def _configure_plan(parser: argparse.ArgumentParser) -> None:
    from zwidth.cli.planning import configure_plan

    configure_plan(parser)


def _plan(arguments: argparse.Namespace) -> int:
    from zwidth.cli.planning import run_plan

    return run_plan(arguments)


COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        "check": Command(
            "is this device, rendering this environment, passive?",
            "Prove that the sampled loop is passive, or find the hand motion that takes energy out of it;\n"
            "say what limits it, by how much, and what to change.",
            "A plain number is SI; others carry a unit, as in --rate '1 kHz' or --resolution '22.4 um'.\n"
            "An interval, as in --damping '0.1 .. 0.2', stands for every value in it.\n\n"
            "exit status: 0 passive, 1 active, 2 bad input, 3 undecided, 4 passive while contact is kept\n"
            "(and nothing is known of a hand that touches and leaves); with --contact kept that is 0\n\n"
            "examples:\n"
            "  zwidth check haptic-paddle --stiffness 300\n"
            "  zwidth check my-wheel.toml my-bumpstop.toml --json\n"
            "  zwidth check --damping 0.2 --rate '2 kHz' --stiffness 500 --virtual-damping 0.05",
            _configure_check,
            _check,
        ),
        "limit": Command(
            "how far may a parameter go?",
            "Bracket a limit: the last value that is proved passive, and the first at which a motion of the\n"
            "hand takes energy out, contact made and broken at will.",
            "A plain number is SI; others carry a unit, as in --penetration '2 mm'. A parameter is\n"
            "named as its option is: --parameter virtual-damping, --parameter rate, …\n\n"
            "exit status: 0 both sides found, 2 bad input, 3 one side or none found\n\n"
            "examples:\n"
            "  zwidth limit haptic-paddle --stiffness 100 --virtual-damping 0.05\n"
            "  zwidth limit haptic-paddle --stiffness 100 --virtual-damping 0.05 --speed '0.5 m/s'\n"
            "  zwidth limit my-wheel.toml my-wall.toml --parameter rate -o limit.json",
            _configure_limit,
            _limit,
        ),
        "map": Command(
            "which walls can this device render?",
            "Map the Z-width: over stiffness and virtual damping, which walls are passive with every hand,\n"
            "which are so up to a speed of the hand, and which are stable with hands that are known.",
            "A plain number is SI. The map in a directory is written as it goes; a stopped one goes on when\n"
            "the same command is given again.\n\n"
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth map haptic-paddle --stiffness 0:3000 --virtual-damping 0:5 --plot map.png\n"
            "  zwidth map haptic-paddle --stiffness 0:30000 --virtual-damping 0:90 "
            "--cells 1000x1000 -o map.zarr\n"
            "  zwidth map haptic-paddle --stiffness 0:3000 --virtual-damping 0:5 -o map.zarr "
            "--address tcp://cluster:8786",
            _configure_map,
            _map,
        ),
        "simulate": Command(
            "what happens when a hand touches the wall?",
            "Simulate a hand on the device, without time-step error: positions, forces, every joule.",
            "A plain number is SI; others carry a unit, as in --duration '2 s' or --operator.force '4 N'.\n\n"
            "exit status: 0 simulated, 2 bad input, 130 interrupted (what was finished is kept)\n\n"
            "examples:\n"
            "  zwidth simulate haptic-paddle --stiffness 770 --operator dowel --duration 2 --plot touch.png\n"
            "  zwidth simulate haptic-paddle --stiffness 300 --operator malicious --duration 1 -o touch.nc\n"
            "  zwidth simulate haptic-paddle --stiffness 770 --law passivity-controller --operator dowel "
            "--duration 2\n"
            "  zwidth simulate my-wheel.toml my-touch.toml --sound buzz.wav",
            _configure_simulate,
            _simulate,
        ),
        "traces": Command(
            "compare saved touches",
            "Read traces that zwidth simulate saved, and set their numbers beside each other.",
            "example:\n  zwidth traces finger.nc dowel.nc --plot both.png",
            _configure_traces,
            _traces,
        ),
        "compare": Command(
            "which rendering law suits this wall on this device?",
            "Put rendering laws on one bench: the same touches, the same hand that tries to take energy\n"
            "out; what is felt, what is given out, and what is proved.",
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth compare haptic-paddle --stiffness 2000\n"
            "  zwidth compare haptic-paddle --stiffness 2000 --laws virtual-damping,passivity-controller "
            "--plot laws.png\n"
            "  zwidth compare my-paddle.toml my-laws.toml --laws wall,virtual-damping",
            _configure_compare,
            _compare,
        ),
        "workspace": Command(
            "where does an arm of several joints render a wall passively?",
            "Map over the workspace of an arm whether the damping of its joints pays for a wall; prove it\n"
            "between the points too, or show a motion that takes energy out; say which joint to damp.",
            "exit status: 0 passive, 1 active, 2 bad input, 3 undecided, 4 by a proof on paper alone\n\n"
            "examples:\n"
            "  zwidth workspace haply-2diy --joint-damping 0.003 --stiffness 500 --plot map.png\n"
            "  zwidth workspace two-link --joint-damping 0.02,0.01 --stiffness 500 --rate '2 kHz'\n"
            "  zwidth workspace my-arm.urdf --stiffness 500\n"
            "  zwidth workspace my-arm.urdf --pose --stiffness 500 --rotational-stiffness '20 N*m/rad'",
            _configure_workspace,
            _workspace,
        ),
        "identify": Command(
            "mass, damping and friction of a device, from a log of its motion",
            "Identify a device from a log of position and force: numbers with intervals, the stiffest wall\n"
            "they allow, and for how much of what the data allow an environment is passive.",
            "A log is text, Parquet, HDF5, NetCDF, MATLAB, a ROS bag or a trace. Columns whose names are\n"
            "not recognised are named: --column position=enc --unit position=counts.\n\n"
            "exit status: 0 identified, 2 bad input; with an environment that of zwidth check at the stated\n"
            "confidence: 0 passive, 1 active, 3 undecided, 4 passive while contact is kept\n\n"
            "examples:\n"
            "  zwidth identify session.csv -o my-device.toml --plot fig.png\n"
            "  zwidth identify session.csv --column position=enc --unit position=counts "
            "--resolution '22.4 um' --stiffness 250\n"
            "  zwidth identify swing.csv --mass '36 g'",
            _configure_identify,
            _identify,
        ),
        "plan": Command(
            "how to move a device by hand so that its limit becomes known",
            "Plan the experiment for zwidth identify: which strokes, how many, how long, and when to stop.",
            "The guess of the device may be rough: after each run the data decide.\n\n"
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth plan haptic-paddle --force-noise '0.1 N'\n"
            "  zwidth plan my-device.toml --force-noise '0.02 N' --length '10 cm' --precision 0.02",
            _configure_plan,
            _plan,
        ),
        "devices": Command(
            "the catalogue of real devices, each value with its source",
            "The catalogue of real devices, each value with its source; what none gives is unknown.",
            "",
            _configure_devices,
            _devices,
        ),
        "verify": Command(
            "re-check a saved proof or motion, independently of what made it",
            "Re-prove a saved certificate, or recompute the energy of a saved motion, in exact arithmetic,\n"
            "by a checker that shares no code with the prover.",
            "exit status: 0 valid or printed, 1 not valid, 2 cannot be read",
            _configure_verify,
            _verify,
        ),
    }
)
