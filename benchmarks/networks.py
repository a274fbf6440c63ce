"""A chain of masses in 2 to 8 processes over real sockets with delay and loss; the last of them is killed.

    python benchmarks/networks.py [--seconds 6]

Each line is UDP on this machine, made worse by 4 ms, up to 4 ms of jitter and a tenth of the packets lost.
Of those that live on are printed the steps that were late, the packets lost, the way there and back; of the
line to the dead one what it carried and its force at the end; and by how much any side has heard of more
energy than the other has sent, which must not be above 0.
"""

from __future__ import annotations

import argparse
import json
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HEAD = """
[environment]
type = "scene"
port = ""
[[environment.elements]]
type = "line-end"
node = "m0"
impedance = "0.15 N*s/m"
name = "paddle"
"""


def scene(bodies: int) -> str:
    """A chain that the paddle holds at one end."""
    found = [HEAD]
    for i in range(bodies):
        found.append(f'[[environment.elements]]\ntype = "mass"\nnode = "m{i}"\nmass = "20 g"')
        found.append(
            f'[[environment.elements]]\ntype = "damper"\nfirst = "m{i}"\nsecond = "ground"\ndamping = 0.02'
        )
        if i:
            stiffness = 60 if i % 2 == 0 else 400
            found.append(
                f'[[environment.elements]]\ntype = "spring"\nfirst = "m{i - 1}"\nsecond = "m{i}"\n'
                f"stiffness = {stiffness}"
            )
    return "\n".join(found)


def free_ports(count: int) -> list[int]:
    """Ports that nobody has now."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    found = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return found


def network(parts: int) -> str:
    """Two bodies in each part; every line made worse."""
    found = ['[network]\nsample_period = "5 ms"']
    for p in range(parts):
        found.append(f'[[network.part]]\nname = "part{p}"\nnodes = ["m{2 * p}", "m{2 * p + 1}"]')
    found.append(
        '[[network.device]]\nname = "paddle"\nsource = "haptic-paddle"\noperator = { type = "finger" }'
    )
    names = ["paddle", *(f"spring m{2 * p - 1}–m{2 * p}" for p in range(1, parts))]
    ports = free_ports(2 * len(names))
    for i, name in enumerate(names):
        here, there = (f"127.0.0.1:{port}" for port in ports[2 * i : 2 * i + 2])
        found.append(
            f'[[network.line]]\nname = "{name}"\nchannel = "udp:{here},{there}"\n'
            f'delay = "4 ms"\njitter = "4 ms"\nloss = 0.1\nseed = {i}'
        )
    return "\n".join(found)


def run(parts: int, seconds: float, folder: Path) -> None:
    """One chain, its last part killed half-way."""
    path = folder / f"chain{parts}.toml"
    path.write_text(scene(2 * parts) + "\n" + network(parts), encoding="utf-8")
    names = [*(f"part{p}" for p in range(parts)), "paddle"]
    command = [
        sys.executable,
        "-m",
        "zwidth",
        "network",
        str(path),
        "--duration",
        str(seconds),
        "--json",
        "--run",
    ]
    children = {
        name: subprocess.Popen([*command, name], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for name in names
    }
    doomed = f"part{parts - 1}"
    for line in children["part0"].stderr:  # type: ignore[union-attr]
        if " at " in line:
            break
    time.sleep(max(0.0, seconds / 2 - 1))
    children[doomed].send_signal(signal.SIGKILL)
    told = {
        name: json.loads(child.communicate()[0])["processes"][name]
        for name, child in children.items()
        if name != doomed
    }
    links = {name: report["links"] for name, report in told.items()}
    every = [link for own in links.values() for link in own.values()]
    dead = f"spring m{2 * parts - 3}–m{2 * parts - 2}"
    beyond = max(
        own[line]["energy_received_J"] - other[line]["energy_sent_J"]
        for a, own in links.items()
        for b, other in links.items()
        if a != b
        for line in own
        if line in other
    )
    trips = sorted(1e3 * link["round_trip_s"]["median"] for link in every)
    late, steps = (sum(report[key] for report in told.values()) for key in ("late", "steps"))
    lost, came = (sum(link[key] for link in every) for key in ("lost", "received"))
    last = links[f"part{parts - 2}"][dead]
    print(
        f"{parts} parts: {late / steps:.1%} of steps late, {lost / (lost + came):.1%} lost, "
        f"{trips[0]:.1f} to {trips[-1]:.1f} ms there and back; "
        f"dead line {1e3 * last['energy_received_J']:.3g} mJ, then {last['last_force_N']:g} N; "
        f"energy from nothing {beyond:.2g} J",
        flush=True,
    )


def main() -> None:
    """Two to eight parts."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=6)
    seconds = parser.parse_args().seconds
    with tempfile.TemporaryDirectory() as folder:
        for parts in (2, 3, 4, 6, 8):
            run(parts, seconds, Path(folder))


if __name__ == "__main__":
    main()
