"""The subcommands.  `COMMANDS` is the registry: a new command is one row here, and a file of its name.

In the file `OPTIONS` are what it takes, `USAGE` says it in a line, `run` does what the command does.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.cli.parsing import Helping, add_options


class Command(NamedTuple):
    """A subcommand: the folder of its file, what it does; the name of the file where that is another one."""

    folder: str
    meaning: str
    description: str
    epilog: str
    file: str = ""


def configure(name: str, parser: argparse.ArgumentParser) -> None:
    module = _module(name)
    if hasattr(module, "USAGE"):
        parser.usage = f"%(prog)s {module.USAGE}"
    parser.add_argument(
        "-h", "--help", action=Helping, nargs="?", metavar="all", help="the first options, or all, and leave"
    )
    add_options(parser, module.OPTIONS)


def run(name: str, arguments: argparse.Namespace) -> int:
    """Run a command; its exit status."""
    status: int = _module(name).run(arguments)
    return status


def _module(name: str) -> Any:
    own = COMMANDS[name]
    return import_module(f"zwidth.cli.{own.folder}.{own.file or name}")


COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        "tour": Command(
            "start",
            "a wall that gives out energy, why, and what mends it: in a minute",
            "Go through the questions of this program on one device, a paddle: the commands that ask\n"
            "them are run, and what they find is shown in short. Nothing is written.",
            "In a terminal every step waits for Enter; q ends the tour.\n\n"
            "examples:\n"
            "  zwidth tour\n"
            "  zwidth tour --no-pause",
        ),
        "examples": Command(
            "start",
            "sample files for every command, and lessons for a class",
            "List the sample files with a command for each, or copy them into a folder.",
            "exit status: 0, or 2 where a file exists or cannot be written\n\n"
            "examples:\n"
            "  zwidth examples\n"
            "  zwidth examples .\n"
            "  zwidth examples my-first-walls",
        ),
        "new": Command(
            "new",
            "write the file of your device, question by question",
            "Ask what you know of a device or of what it renders, say why it matters, and write it as TOML.",
            "In a terminal, and from a pipe, what no option gives is asked, line by line: a value with its\n"
            "unit, or Enter where you do not know. With --no-questions only the options count.\n\n"
            "exit status: 0 written, 2 bad input\n\n"
            "examples:\n"
            "  zwidth new device\n"
            '  zwidth new environment --type wall --motion linear --stiffness "200 N/m" --no-questions\n'
            '  zwidth new device my-knob.toml --motion rotary --damping "2e-4 N*m*s/rad" --rate "2 kHz" '
            "--no-questions",
        ),
        "check": Command(
            "check",
            "is this device, rendering this environment, passive?",
            "Prove that the sampled loop is passive, or find the hand motion that takes energy out of it;\n"
            "say what limits it, by how much, and what to change.",
            'A plain number is SI; others carry a unit, as in --rate "1 kHz" or --resolution "22.4 um".\n'
            'An interval, as in --damping "0.1 .. 0.2", stands for every value in it.\n\n'
            "exit status: 0 passive, 1 active, 2 bad input, 3 undecided, 4 passive while contact is kept\n"
            "(and nothing is known of a hand that touches and leaves); with --contact kept that is 0\n\n"
            "examples:\n"
            "  zwidth check haptic-paddle --stiffness 300\n"
            "  zwidth check my-wheel.toml my-bumpstop.toml --json\n"
            '  zwidth check --damping 0.2 --rate "2 kHz" --stiffness 500 --virtual-damping 0.05',
        ),
        "report": Command(
            "check",
            "the verdict as one page to hand on",
            "Decide as zwidth check does, and write verdict, scope, proof, figures, what to change, and\n"
            "where each number comes from into one file that needs nothing else. The same input gives the\n"
            "same bytes.",
            "The file ends in .html: a page without script and without addresses abroad. For a PDF print it\n"
            "from the browser.\n\n"
            "exit status: as of zwidth check: 0 passive, 1 active, 2 bad input, 3 undecided, 4 passive\n"
            "while contact is kept\n\n"
            "examples:\n"
            "  zwidth report haptic-paddle --stiffness 300 -o report.html\n"
            "  zwidth report my-wheel.toml my-bumpstop.toml -o wheel.html",
            file="report_file",
        ),
        "limit": Command(
            "check",
            "how far may a parameter go?",
            "Bracket a limit: the last value that is proved passive, and the first at which a motion of the\n"
            "hand takes energy out, contact made and broken at will.",
            'A plain number is SI; others carry a unit, as in --penetration "2 mm". A parameter is\n'
            "named as its option is: --parameter virtual-damping, --parameter rate, …\n\n"
            "exit status: 0 both sides found, 2 bad input, 3 one side or none found\n\n"
            "examples:\n"
            "  zwidth limit haptic-paddle --stiffness 100 --virtual-damping 0.05\n"
            '  zwidth limit haptic-paddle --stiffness 100 --virtual-damping 0.05 --speed "0.5 m/s"\n'
            "  zwidth limit my-wheel.toml my-wall.toml --parameter rate -o limit.json",
        ),
        "explore": Command(
            "start",
            "move every parameter on a page, and see the verdict follow",
            "Open a page in the browser: the device and the wall on sliders, the verdict beside them, and\n"
            "pictures of both. The address keeps the loop. It answers this machine alone, unless --address\n"
            "says otherwise, and then asks for a token.",
            "examples:\n"
            "  zwidth explore\n"
            "  zwidth explore haptic-paddle\n"
            "  zwidth explore my-wheel.toml my-bumpstop.toml --no-browser --port 5100",
        ),
        "pair": Command(
            "pair",
            "are two arms that follow each other passive?",
            "Two arms, leader and follower, joined by a spring and a damper over a link: prove that no two\n"
            "hands take energy out, or find the motion of both that does; say what limits it, and what to\n"
            "change.",
            'A plain number is SI; others carry a unit, as in --link-delay "2 ms". --virtual-damping and\n'
            "--local-damping are of the coupling; the damping of an arm is that of its device.\n\n"
            "exit status: 0 passive, 1 active, 2 bad input, 3 undecided\n\n"
            "examples:\n"
            "  zwidth pair haptic-paddle --stiffness 100\n"
            '  zwidth pair leader.toml follower.toml --stiffness 100 --link-delay "2 ms"\n'
            '  zwidth pair my-pair.toml --link-delay "5 ms" -o pair.json',
        ),
        "gains": Command(
            "pair",
            "are two arms passive with the gains of these files?",
            "Read the gain files of two arms (OpenArm, i2rt YAM, LeRobot, Piper), joint by joint: which are\n"
            "passive, how stiff each may be, and which gains would be passive. Of one arm in ROS 2\n"
            "(ros2_control) each joint is decided by itself.",
            "What no gain file says, such as friction of the joints, rate and delay of the link, is\n"
            "published or assumed where it is not given, and the report says which.\n\n"
            "exit status: 0 every joint passive, 1 one is active, 2 bad input, 3 one is undecided, or the\n"
            "leader feels nothing and there is no law of both arms\n\n"
            "examples:\n"
            '  zwidth gains leader.yaml follower.yaml --plant my-arm.toml --link-delay "2 ms"\n'
            "  zwidth gains yam.yml --bilateral-kp 0.1 --ideal-drive\n"
            '  zwidth gains so101.json --supply-voltage "7.4 V" --both\n'
            "  zwidth gains controllers.yaml --plant my-arm.toml",
        ),
        "each": Command(
            "check",
            "the same question of each of several devices, in a table",
            "Check one wall, or another law, on each of several devices: a class, a batch, one device as\n"
            "several people measured it. On how many it is passive, up to where on each and on all of\n"
            "them; beside it what was measured.",
            'Devices with ranges, such as --damping "0.1 .. 0.2" in their files, count with all of them.\n\n'
            "exit status: that of the worst device: 1 active, 3 undecided, 4 passive while contact is\n"
            "kept, 0 all passive; 2 bad input\n\n"
            "examples:\n"
            "  zwidth each haptic-paddle hapkit --stiffness 200\n"
            "  zwidth each paddle.toml hapkit.toml haptic-paddle --stiffness 150 -o class.csv",
        ),
        "map": Command(
            "study",
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
        ),
        "sweep": Command(
            "study",
            "the same question of a thousand loops",
            "Vary parameters over a grid, and ask of each loop what check, limit, simulate or pair answers.\n"
            "The results are a table of Parquet, or a zarr store that opens as labelled xarray.",
            "A plain number is SI; in a range and in a list the unit may stand once, behind the last one.\n"
            "Stopped, even killed, the same command goes on with what is missing.\n\n"
            "exit status: 0, or 2 on bad input; 130 interrupted (what was finished is kept)\n\n"
            "examples:\n"
            '  zwidth sweep haptic-paddle --vary stiffness=50:600:40 --vary "delay=0:5 ms:20" '
            "--plot sweep.png\n"
            '  zwidth sweep my-wheel.toml my-bumpstop.toml --vary "rate=500:8000:20 log" -o sweep.parquet\n'
            '  zwidth sweep haptic-paddle --of simulate --operator finger --duration "1 s" '
            "--vary stiffness=100:2000:20 -o touches.zarr\n"
            '  zwidth sweep haptic-paddle --vary stiffness=1:3000:1000 --vary "delay=0:5 ms:1000" '
            "-o big.zarr --dask tcp://cluster:8786",
        ),
        "play": Command(
            "start",
            "a page on which a loop is held, pushed and heard",
            "Write a page of HTML on which a person holds the handle and pushes into the wall: device, hand\n"
            "and law run in it sample by sample, force is drawn and heard, energy is counted.",
            "The page asks nothing of a network and holds the verdict on each loop.\n\n"
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth play\n"
            "  zwidth play haptic-paddle --stiffness 770\n"
            "  zwidth play my-wheel.toml my-bumpstop.toml -o play.html",
        ),
        "simulate": Command(
            "simulate",
            "what happens when a hand touches the wall?",
            "Simulate a hand on the device, without time-step error: positions, forces, every joule.",
            'A plain number is SI; others carry a unit, as in --duration "2 s" or --operator.force "4 N".\n\n'
            "exit status: 0 simulated, 2 bad input, 130 interrupted (what was finished is kept)\n\n"
            "examples:\n"
            "  zwidth simulate haptic-paddle --stiffness 770 --operator dowel --duration 2 --plot touch.png\n"
            "  zwidth simulate haptic-paddle --stiffness 300 --operator malicious --duration 1 -o touch.nc\n"
            "  zwidth simulate haptic-paddle --stiffness 770 --law passivity-controller --operator dowel "
            "--duration 2\n"
            "  zwidth simulate my-wheel.toml my-touch.toml --sound buzz.wav\n"
            "  zwidth simulate my-arms.toml --operator finger --follower-operator wall "
            '--follower-operator.stiffness "2 kN/m" --duration 1',
        ),
        "serve": Command(
            "machine",
            "render a wall on a device, in real time",
            "Reach the device, measure this machine and the link with force 0, prove the wall passive with\n"
            "what was measured, and render it until the time is over, Ctrl-C, or a fault. The force is 0\n"
            "before, after, and whenever something is wrong.",
            "Without --connection the device is simulated, in the hand of --operator (default:\n"
            "a finger; of what turns fingers on a knob, or from 0.0003 kg*m^2 on hands on a wheel).\n"
            "A plain number is SI; others carry a unit. What is not proved passive is refused.\n\n"
            "exit status: 0 served to the end; 2 bad input; 5 a fault ended the force or the recording;\n"
            "not served: 1 active, 3 undecided, 4 passive while contact is kept\n\n"
            "examples:\n"
            "  zwidth serve haptic-paddle --stiffness 250 --watch terminal\n"
            "  zwidth serve my-knob.toml --connection odrive --connection.port /dev/ttyACM0 "
            '--safety.force "0.1 N*m" -o session.mcap\n'
            "  zwidth serve my-inverse.toml --connection inverse --stiffness 200 --watch browser",
        ),
        "emit": Command(
            "machine",
            "a law that was proved, as C99 or JavaScript",
            "Write the law as text for the machine that will run it: a C99 header or an ES module with\n"
            "init, step and reset, a main program for the target, and the certificate. How much the\n"
            "target's numbers round is bounded and is in the verdict.",
            "A law that is not proved passive in the target's numbers is not written, unless --anyway\n"
            "is given.\n\n"
            "exit status: 0 written, 1 active, 2 bad input, 3 undecided, 4 passive while contact is kept\n\n"
            "examples:\n"
            '  zwidth emit haptic-paddle --stiffness 250 --target arduino --travel "-50 .. 50 mm" -o paddle\n'
            "  zwidth emit my-wheel.toml my-bumpstop.toml --target cortex-m --number fixed -o wheel\n"
            "  zwidth emit haptic-paddle --stiffness 250 --target javascript -o page",
        ),
        "replay": Command(
            "machine",
            "what a recording of a served loop holds, and whether its law gives those forces again",
            "Read a recording, whole or cut off; compute its laws again from the readings, and compare the\n"
            "forces with those that were given, bit by bit.",
            "exit status: 0 the same forces, 1 others, 2 bad input\n\n"
            "examples:\n"
            "  zwidth replay session.mcap --plot session.png\n"
            "  zwidth replay session.mcap -o session.nc",
        ),
        "doctor": Command(
            "machine",
            "is this machine fit to run the loop?",
            "Run an empty loop at the device's rate, and say how late it comes, what that costs the device\n"
            "in stiffness, and what of this machine to change.",
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth doctor\n"
            '  zwidth doctor haptic-paddle --stiffness 250 --duration "10 s" --plot lateness.png',
        ),
        "network": Command(
            "machine",
            "run a scene in several processes, with the devices that hold it",
            "Start a process for each part of a scene and for each device, join them by lines over shared\n"
            "memory, UDP or Zenoh, and say what each saw: pace, delay, losses, energy.",
            "A file has the scene in [environment], and in [network] who runs what. On several machines\n"
            "give --run NAME on each, with channels that reach the others.\n\n"
            "exit status: 0 all ran to the end, 1 one of them did not, 2 bad input, 130 interrupted\n\n"
            "examples:\n"
            '  zwidth network room.toml --duration "10 s"\n'
            "  zwidth network room.toml --run bed\n"
            "  zwidth network room.toml --plan",
        ),
        "traces": Command(
            "simulate",
            "compare saved touches",
            "Read traces that zwidth simulate saved, and set their numbers beside each other.",
            "example:\n  zwidth traces finger.nc dowel.nc --plot both.png",
        ),
        "compare": Command(
            "study",
            "which rendering law suits this wall on this device?",
            "Put rendering laws on one bench: the same touches, the same hand that tries to take energy\n"
            "out; what is felt, what is given out, and what is proved.",
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            "  zwidth compare haptic-paddle --stiffness 2000\n"
            "  zwidth compare haptic-paddle --stiffness 2000 --laws virtual-damping,passivity-controller "
            "--plot laws.png\n"
            "  zwidth compare my-paddle.toml my-laws.toml --laws wall,virtual-damping\n"
            "  zwidth compare my-arms.toml",
        ),
        "links": Command(
            "pair",
            "which port joins two devices over a link that loses packets?",
            "Join two devices over one link by each kind of port: which is passive whatever the link does,\n"
            "what two hands take out of the others, how the follower follows, what the leader feels.",
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            '  zwidth links haptic-paddle --delay "20 ms" --loss 0.5\n'
            '  zwidth links leader.toml follower.toml --delay "20 ms" --jitter "10 ms" --loss 0.5 --burst 4 '
            "--plot links.png",
        ),
        "workspace": Command(
            "workspace",
            "where does an arm of several joints render a wall passively?",
            "Map over the workspace of an arm whether the damping of its joints pays for a wall; prove it\n"
            "between the points too, or show a motion that takes energy out; say which joint to damp.",
            "exit status: 0 passive, 1 active, 2 bad input, 3 undecided, 4 by a proof on paper alone\n\n"
            "examples:\n"
            "  zwidth workspace haply-2diy --joint-damping 0.003 --stiffness 500 --plot map.png\n"
            '  zwidth workspace two-link --joint-damping 0.02,0.01 --stiffness 500 --rate "2 kHz"\n'
            "  zwidth workspace my-arm.urdf --stiffness 500\n"
            '  zwidth workspace my-arm.urdf --pose --stiffness 500 --rotational-stiffness "20 N*m/rad"',
        ),
        "identify": Command(
            "data",
            "mass, damping and friction of a device, from a log of its motion",
            "Identify a device from a log of position and force: numbers with intervals, the stiffest wall\n"
            "they allow, and for how much of what the data allow an environment is passive.",
            "A log is text, Parquet, HDF5, NetCDF, MATLAB, a ROS bag or a trace. Columns whose names are\n"
            "not recognised are named: --column position=enc --unit position=counts.\n\n"
            "exit status: 0 identified, 2 bad input; with an environment that of zwidth check at the stated\n"
            "confidence: 0 passive, 1 active, 3 undecided, 4 passive while contact is kept\n\n"
            "examples:\n"
            "  zwidth identify session.csv -o my-device.toml --plot fig.png\n"
            "  zwidth identify counts.csv --column position=enc --unit position=counts "
            '--resolution "22.4 um" --stiffness 250\n'
            '  zwidth identify swing.csv --mass "36 g"',
        ),
        "tissue": Command(
            "data",
            "which tissue was it, and how much of it may a device render?",
            "Read a relaxation, creep or loading test of a probe in tissue from a spreadsheet: the model,\n"
            "its numbers with intervals, and the largest scale of it that is proved passive on a device.",
            'Columns and units are known by their names; others are named: --column force="Ch 2" --unit\n'
            "force=mN. Semicolons, decimal commas, units in a row of their own are read.\n\n"
            "exit status: 0 fitted, 2 bad input; with a device that of zwidth check: 0 passive, 1 active,\n"
            "3 undecided, 4 passive while contact is kept\n\n"
            "examples:\n"
            "  zwidth tissue relaxation.csv\n"
            "  zwidth tissue relaxation.csv phantom -o my-tissue.toml --plot tissue.png\n"
            "  zwidth tissue creep.csv --column indentation=z --unit indentation=um --kind creep",
        ),
        "diagnose": Command(
            "data",
            "why did it shake? One recording of a vibration, its cause, what to change",
            "Find in a log of a vibrating wall, wheel or joint what keeps it going: sampling, a delay, the\n"
            "velocity estimate, the encoder, the drive, friction, the motor's limits or a springy part;\n"
            "with how sure, which frequency, which energy, and the one number to change.",
            "A log holds time, position and the actuator's force: what the law asked for (commanded_force),\n"
            "what the motor gave (actuator_force), best both, at every sample of the loop.\n\n"
            "exit status: 0 a cause is named, 2 bad input, 3 the data do not say\n\n"
            "examples:\n"
            "  zwidth diagnose shaking.csv shaking.toml\n"
            "  zwidth diagnose wheel.csv my-wheel.toml --plot why.png -o mended.toml\n"
            "  zwidth diagnose log.csv --column commanded_force=cmd --unit commanded_force=N",
        ),
        "plan": Command(
            "data",
            "how to move a device by hand so that its limit becomes known",
            "Plan the experiment for zwidth identify: which strokes, how many, how long, and when to stop.",
            "The guess of the device may be rough: after each run the data decide.\n\n"
            "exit status: 0, or 2 on bad input\n\n"
            "examples:\n"
            '  zwidth plan haptic-paddle --force-noise "0.1 N"\n'
            '  zwidth plan my-device.toml --force-noise "0.02 N" --length "10 cm" --precision 0.02',
        ),
        "devices": Command(
            "start",
            "the catalogue of real devices, each value with its source",
            "The catalogue of real devices, each value with its source; what none gives is unknown.",
            "",
        ),
        "completion": Command(
            "start",
            "let the shell complete commands, options, devices and files",
            "Print what makes bash, zsh or fish complete the words of zwidth.",
            "Put the line into the file that your shell reads when it starts:\n"
            '  bash  eval "$(zwidth completion bash)"\n'
            '  zsh   eval "$(zwidth completion zsh)"    after compinit\n'
            "  fish  zwidth completion fish | source",
        ),
        "verify": Command(
            "check",
            "re-check a saved proof or motion, independently of what made it",
            "Re-prove a saved certificate, or recompute the energy of a saved motion, in exact arithmetic,\n"
            "by a checker that shares no code with the prover.",
            "exit status: 0 valid or printed, 1 not valid, 2 cannot be read",
        ),
    }
)
