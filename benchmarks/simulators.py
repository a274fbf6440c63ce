"""Nanoseconds per sample and largest position error of zwidth and of what one could use instead.

One task for all, `rivals/task.py`: a quantized, sampled wall touched by a device with
Coulomb and viscous friction.  Each rival runs in a process of its own, warm, several
times; the positions at the samples of the first two seconds are compared with a solution
in 50 digits.  The rivals are installed, on first use, into `.venv` beside this file;
one that cannot be installed, or fails, is listed with the reason.

    python benchmarks/simulators.py                 everything
    python benchmarks/simulators.py drake mujoco    zwidth, and the rivals so called
    python benchmarks/simulators.py --install       install again first
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
FOLDER = HERE / ".venv"
PYTHON = FOLDER / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
INSTALLED = FOLDER / "rivals.json"
REQUIREMENTS = HERE / "simulators-requirements.txt"
LIMIT = 600
"""Longest run of one rival [s]."""


@dataclass(frozen=True)
class Rival:
    """A row of the table: `command` is a script in `rivals/` and its arguments."""

    name: str
    command: tuple[str, ...]
    package: str = ""
    """What it needs of the requirements."""
    ours: bool = False
    """Runs in the environment of this script, not in that of the rivals."""
    compared: bool = True
    """Simulates the whole task, so that its positions mean something."""


ROWS = (
    Rival("zwidth: `zw.simulate`, the whole call", ("by_zwidth", "call"), ours=True),
    Rival("zwidth: its compiled kernel alone", ("by_zwidth", "kernel"), ours=True),
    Rival(
        "zwidth: `zw.simulation.simulate_batch`, the whole call, 1 thread",
        ("by_zwidth", "batch", "1"),
        ours=True,
    ),
    Rival(
        "zwidth: `zw.simulation.simulate_batch`, the whole call, 2 threads",
        ("by_zwidth", "batch", "2"),
        ours=True,
    ),
    Rival("exact step in C, positions and four energies", ("exact_c", "simulate")),
    Rival(
        "chain x → floor → force → x in C: the limit of one simulation",
        ("exact_c", "chain"),
        "",
        False,
        False,
    ),
    Rival("Drake, C++ diagram, v_s = 1e-2 m/s, RK2, steps of T", ("drake_diagram", "fixed", "1e-2"), "drake"),
    Rival("Drake, C++ diagram, v_s = 1e-3 m/s, accuracy 1e-3", ("drake_diagram", "1e-3", "1e-3"), "drake"),
    Rival("Drake, C++ diagram, v_s = 1e-4 m/s, accuracy 1e-6", ("drake_diagram", "1e-6", "1e-4"), "drake"),
    Rival("Drake, Python system with witness, accuracy 1e-9", ("drake_witness",), "drake"),
    Rival("MuJoCo, hardened frictionloss, dt = T", ("mujoco_frictionloss", "Euler", "1"), "mujoco"),
    Rival("MuJoCo, hardened frictionloss, dt = T/10", ("mujoco_frictionloss", "Euler", "10"), "mujoco"),
    Rival("MuJoCo, the same with RK4, dt = T", ("mujoco_frictionloss", "RK4", "1"), "mujoco"),
    Rival("MuJoCo, the same with RK4, dt = T/10", ("mujoco_frictionloss", "RK4", "10"), "mujoco"),
    Rival("scipy solve_ivp per sample, RK45, rtol 1e-9, events", ("scipy_per_sample",), "scipy"),
    Rival("python-control, restarted per sample, v_s = 1e-4 m/s", ("control_per_sample",), "control"),
    Rival("semi-implicit Euler in Python, h = T", ("euler", "1")),
    Rival("semi-implicit Euler in Python, h = T/100", ("euler", "100")),
)


def install(again: bool) -> dict[str, str]:
    """Install what is missing; the reason per package that could not be, "" for the others."""
    requirements = REQUIREMENTS.read_text().split()
    known = json.loads(INSTALLED.read_text()) if INSTALLED.exists() and not again else {}
    if not PYTHON.exists():
        print(f"creating {FOLDER}", file=sys.stderr)
        venv.create(FOLDER, with_pip=True, clear=True)
        known = {}
    for requirement in requirements:
        if known.get(requirement) != "":
            print(f"installing {requirement}", file=sys.stderr)
            known[requirement] = failure([str(PYTHON), "-m", "pip", "install", "--quiet", requirement])
    INSTALLED.write_text(json.dumps(known))
    return {r.split(">=")[0]: known[r] for r in requirements}


def failure(command: list[str]) -> str:
    """Run it; "" or the last line of its complaint."""
    quiet = os.environ | {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_NO_INPUT": "1"}
    run = subprocess.run(command, capture_output=True, text=True, check=False, env=quiet)
    return "" if run.returncode == 0 else last_line(run.stderr)


def versions(packages: set[str]) -> str:
    """The installed versions of the rivals."""
    run = subprocess.run(
        [str(PYTHON), "-m", "pip", "list", "--format=json"], capture_output=True, text=True, check=True
    )
    found = {p["name"].lower(): p["version"] for p in json.loads(run.stdout)}
    return ", ".join(f"{name} {found[name]}" for name in sorted(packages & found.keys()))


def last_line(text: str) -> str:
    """The last line that says something."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else "no message"


