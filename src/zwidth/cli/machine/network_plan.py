"""Which process runs what: the parts of a scene, the devices that hold it, and what carries the lines.

    [environment]                        [[network.part]]
    type = "scene"                       name = "bed"
    port = ""                            nodes = ["bed"]
    …                                    sample_period = "5 ms"

    [[network.device]]                   [[network.line]]
    name = "paddle"                      name = "paddle"
    source = "haptic-paddle"             channel = "udp:127.0.0.1:7401,127.0.0.1:7402"
    operator = { type = "finger" }       loss = 0.1

A device holds the line end of its name; its source is of the catalogue, or a file with a [device].  Where
it has a `connection` in the place of an operator it is a real one, and may have a `safety`.  A part without
nodes has all that are in no other; a line without a channel goes through shared memory.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.simulate.tables import build_hand
from zwidth.errors import InputError
from zwidth.links import Schedule, WavePort, held_back
from zwidth.machine.network.carriers import open_channel
from zwidth.machine.network.channel import Channel, Lossy
from zwidth.machine.network.peer import Peer
from zwidth.machine.network.runs import DeviceRun, PartRun
from zwidth.model.device import Device
from zwidth.model.operator.named import usual_kind
from zwidth.model.operator.operator import Operator
from zwidth.model.scene.parts import Cut, best_parts, cut_scene
from zwidth.model.scene.scene import Scene
from zwidth.model.specification.environments import build_environment
from zwidth.model.specification.read import load_device, read_tables
from zwidth.model.specification.table import Table, located
from zwidth.model.specification.values import read
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of, read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.machine.servo.connection import Placement
    from zwidth.machine.servo.port_run import PortRun
    from zwidth.machine.servo.safety import Safety

_LONGEST_WAIT = 20.0
"""How long a process waits for the one that makes their shared memory [s]."""

_WORSE = parameters_of(Schedule)
_KINDS = {
    "part": ("name", "nodes", "sample_period"),
    "device": ("name", "source", "hold_back", "operator", "connection", "safety"),
    "line": ("name", "channel", "impedance", *_WORSE),
}
_LONGEST = "longest_period"
_PLACED = ("origin", "sense", _LONGEST)
"""Keys of a connection that are not the device's own."""

_KEYS = ("delay", "parts", "sample_period", *_KINDS)


@dataclass(frozen=True)
class Line:
    """How the packets of a line travel."""

    channel: str
    first: str
    """The process that opens its first side."""
    worse: Schedule | None = None
    """What is done to it on purpose."""

    def opened(self, name: str, here: str) -> Channel:
        """This process's side."""
        with located(f"line {name}"):
            channel = open_channel(self.channel, here == self.first, wait=_LONGEST_WAIT)
            return Lossy(channel, self.worse, way=int(here == self.first)) if self.worse else channel


@dataclass(frozen=True)
class Held:
    """A simulated device in a scripted hand, or, with a connection, a real one in a person's."""

    device: Device
    hand: Operator | None
    reached: Reached | None = None
    wait: Fraction = Fraction(0)
    """For so long the loop keeps each force back, until a sample ends [s]."""

    def describe(self) -> str:
        """Which device, and how it is reached, or which hand holds it."""
        name = self.device.name or "device"
        held = f", each force held back for {shown(Exact(self.wait), 's')}" if self.wait else ""
        if self.reached is not None:
            return f"{name}{held}, {self.reached.connection.describe()}"
        assert self.hand is not None
        return f"{name}{held} (hand: {self.hand.describe(self.device.motion).partition(',')[0]})"

    def runs(self, port: WavePort, duration: Exact, line: str) -> DeviceRun | PortRun:
        """What its process steps; a real device is not reached yet."""
        if self.reached is None:
            assert self.hand is not None
            return DeviceRun(port, self.hand, duration, line)
        from zwidth.machine.servo.port_run import PortRun

        return PortRun(port, line=line, **vars(self.reached))


@dataclass(frozen=True)
class Reached:
    """How a real device is reached, and the limits of what its hand is given."""

    connection: Any
    placement: Placement
    safety: Safety
    longest_period: Exact | None


@dataclass(frozen=True)
class Plan:
    """A scene, its parts and its devices, each to be run by a process of its name."""

    cut: Cut
    periods: Mapping[str, Exact]
    devices: Mapping[str, Held]
    lines: Mapping[str, Line]

    @property
    def names(self) -> tuple[str, ...]:
        """The processes: parts, then devices."""
        return (*self.periods, *self.devices)

    def runs(self, name: str, duration: Exact) -> PartRun | DeviceRun | PortRun:
        """What the process of a name steps."""
        if name not in self.names:
            raise InputError(f'no process is called "{name}"; there are: {", ".join(self.names)}')
        if name not in self.devices:
            return PartRun(next(p for p in self.cut.parts if p.name == name), self.periods[name])
        held = self.devices[name]
        ends = (end for part in self.cut.parts for end in part.ends if end.title == name)
        w = next(ends).resistance(held.device.exact("sample_period"))
        return held.runs(WavePort(held.device, impedance=w), duration, name)

    def peer(self, name: str, duration: Exact) -> Peer:
        """The same with its channels open."""
        runs = self.runs(name, duration)
        with ExitStack() as opened:  # closed again if one cannot be opened
            channels = {
                line: opened.enter_context(self.lines[line].opened(line, name)) for line in runs.lines
            }
            opened.pop_all()
        own = self.devices.get(name)
        return Peer(runs, channels, Exact(own.device.exact("sample_period")) if own else self.periods[name])


