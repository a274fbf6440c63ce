"""The command `gains`: gain files of two arms, joint by joint."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.decision import exit_status
from zwidth.cli.options import FORCE, IN_FULL, look_for
from zwidth.cli.output import give_out, print_found, printed, targets
from zwidth.errors import InputError
from zwidth.model.specification.read import question_unit
from zwidth.quantity.text import save_json, to_json
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.data.gains import ArmGains, Controllers, GainsVerdict


USAGE = "FILE [FILE] [--link-delay TIME] [--rate RATE] [--plant FILE] [--OPTION VALUE ...]"
OPTIONS = (
    {"files=FILE+": "gain file of both arms, or of leader and follower: YAML, JSON or TOML"},
    "output",
    {
        **IN_FULL,
        "--json": "print the verdicts as JSON, units in the keys",
        "-o FILE": "save verdicts and proofs as JSON, for zwidth verify; of one arm in ROS 2 a .yaml: gains "
        "that are proved, as its parameters",
        "--joint NAME": "the whole report on one joint, as zwidth pair gives it",
        "--plot FILE": "with --joint: save its plots, .png, .svg or .pdf",
        **FORCE,
    },
    "gains that are written: with -o FILE.yaml, of one arm in ROS 2",
    {
        "--share S": "of each joint's damping, that they may use (default: 0.8)",
        "--stiffest": "the stiffest that are proved, in the place of those nearest to the file",
    },
    "arms: what no gain file says; said in the report where it is not given",
    {
        "--plant FILE": "TOML with damping, coulomb_friction, resolution of the joints, or a published name",
        "--rate 1/T": "of the references on the bus [Hz]",
        "--link-delay τ_link": "from one arm's reading to the other's controller, or each way [s]",
        "--link-delay-back τ_link": "from follower to leader, where it is another [s]",
        "--drive-rate RATE": "of the loop in each drive [Hz]; 0: there is none",
        "--ideal-drive": "what a drive does with its own speed is a damper, at once and without steps",
    },
    "law",
    {
        "--family NAME": "openarm, i2rt, lerobot-damiao, lerobot-feetech or piper (default: by the keys)",
        "--bilateral-kp β": "of i2rt: the leader's kp in multiples of the file's (default: 0.2)",
        "--supply-voltage U": "of servos whose stiffness goes with it [V]",
        "--both": "take the follower's gains on both sides of an arm whose leader is limp",
        "--no-compensation": "leave out the compensation of friction",
    },
)


_OF_TWO = "joint plot drive_rate bilateral_kp supply_voltage link_delay_back both ideal_drive no_compensation"


def run(arguments: argparse.Namespace) -> int:
    """`zwidth gains`: the status says the outcome; 3 where no law of both arms is known."""
    from zwidth.data.gains import check_gains, read_gains
    from zwidth.data.gains.controllers import is_of_controllers
    from zwidth.data.gains.file import read_table

    plant, (first, *others) = arguments.plant or "", arguments.files
    look_for([first, *others, *([plant] if plant.endswith(".toml") else [])])
    if arguments.family is None and not others and is_of_controllers(read_table(first)):
        return _held(arguments)
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if arguments.share is not None or arguments.stiffest or _is_yaml(save):
        raise InputError(
            "gains are written as .yaml of one arm with a parameter file of ros2_control; these are of "
            "another kind: save their verdicts as .json, and leave out --share and --stiffest"
        )
    if plot is not None and arguments.joint is None:
        raise InputError("--plot draws one joint: give --joint too, such as --joint J1")
    gains = read_gains(
        *arguments.files,
        family=arguments.family,
        bilateral_kp=arguments.bilateral_kp,
        supply_voltage=arguments.supply_voltage,
        both=arguments.both,
    )
    if not gains.is_pair:
        return _told(gains, arguments.json, save or arguments.joint)
    verdict = check_gains(
        gains,
        plant=arguments.plant,
        rate=arguments.rate,
        delay=_delay(arguments),
        drive_rate=arguments.drive_rate,
        ideal_drive=arguments.ideal_drive,
        compensated=not arguments.no_compensation,
    )
    if arguments.joint is not None:
        return _of_one(verdict, arguments, plot, save)
    report = printed("pair.gains_report:print_gains", verdict, arguments.in_full)
    give_out(verdict, save, None, arguments.json, report)
    return exit_status(verdict.outcome)


def _held(arguments: argparse.Namespace) -> int:
    """The joints of one arm, each held at a target by the spring of its controller."""
    from zwidth.data.gains import check_controllers, passive_gains, read_controllers

    for option in _OF_TWO.split():
        if getattr(arguments, option) not in (None, False):
            name = option.replace("_", "-")
            raise InputError(f"--{name} is of two arms; these are the gains of one arm: leave it out")
    save = _target(arguments)
    controllers = read_controllers(arguments.files[0])
    if not controllers.joints and controllers.cartesian:
        if save is not None:
            raise InputError(
                "an impedance at the end takes the arm to decide: nothing to save here; zwidth workspace "
                f"ARM.urdf --pose --wall {arguments.files[0]} --postures 20000 has its own -o FILE.yaml"
            )
        return _cartesian(controllers, arguments)
    if arguments.plant is None:
        raise InputError(
            "no gain file gives the damping of the joints, and it decides: give --plant with a TOML file "
            "that has [arm] damping = … and coulomb_friction = …"
        )
    asked = (controllers, arguments.plant, arguments.rate, arguments.link_delay)
    found = check_controllers(*asked)
    better = None
    if _is_yaml(save):
        share = {} if arguments.share is None else {"share": arguments.share}
        better = passive_gains(*asked, **share, stiffest=arguments.stiffest)
    if save is not None:
        (found if better is None else better).save(save)
    report = printed("pair.gains_report:print_held", found, better)
    print_found(arguments.json, lambda: to_json(found.to_dict()), report, save)
    return exit_status(found.outcome)


def _is_yaml(path: Path | None) -> bool:
    return path is not None and path.suffix.lower() in (".yaml", ".yml")


def _target(arguments: argparse.Namespace) -> Path | None:
    """The file to write for one arm: gains as .yaml, verdicts as .json; never the file that was read."""
    _, save = targets(None, arguments.save, arguments.force)
    if not _is_yaml(save):
        if arguments.share is not None or arguments.stiffest:
            raise InputError("--share and --stiffest are of gains that are written: add -o passive.yaml")
        if save is not None and save.suffix.lower() != ".json":
            raise InputError(f"-o: of one arm .yaml is for gains, .json for verdicts, got {save.name!r}")
    elif save is not None and save.exists() and save.samefile(arguments.files[0]):
        raise InputError(f"{save} is the file that is read, and has more than gains; choose another name")
    return save


def _cartesian(controllers: Controllers, arguments: argparse.Namespace) -> int:
    """An impedance at the end: what it is, and which command decides it."""
    report = printed("pair.gains_report:print_cartesian", controllers, arguments.files[0])
    document = {"outcome": "undecided", **controllers.to_dict()}
    print_found(arguments.json, lambda: to_json(document), report)
    return exit_status("undecided")


def _of_one(
    verdict: GainsVerdict, arguments: argparse.Namespace, plot: Path | None, save: Path | None
) -> int:
    pair, notes = verdict.joint(arguments.joint).verdict, {"notes": list(verdict.notes)}
    if save is not None:
        save_json(save, {**pair.saved(), **notes})
    if plot is not None:
        pair.plot(plot)
    report = printed("pair.gains_report:print_joint", pair, verdict.notes, arguments.in_full)
    print_found(arguments.json, lambda: to_json({**pair.to_dict(), **notes}), report, save, plot)
    return exit_status(pair.outcome)


def _told(gains: ArmGains, as_json: bool, asked: Path | str | None) -> int:
    """Gains of a follower alone: what they are, and no verdict."""
    if asked is not None:
        raise InputError(
            f"there is no law of both arms, so there is no verdict for {asked}; --both makes one"
        )
    print_found(as_json, lambda: to_json(gains.to_dict()), printed("pair.gains_report:print_follower", gains))
    return exit_status("undecided")


def _delay(arguments: argparse.Namespace) -> tuple[str, str] | None:
    there, back = arguments.link_delay, arguments.link_delay_back
    if there is None and back is not None:
        raise InputError("--link-delay-back is of one way alone; give --link-delay, of the other, too")
    for option, value in (("--link-delay", there), ("--link-delay-back", back)):
        if value is not None:
            question_unit(value, parse_number(value, "s", option), option)
    return None if there is None else (there, there if back is None else back)
