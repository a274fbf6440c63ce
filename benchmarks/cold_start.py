"""How long `zwidth check` takes from the shell, beside Python alone, and what it imports."""

from __future__ import annotations

import subprocess
import sys
import time
from statistics import median

RUNS = 15
CHECK = [sys.executable, "-m", "zwidth", "check", "haptic-paddle", "--stiffness"]
HEAVY = ("numpy", "scipy", "matplotlib", "control", "xarray", "pandas")


def seconds(command: list[str]) -> float:
    """Wall time of one run."""
    start = time.perf_counter()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
    return time.perf_counter() - start


def imported() -> list[str]:
    """Heavy packages that a check loads."""
    script = (
        "import sys, io, contextlib\n"
        "from zwidth.cli.main import main\n"
        "with contextlib.redirect_stdout(io.StringIO()):\n"
        "    main(['check', 'haptic-paddle', '--stiffness', '770'])\n"
        f"print(*[m for m in {HEAVY!r} if m in sys.modules])\n"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return run.stdout.split()


def main() -> None:
    """Measure in turn and print."""
    commands = {
        "python alone": [sys.executable, "-c", "pass"],
        "passive, 300 N/m": [*CHECK, "300"],
        "active, 770 N/m": [*CHECK, "770"],
        "passive, JSON": [*CHECK, "300", "--json"],
    }
    times: dict[str, list[float]] = {name: [] for name in commands}
    for command in commands.values():
        seconds(command)  # fill the disk caches
    for _ in range(RUNS):
        for name, command in commands.items():
            times[name].append(seconds(command))
    alone = median(times["python alone"])
    for name, values in times.items():
        ratio = median(values) / alone
        print(f"{name:<18} median {median(values):.3f} s  worst {max(values):.3f} s  {ratio:.1f} x")
    print("heavy packages imported:", ", ".join(imported()) or "none")


if __name__ == "__main__":
    main()