def answer(command: tuple[str, ...], ours: bool = False) -> dict:
    """What a script in `rivals/` prints, or {"failed": why}."""
    script = HERE / "rivals" / f"{command[0]}.py"
    python = sys.executable if ours else str(PYTHON)
    try:
        run = subprocess.run(
            [python, str(script), *command[1:]], capture_output=True, text=True, timeout=LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return {"failed": f"not done after {LIMIT} s"}
    if run.returncode != 0:
        return {"failed": last_line(run.stderr)}
    return json.loads(run.stdout.splitlines()[-1])  # a library may have printed before


def largest_error(positions: list[float], reference: list[float]) -> float:
    """The largest distance from the reference [m]; infinite where a position is missing or not a number."""
    if len(positions) != len(reference):
        return float("inf")
    errors = [abs(x - exact) for x, exact in zip(positions, reference, strict=True)]
    return max(e if e == e else float("inf") for e in errors)


def measured(rival: Rival, reference: list[float], missing: dict[str, str]) -> dict:
    """{"ns", "error"} or {"failed"} of one row."""
    if reason := missing.get(rival.package, ""):
        return {"failed": f"not installed: {reason}"}
    print(f"running {rival.name}", file=sys.stderr)
    result = answer(rival.command, rival.ours)
    if "failed" in result:
        return result
    error = largest_error(result["positions"], reference) if rival.compared else None
    return {"ns": result["ns"], "error": error}


def table(results: dict[str, dict]) -> str:
    """The table in Markdown; ratios to the first row that was measured."""
    base = next((name for name, r in results.items() if "ns" in r), "")
    lines = [
        "| simulator | ns per sample | ratio | largest position error [m] |",
        "|---|---:|---:|---:|",
    ]
    for name, r in results.items():
        if "failed" in r:
            lines.append(f"| {name} | not measured: {r['failed']} | | |")
            continue
        error = "" if r["error"] is None else f"{r['error']:.1e}"
        lines.append(f"| {name} | {r['ns']:,.1f} | {r['ns'] / results[base]['ns']:,.3g} | {error} |")
    return "\n".join(lines) + f"\n\nThe ratio is to {base}."


def main() -> None:
    """Install, run, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("only", nargs="*", help="scripts whose name contains one of these, and zwidth")
    parser.add_argument("--install", action="store_true", help="install every rival again")
    given = parser.parse_args()
    missing = install(given.install)
    exact = {"failed": missing["mpmath"]} if missing["mpmath"] else answer(("reference",))
    if "failed" in exact:
        sys.exit(f"no reference: {exact['failed']}")
    chosen = [r for r in ROWS if not given.only or r.ours or any(part in r.command[0] for part in given.only)]
    print(f"Versions: {versions(set(missing))}\n")
    print(table({r.name: measured(r, exact["positions"], missing) for r in chosen}))


if __name__ == "__main__":
    main()
