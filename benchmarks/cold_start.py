"""What each command costs from the shell, at its first use and at its second, with small everyday inputs.

`first` has no bytecode of Python and no other cache; `installed` has the bytecode, as pip leaves it, and no
other cache; `second` has both.  The compiled step functions are there in all three.  Processor seconds of the
process and of those it started, the best of the rounds; memory is the most that was resident in one of them.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

COMMANDS = (
    "check haptic-paddle --stiffness 300",
    "check haptic-paddle --stiffness 770 --force -o motion.json",
    "check haptic-paddle --stiffness 300 --json",
    "verify motion.json",
    "simulate haptic-paddle --stiffness 300 --virtual-damping 0.05 --operator dowel --duration 2",
    "simulate knob.toml detents.toml turn.toml --force -o touch.nc",
    "simulate arms.toml --operator finger --duration 1",
    "traces touch.nc",
    "limit haptic-paddle --stiffness 100 --speed '0.5 m/s' --penetration '2 mm'",
    "compare haptic-paddle --stiffness 300",
    "map haptic-paddle --stiffness 0:1000 --virtual-damping 0:0.5",
    "sweep haptic-paddle --vary stiffness=1:3000:40 --vary 'delay=0:5 ms:20'",
    "pair arms.toml --link-delay '5 ms'",
    "gains leader.yaml follower.yaml --link-delay '2 ms'",
    "links haptic-paddle --delay '20 ms' --loss 0.5",
    "network room.toml --plan",
    "network room.toml --duration '1 s'",
    "workspace arm.urdf --stiffness 500",
    "identify session.csv",
    "tissue relaxation.csv phantom",
    "diagnose shaking.csv wheel.toml",
    "plan haptic-paddle --force-noise '0.1 N'",
    "each leader.toml follower.toml --stiffness 100",
    "serve haptic-paddle --stiffness 250 --duration '1 s' --force -o session.mcap",
    "replay session.mcap",
    "doctor haptic-paddle --duration '1 s'",
    "emit hapkit.toml --target arduino --travel '-60 .. 60 mm' --force -o hapkit",
    "report haptic-paddle --stiffness 770 --force -o report.html",
    "play haptic-paddle --stiffness 770 --force -o play.html",
    "explore haptic-paddle --no-browser",
    "devices",
    "new device my-device.toml --no-questions --motion linear --rate '1 kHz' --damping '0.1 N*s/m' --force",
    "tour --no-pause",
    "examples . --force",
    "completion bash",
    "--help",
)
"""One line at least of each command."""


def used(words: list[str], caches: Path, folder: Path) -> tuple[float, float]:
    """Processor seconds and the most resident MiB of one run."""
    kept = {"PYTHONPYCACHEPREFIX": "bytecode", "XDG_CACHE_HOME": "other", "MPLCONFIGDIR": "other"}
    environment = {**os.environ, **{name: str(caches / place) for name, place in kept.items()}}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    endless = "explore" in words
    process = subprocess.Popen(
        [sys.executable, *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE if endless else subprocess.DEVNULL,
    )
    if process.stderr is not None:
        next(line for line in process.stderr if b"http" in line)  # the page is there
        process.send_signal(signal.SIGINT)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1, 3, 4) and not endless:
        raise SystemExit(f"{shlex.join(words)} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--only", default="", help="commands that begin so")
    asked = parser.parse_args()
    print(
        "| zwidth | first [s] | installed [s] | second [s] | first/second | installed/second | memory [MiB] |"
    )
    print("|---|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch, "work")
        subprocess.run([sys.executable, "-m", "zwidth", "examples", folder], check=True, capture_output=True)
        for line in ("", *COMMANDS):
            if not line.startswith(asked.only):
                continue
            words = ["-m", "zwidth", *shlex.split(line)] if line else ["-c", "pass"]
            runs = []
            for _ in range(asked.rounds):
                with tempfile.TemporaryDirectory() as caches:
                    first = used(words, Path(caches), folder)
                    shutil.rmtree(Path(caches, "other"), ignore_errors=True)
                    installed = used(words, Path(caches), folder)
                    runs.append((first, installed, used(words, Path(caches), folder)))
            best = [min(seconds for seconds, _ in column) for column in zip(*runs, strict=True)]
            memory = max(size for run in runs for _, size in run)
            ratios = " | ".join(f"{value / best[2]:.2f}" for value in best[:2])
            seconds = " | ".join(f"{value:.2f}" for value in best)
            print(f"| `{line or 'Python alone'}` | {seconds} | {ratios} | {memory:.0f} |", flush=True)


if __name__ == "__main__":
    main()