def load_plan(path: Path) -> Plan:
    tables = read_tables([path], ("environment", "network"))
    for needed in ("environment", "network"):
        if needed not in tables:
            raise InputError(
                f"{path}: there is no [{needed}] table; a network has the scene and who runs what"
            )
    table = tables["network"]
    table.check_keys(_KEYS, "a network")
    rows = {kind: list(_rows(table, kind)) for kind in _KINDS}
    devices = dict(map(_device, rows["device"]))
    motion = _motion(table, devices)
    scene = build_environment(tables["environment"], motion)
    if not isinstance(scene, Scene):
        raise InputError(f'{tables["environment"].label}: a network runs a scene, type = "scene"')
    if scene.port:
        raise InputError(
            f'{tables["environment"].label}: nobody would move the port "{scene.port}": '
            'write port = "", and a line-end where a device comes in'
        )
    names, periods = _parts(scene, table, rows["part"])
    both = next((name for name in devices if name in names), None)
    if both is not None:
        raise InputError(
            f'{table.label}: "{both}" is a part and a device; each process has a name of its own'
        )
    delay = _number(table, "delay", "delay") if "delay" in table.values else max(periods.values())
    with located(table.label):
        made = cut_scene(scene, names, delay, dict(_impedances(rows["line"], motion)), motion)
    for line in made.lines:
        one, other = (periods[part].fraction for part in line.parts)
        if line.delay < (one + other) / 2:
            least, got = (shown(Exact(t), "s") for t in ((one + other) / 2, line.delay))
            raise InputError(
                f"{table.label}: delay must be ≥ {least}, got {got}: the steps of its parts make line "
                f'"{line.name}" as late'
            )
    return Plan(made, periods, devices, _lines(made, devices, rows["line"], path.stem))


def _motion(table: Table, devices: Mapping[str, Held]) -> str:
    """That of the axis of the scene, which is that of every device."""
    found = {held.device.motion: name for name, held in devices.items()}
    if len(found) > 1:
        raise InputError(
            f"{table.label}: {found['rotary']} turns and {found['linear']} slides; a scene has one axis: "
            "give the one that turns a handle_radius, and it is felt at its handle, in newtons and metres"
        )
    return next(iter(found), "linear")


def _rows(table: Table, kind: str) -> Iterator[Table]:
    given = table.values.get(kind, [])
    if not isinstance(given, list) or not all(isinstance(row, Mapping) for row in given):
        raise InputError(f"{table.label}: {kind} is written as [[network.{kind}]] tables")
    names = set()
    for i, row in enumerate(given):
        one = Table(f"{table.label.removesuffix(']')}.{kind} {i + 1}]", row)
        one.check_keys(_KINDS[kind], f"a {kind} of a network")
        if "name" not in one.values:
            raise InputError(f"{one.label}: name is missing")
        name = one.text("name")
        if not name or name in names:
            told = f'there are two of the name "{name}"' if name else "name is empty"
            raise InputError(f"{one.label}: {told}; each {kind} has a name of its own")
        names.add(name)
        yield one


def _number(
    table: Table, key: str, quantity: str, why: str = "a step takes time", motion: str = "linear"
) -> Exact:
    with located(table.where(key)):
        found: Exact = read_number(
            table.values[key], GLOSSARY[quantity], key, bound="> 0", why=why, motion=motion
        )
    return found


def _parts(
    scene: Scene, table: Table, rows: list[Table]
) -> tuple[dict[str, tuple[str, ...]], dict[str, Exact]]:
    if "parts" in table.values:
        if rows:
            raise InputError(f"{table.label}: give the number of parts, or [[network.part]] tables, not both")
        count = table.values["parts"]
        with located(table.label):
            if not isinstance(count, int) or isinstance(count, bool):
                raise InputError(f"parts is how many, a whole number, got {count!r}")
            names = best_parts(scene, count)
        return names, dict.fromkeys(names, _period(table, table))
    if not rows:
        raise InputError(f"{table.label}: say how many parts, or which nodes are in each [[network.part]]")
    names, periods = {}, {}
    for row in rows:
        name, nodes = row.text("name"), row.values.get("nodes", [])
        if not isinstance(nodes, list) or not all(isinstance(n, str) for n in nodes):
            raise InputError(f'{row.label}: nodes is a list of names, such as ["tool", "bed"]')
        names[name], periods[name] = tuple(nodes), _period(row, table)
    open_ones = [name for name, nodes in names.items() if not nodes]
    if len(open_ones) > 1:
        raise InputError(
            f"{table.label}: {open_ones[0]} and {open_ones[1]} have no nodes; one may have the rest"
        )
    for name in open_ones:
        taken = {node for nodes in names.values() for node in nodes}
        names[name] = tuple(node for node in scene.nodes if node not in taken)
    return names, periods


