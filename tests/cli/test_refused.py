"""What cannot be used: status 2, one line that says what was given and what is possible, and no file."""

from pathlib import Path

import pytest

from zwidth.cli.parsing import as_typed

REFUSED = {
    "": {
        "chek": ("no command", "check"),
        "check haptic-paddle --stifness 3": ("--stifness", "did you mean --stiffness"),
        "check haptic-paddle --coulomb_friction=3": "did you mean --coulomb-friction",
        "check haptic-paddle --stiff 3": "no option --stiff",
        "check haptic-paddle --quiet": "no option --quiet; see zwidth check --help",  # not --inertia
        "check haptic-paddle --kp 3": "no option --kp; did you mean --stiffness?",
        "check haptic-paddle --kd 3": "no option --kd; did you mean --virtual-damping?",
        "check haptic-paddle -b 3": "did you mean --damping or --virtual-damping?",
        "check haptic-paddle --friction 3": "did you mean --damping or --coulomb-friction?",
        "check haptic-paddle --transmission.viscous 3": "did you mean --transmission.handle-damping?",
        "check haptic-paddle --ppr 3": "did you mean --counts-per-turn or --resolution?",
        "check haptic-paddle --loop-rate 3": "did you mean --rate?",
        "check haptic-paddle --stiffness 3 --resolution '4096 counts'": "are given as counts_per_turn",
        "gains a.yaml --latency 3": "did you mean --link-delay?",
        "gains a.yaml --friction 3": "did you mean --plant?",
        "identify a.csv --dry-friction 3": "no option --dry-friction; see zwidth identify --help",
        "pair haptic-paddle --kd 3": "did you mean --virtual-damping or --local-damping?",
        "pair haptic-paddle --damping 3": "did you mean --virtual-damping?",
        "check haptic-paddle --stiffness '-0.1 N/m'": "stiffness must be ≥ 0",
        "check haptic-paddle --stiffness": "expected one argument",
        "check haptic-padle --stiffness 3": "haptic-paddle",
        "check missing.toml": "no file",
        "check haptic-paddle": "no environment",
        # --damping is the device's: what a Maxwell solid lacks is --virtual-damping
        "check haptic-paddle --type maxwell --stiffness 300": "needs --virtual-damping [N*s/m]",
        "pair excalibur --stiffness 3": ("damping", "zwidth check excalibur answers"),
        "check": "no device",
        "devices phanton": "phantom",
        "devices phantom falcon": "too many",
        "check haptic-paddle --stiffness 15 N/m": ("too many arguments: N/m", "in double quotes"),
        "verify": "FILE",
        "verify missing.json": "missing.json",
        "verify --schema sprong": ("no kind of document", 'did you mean "spring"?'),
        "verify a.json --schema spring": ("--schema", "no FILE"),
        "check haptic-paddle --stiffness=-3": "--stiffness must be ≥ 0",
        "pair haptic-paddle --stiffness 3 --link-delay x": "--link-delay is in s; got",
        "plan haptic-paddle --force-noise 0": "--force-noise must be > 0",
    },
    "check haptic-paddle --stiffness 300": {
        "--stiffness 400": "twice",
        "--rate '1 kg'": "rate is in Hz",
        "--delay 3": 'delay 3 without a unit is 3 s between sample and force; write "3 ms", or "3 s"',
        "--environment.stiffness 3": "behind a coupling",
        "--plot a.txt": ".png",
        "--plot no/such/folder/a.png": "no directory",
        "-o .": "directory",
        "-o a.svg --plot a.svg": "same file",
        "-o a.PNG": ("--save", "the name of a picture", "give --plot"),
        "-o 'a\x00b'": "cannot be written",
    },
    "check haptic-paddle --stiffness 3": {
        "--coulomb-friction -1": "haptic-paddle: --coulomb-friction must be ≥ 0 N, got -1",
        "--virtual-damping x": "command line: --virtual-damping is in N*s/m; got",
        "--sample-period=0": "haptic-paddle: --sample-period must be > 0 s",
        "--velocity-filter foo": '--velocity-filter: there is no type "foo"',
        "--active-below '2 kHz'": "--active-below must be > 0 and at most half the rate",
    },
    "limit haptic-paddle --stiffness 100 --virtual-damping 0.05": {
        "--parameter stifness": 'did you mean "stiffness"',
        "--parameter velocity-filter": "not one number",
        "--speed -1": "speed must be > 0",
        "--speed '3 N'": "speed is in m/s",
        "--seconds 0": "seconds must be > 0",
        "--effort 0": "effort must be > 0",
        "--tolerance 2": "tolerance must be a number from",
        "--resolution 0 --penetration '1 mm'": "resolution is 0",
        "--plot limit.txt": ".png",
        "--plot same.svg -o same.svg": "same file",
    },
    "emit haptic-paddle --stiffness 150 --virtual-damping 0.05 -o wall": {
        "--target toaster": "target is one of c99, arduino",
        "--target arduino --number double": "double has 32 bits on an AVR",
        "--number half": "number is double or float or fixed",
        "--travel '60 .. -60 mm'": "travel",
        "--travel '60 mm'": "travel",
        "--travel '-1000 .. 1000 km'": "more than 32 bits hold",
        "--prefix 9walls": "prefix begins names in C",
        "--target arduino --prefix guard": "guard.h is a file of the main program",
        "--number fixed --resolution unknown": "resolution",
        "--rate '990 .. 1010 Hz'": "interval",
        "--delay '0 .. 0.2 ms' --law passivity-controller": "reckon with one number",
        "--force-unit -1": "--force-unit must be > 0",
    },
    "sweep haptic-paddle": {
        "": "nothing is varied",
        "--vary latency=0:1:9 --stiffness 9": 'did you mean "delay"?',
        "--vary friction=0:1:9 --stiffness 9": 'did you mean "damping" or "coulomb_friction"?',
        "--of limit --vary rate=9,10 --stiffness 9 --parameter friction": '"damping" or "coulomb-friction"?',
        "--vary window=4 --stiffness 9": "to vary in this loop; choose from: coulomb",
        "--vary type=wall,maxwell --stiffness 9": 'no number "type" to vary',
        "--vary law.2.limit=1,2 --law saturation --stiffness 9": 'mean "law.limit"',
        "--vary stiffness": "--vary is NAME=VALUES",
        "--vary stifness=1,2": 'did you mean "stiffness"',
        "--vary rate=1,2 --vary rate=3,4": "given twice",
        "--vary stiffness=-1,2": "stiffness must be",
        "--vary delay=0:5:3 --stiffness 9": "5 without a unit is 5 s",
    },
    "sweep haptic-paddle --vary stiffness=1,2": {
        "--stiffness 3": "--stiffness is given and varied",
        "--operator.force 3": "--operator.force is no option of check",
        "--parameter rate": "--parameter is of limit",
        "--of serve": "--of is one of check",
        "--workers many": "--workers takes a whole number",
        "--plot a.txt": "must end in .png",
        "-o a.nc": "ends in .zarr or .parquet",
    },
    "map": {
        "haptic-paddle --virtual-damping 0:1": "--stiffness LOW:HIGH is missing",
        "haptic-paddle --stiffness 300 --virtual-damping 0:1": "--stiffness is a range",
        "haptic-paddle --stiffness 400:900 --virtual-damping 0:9 --certify c.json": "no wall",
        "--stiffness 0:1 --virtual-damping 0:1": "no device is given",
    },
    "map haptic-paddle --stiffness 0:600 --virtual-damping 0:0.3": {
        "--damping 0:1": "--virtual-damping LOW:HIGH",
        "--cells 40": "--cells is written NxM",
        "--cells 40xmany": "a whole number",
        "--hands fingr": "did you mean",
        "--plot map.gif": "must end in",
        "--plot a.png --certify a.png": "--plot and --certify",
        "--velocity-filter wavelet": "no type",
    },
    "simulate haptic-paddle --stiffness 770 --duration 0.2 -o kept.nc": {
        "--operator glove": 'no hand "glove"',
        "--operator finger --operator.mass -1": "mass must be",
        "--operator force-record": "needs the file",
        "--operator force-record --operator.file none.csv": "none.csv",
        "--operator witness --operator.file none.json": "none.json",
    },
    "simulate haptic-paddle --stiffness 770 --operator dowel": {
        "--duration 0.2 -o touch.xlsx": ".nc, .parquet, .csv",
        "--duration 0.2 -o no/touch.nc": "no directory",
        "--duration 0 -o kept.nc": "duration must be > 0",
        "--duration nan -o kept.nc": "duration",
        "--duration 1e9 -o kept.nc": "GiB",
        "--duration '3 m' -o kept.nc": "duration",
    },
    "simulate haptic-paddle --stiffness 770 --operator dowel --duration 0.2 -o kept.nc": {
        "--operator.force '4 kg'": ("force", "kg"),
        "--operator.stiffness 3": 'hand "dowel" has no "stiffness"',
        "--mass 0": "mass must be > 0",
        "--sample-period 0": "--sample-period must be > 0",
        "--amplifier valve": "no amplifier",
        "--amplifier lag": "amplifier_time_constant",
        "--amplifier-time-constant '1 ms'": "belong together",
        "--seed 3": "seed goes with",
        "--missed 2": "probability",
        "--points-per-sample 1.5": "whole number",
        "--encoder-phase 1": "--encoder-phase",
        "--initial-position up": "--initial-position",
        "--plot touch.gif": ".png",
        "--sound touch.mp3": ".wav",
    },
    "plan": {
        "haptic-paddle": "--force-noise",
        "--force-noise 0.1": "no device",
        "phantom --force-noise 0.1": "mass",
        "--inertia 2e-4 --damping 1e-3 --rate 1000 --force-noise 1e-3": "90 deg",
    },
    "plan haptic-paddle --force-noise '0.1 N'": {
        "--slow 0.1": "longer",
        "--length '3 N'": "length",
    },
    "serve haptic-paddle --stiffness 50 --connection hapkit --connection.port x --connection.count": {
        "'1 s'": "count",
        "1e-5 --connection.sense 1.5": "sense is 1 or -1",  # it is not rounded
        "'1 um' --operator finger": "held by a person",  # that of a simulated one is not
    },
    "serve haptic-paddle --stiffness 50": {
        "--connection odrve": 'did you mean "odrive"',
        "--connection odrive": "needs port",
        "--connection odrive --connection.port x --connection.count '1 mm'": "has no",
        "--connection odrive --connection.port x --connection.axis 1.5": "whole number",
        "--connection odrive --connection.port /dev/none": "rotary",
        "--connection.origin '1 mm'": "leave out origin",
        "--safety.force '-1 N'": "> 0",
        "--safety.bad-answers 1.5": "number of samples",
        "--watch wall": "terminal, browser, foxglove",
        "--watch terminal --watch-port 1": "--watch-port goes with",
        "--watch browser --watch-origin https://app.example": "goes with --watch foxglove",
        "--watch foxglove --watch-origin null": "is no origin of pages",
        "--operator fingr": "did you mean",
        "-o session.csv": "ends in .mcap",
        "-o session.parquet": "zwidth replay run.mcap -o run.nc",
        "--duration '0 s'": "> 0",
    },
    "explore --no-browser": {
        "--port 70000": "--port is a port",
        "--token short": "16 characters or more",
        "no-such-device": "neither a file nor a device",
    },
    "compare haptic-paddle": {
        "--stiffness 400 --laws wall --fastest fast": "fastest",
        "--stiffness 400 --laws magic": 'no law "magic" for this device',
        "--type maxwell --branch-stiffness 3 --branch-damping 1": "",
    },
    "workspace": {
        "haply-2diy --stiffness 100": "no source gives the joint damping",
        "haply-2diy --joint-damping 0.1,0.2,0.3 --stiffness 1": "one for each",
        "phantom --joint-damping 0.1 --stiffness 1": "built in are",
        "missing.urdf --stiffness 1": "missing.urdf",
    },
    "workspace haply-2diy --joint-damping 0.1": {
        "": "which wall",
        "--stiffness 1 --hold a=1": "for descriptions",
        "--stiffness 1 --pose": "has no pose",
    },
    "workspace two-link --joint-damping 0.1": {
        "--rotational-stiffness 1": "add --pose",
        "--pose": "which wall",
        "--wall w.toml": "no file",
        "--wall w.toml --stiffness 1": "leave out --stiffness",
        "--stiffness 1 --points 2.5": "whole number",
        "--stiffness 1 --rest a=1": "add --pose",
        "--stiffness 1 --torque-held-up-to 1,2,3": "a moment",
        "--stiffness 1 -o proof.jsn": "a file must end in .json for the verdict",
        "--stiffness 1 --delay '0.3 ms'": "whole number of samples",
        "--stiffness 1 --delay 3": "got 3 s, 3000 at 1 kHz",
        "--stiffness 1 --largest-force 3": "--joint-resolution 0.001",
        "--stiffness 1 --largest-force 1,2,3": "--largest-force: a force",
    },
}
"""By how a line begins, how it goes on; and what the message says of it."""


@pytest.mark.parametrize(
    ("line", "said"),
    [(f"{start} {rest}", said) for start, rows in REFUSED.items() for rest, said in rows.items()],
)
def test_what_cannot_be_used_is_one_line(refused, line, said):
    """An option is named as it was typed, and not twice."""
    message = refused(line)
    for part in [said] if isinstance(said, str) else said:
        assert part in message
    assert "----" not in message
    assert not list(Path().iterdir())


def test_words_that_only_look_like_it_stay():
    """A key of a file that nobody typed, the value typed, an everyday word in the middle."""
    assert as_typed("a.toml: damping must be > 0", ["check", "a.toml"]) == "a.toml: damping must be > 0"
    assert as_typed("the rate is too low", ["--rate", "3"]) == "the rate is too low"
    assert as_typed('rate is in Hz; got "rate"', ["--rate", "rate"]) == '--rate is in Hz; got "rate"'
    assert as_typed("damping is in N", ["--virtual-damping", "1", "--damping", "x"]) == "--damping is in N"