def _period(row: Table, table: Table) -> Exact:
    owner = row if "sample_period" in row.values else table
    if "sample_period" not in owner.values:
        raise InputError(f"{row.label}: sample_period is missing: how long a step of this part takes")
    return _number(owner, "sample_period", "sample_period")


def _device(row: Table) -> tuple[str, Held]:
    if "source" not in row.values:
        raise InputError(
            f"{row.label}: source is missing: a device of the catalogue, or a file with a [device]"
        )
    device = load_device([row.text("source")], {})
    wait = Fraction(0)
    hold_back = row.values.get("hold_back", False)
    if not isinstance(hold_back, bool):
        raise InputError(f"{row.where('hold_back')}: hold_back is true or false, got {hold_back!r}")
    if hold_back:
        device, wait = held_back(device)
    if "connection" in row.values:
        return row.text("name"), _real(row, device, wait)
    if "safety" in row.values:
        raise InputError(f"{row.label}: safety is of a real device, and this one has no connection")
    usual = usual_kind(device)
    hand = _inner(row, "operator", f'{{ type = "{usual}" }}', {"type": usual})
    return row.text("name"), Held(device, build_hand(hand, device), wait=wait)


def _real(row: Table, device: Device, wait: Fraction) -> Held:
    from zwidth.machine.servo.connection import Placement
    from zwidth.machine.servo.devices.registry import build_connection
    from zwidth.machine.servo.safety import read_safety

    if "operator" in row.values:
        raise InputError(
            f"{row.label}: an operator holds a simulated device, and a connection is of a real one, which a "
            "person holds: leave out one of the two"
        )
    table = _inner(row, "connection", '{ type = "hapkit", port = "/dev/ttyUSB0", count = "13 um" }')
    place = Table(table.label, {key: table.values.pop(key) for key in _PLACED if key in table.values})
    longest = _number(place, _LONGEST, "sample_period") if _LONGEST in place.values else None
    connection = build_connection(table)
    if "delay" in device.assumed:  # not told: what the port makes of it, the shortest that it can have
        waits = max(connection.late, 1)
        device = device.replace(delay=Exact(waits * device.exact("sample_period")))
    safety = read_safety(_inner(row, "safety", '{ force = "2 N" }', {}), device.motion)
    reached = Reached(connection, Placement.read(place, device.motion), safety, longest)
    return Held(device, None, reached, wait)


def _inner(row: Table, key: str, example: str, default: Mapping[str, Any] | None = None) -> Table:
    given = row.values.get(key, default)
    if not isinstance(given, Mapping):
        raise InputError(f"{row.label}: {key} is a table, such as {example}")
    return Table(f"{row.label} {key}", dict(given))


def _impedances(rows: list[Table], motion: str) -> Iterator[tuple[str, Exact]]:
    for row in rows:
        if "impedance" in row.values:
            why = "a wave of no impedance carries no force"
            yield row.text("name"), _number(row, "impedance", "wave_impedance", why, motion)


def _lines(made: Cut, devices: Mapping[str, Any], rows: list[Table], stem: str) -> dict[str, Line]:
    ends: dict[str, str] = {line.name: line.parts[0] for line in made.lines}
    inner = set(ends)
    for end, home in ((end.title, part.name) for part in made.parts for end in part.ends):
        if end not in inner and end in ends:
            raise InputError(f'two line ends are called "{end}"; give each a name of its own')
        ends.setdefault(end, home)
    for name in devices:
        if name not in ends:
            raise InputError(
                f'device "{name}" holds no line end of the scene; those that lead out are: '
                f"{', '.join(n for n in ends if n not in {line.name for line in made.lines}) or 'none'}"
            )
    loose = [n for n in ends if n not in devices and n not in {line.name for line in made.lines}]
    if loose:
        raise InputError(f'nothing holds the line end "{loose[0]}"; add a [[network.device]] of that name')
    told = {row.text("name"): row for row in rows}
    for name, row in told.items():
        if name not in ends:
            raise InputError(f'{row.label}: there is no line "{name}"; there are: {", ".join(ends)}')
    memory = "".join(c if c.isalnum() else "-" for c in stem)
    return {
        name: _line(told.get(name), f"memory:{memory}-{i}", first)
        for i, (name, first) in enumerate(ends.items())
    }


def _line(row: Table | None, channel: str, first: str) -> Line:
    if row is None:
        return Line(channel, first)
    with located(row.label):
        told = {
            key: read(row.values[key], key, own, "linear") for key, own in _WORSE.items() if key in row.values
        }
        worse = Schedule(**told) if told else None
    return Line(row.text("channel") if "channel" in row.values else channel, first, worse)
