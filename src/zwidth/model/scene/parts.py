"""A scene in parts that run apart from each other: in other threads, in other processes, far away.

What joins two parts is a line: a wave takes the time τ from one end to the other, at a wave impedance w.
Delay is then physics, not error: a line is a long elastic rod, of the stiffness and the mass

    K = w/τ,   M = w τ.

So a spring K between two parts becomes the line w = K τ, which is as stiff and brings M = K τ² along: soft
springs are best cut.  A body M in two parts becomes the line w = M/τ, as heavy, which gives way by τ²/M.  Any
other element stays in one part, and a line of a given w leads from its far end to the node that it held:
stiff where w is large, light where it is small.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar, NamedTuple

from zwidth.errors import InputError
from zwidth.model.environment.environment import with_unit
from zwidth.model.scene.element import GROUND, Element, label
from zwidth.model.scene.element import node as named_node
from zwidth.model.scene.scene import Scene
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import Certain, exact, read_number
from zwidth.quantity.text import shown, told_quantity
from zwidth.showing import Part as Shows
from zwidth.showing import Shown, Table


class Line(NamedTuple):
    """What joins two parts."""

    name: str
    parts: tuple[str, str]
    nodes: tuple[str, str]
    """Its end in each part."""
    impedance: Exact
    """w [N·s/m; N·m·s/rad]."""
    delay: Fraction
    """τ, one way [s]."""
    in_place_of: str
    """The spring or body that it replaces, "" where it was put in beside all that was there."""
    keeps: str = "stiffness"
    """What the line has of it: its "stiffness", or its "mass"."""

    @property
    def stiffness(self) -> float:
        """w/τ, of the line at rest [N/m; N·m/rad]."""
        return float(self.impedance.fraction / self.delay)

    def adds(self, motion: str = "linear") -> str:
        """The mass of a line, or how far the one of a body gives way, in words."""
        gives = self.keeps == "mass"
        if motion == "rotary":
            return shown(1 / self.stiffness, "rad/N/m") if gives else shown(self.mass, "kg*m^2")
        return shown(1 / self.stiffness, "m/N") if gives else shown(self.mass, "kg")

    @property
    def mass(self) -> float:
        """w τ, of the line as a whole [kg; kg·m²]."""
        return float(self.impedance.fraction * self.delay)


@dataclass(frozen=True)
class Part:
    """What runs in one place: a scene whose lines end in their matched dampers."""

    name: str
    scene: Scene

    @property
    def ends(self) -> tuple[Element, ...]:
        """The lines that end here."""
        return tuple(e for e in self.scene.elements if e.leads_elsewhere)


@dataclass(frozen=True, repr=False)
class Cut(Shown):
    """A scene in parts, and what each line between them adds."""

    parts: tuple[Part, ...]
    lines: tuple[Line, ...]
    motion: str = "linear"
    """Whether its axis is one that things move along, or "rotary", turn about."""

    def report(self) -> Iterable[Shows]:
        """The parts, then the lines with what they add."""
        yield Table(
            heads=[["part", "elements", "nodes", "lines"]],
            rows=[
                [p.name, str(len(p.scene.elements) - len(p.ends)), str(len(p.scene.nodes)), str(len(p.ends))]
                for p in self.parts
            ],
            lefts=1,
        )
        if self.lines:
            yield ""
            yield Table(
                heads=[["line", "in place of", "w", "delay", "stiffness", "adds"]],
                rows=[
                    [
                        line.name,
                        line.in_place_of or "—",
                        told_quantity(line.impedance, "wave_impedance", self.motion, 4),
                        shown(float(line.delay), "s", 4),
                        told_quantity(line.stiffness, "stiffness", self.motion, 4),
                        line.adds(self.motion),
                    ]
                    for line in self.lines
                ],
                lefts=2,
            )


def cut_scene(
    scene: Scene,
    parts: Mapping[str, Iterable[str]],
    delay: RealLike,
    impedances: Mapping[str, RealLike] | None = None,
    motion: str = "linear",
) -> Cut:
    """The scene in parts, joined by lines of the delay τ.

    Parameters
    ----------
    scene
        What is cut.
    parts
        Of each part the nodes that are in it; every node of the scene in one of them, or, for a body whose
        mass becomes a line, in two: what joins it to the second part hangs on that end.
    delay
        τ > 0, one way; not less than a step of the parts [s].
    impedances
        w > 0 [N·s/m; N·m·s/rad] by the name of an element that is cut.  A spring needs none: its line
        is as stiff as it was; nor does a damper, whose B is taken.
    motion
        "linear", or "rotary": in which units numbers are read and told.

    Raises
    ------
    InputError
        If a node is in no part, or in two and no body, a part has none, τ is not > 0, or w is missing, or
        given for an element that is not cut.
    """
    tau = read_number(delay, GLOSSARY["delay"], "delay", bound="> 0", why="a wave takes time").fraction
    titled, home, lines = _split(scene, _homes(scene, parts), tau)
    given = {
        name: read_number(
            w, GLOSSARY["wave_impedance"], f"impedance of {name}", bound="> 0", why=_NO_FORCE, motion=motion
        )
        for name, w in (impedances or {}).items()
    }
    inside: dict[str, list[Element]] = {name: [] for name in parts}

    def end(line: Line) -> None:
        for part, node in zip(line.parts, line.nodes, strict=True):
            inside[part].append(LineEnd(node, line.impedance, line.name))

    for line in lines:
        end(line)
    for title, element in titled:
        own = [home[node] for node in element.nodes if node in home]
        if own[0] == own[-1]:  # one end at least moves, and is at home
            inside[own[0]].append(element)
            continue
        line, stays = _crossing(title, element, (own[0], own[1]), given.pop(title, None), tau)
        inside[own[0]] += stays
        lines.append(line)
        end(line)
    if given:
        raise InputError(
            f"{next(iter(given))} is not cut, so no impedance is wanted; cut are: "
            f"{', '.join(line.name for line in lines) or 'none'}"
        )
    return Cut(
        tuple(
            Part(name, Scene(tuple(inside[name]), scene.port if home.get(scene.port) == name else ""))
            for name in parts
        ),
        tuple(lines),
        motion,
    )


def _crossing(
    title: str, element: Element, parts: tuple[str, str], w: Exact | None, tau: Fraction
) -> tuple[Line, list[Element]]:
    """The line of an element between two parts, and the element where it stays, with the line behind it."""
    if element.reflection == 1 and w is None:
        return Line(title, parts, element.nodes, Exact(_stiffness(element) * tau), tau, title), []
    far = f"{element.nodes[1]} of {title}"
    w = _damping_of(element, title) if w is None else w
    return Line(title, parts, (far, element.nodes[1]), w, tau, ""), [replace(element, **{"second": far})]


_NO_FORCE = "a wave of no impedance carries no force"


def _split(
    scene: Scene, homes: Mapping[str, tuple[str, ...]], tau: Fraction
) -> tuple[list[tuple[str, Element]], dict[str, str], list[Line]]:
    """The elements, with two nodes for a body in two parts; the part of each node; the lines of bodies."""
    home = {node: own[0] for node, own in homes.items()}
    titled = list(zip(scene.titles, scene.elements, strict=True))
    lines = []
    for node, own in homes.items():
        if len(own) == 1:
            continue
        bodies = [(t, e) for t, e in titled if e.reflection == -1 and e.nodes[0] == node]
        if len(own) > 2 or len(bodies) != 1:
            raise InputError(
                f'node "{node}" is in {len(own)} parts; in two can be what has one mass, no other'
            )
        ((title, body),) = bodies
        second = f"{node} in {own[1]}"
        home[second] = own[1]
        titled = [
            (t, _moved(e, node, second) if any(homes.get(n) == (own[1],) for n in e.nodes) else e)
            for t, e in titled
            if e is not body
        ]
        w = Exact(body.resistance(2 * tau))  # M/τ
        lines.append(Line(title, (own[0], own[1]), (node, second), w, tau, title, "mass"))
    return titled, home, lines


def _moved(element: Element, node: str, other: str) -> Element:
    end = "first" if element.nodes[0] == node else "second"
    return replace(element, **{end: other}) if node in element.nodes else element


def _homes(scene: Scene, parts: Mapping[str, Iterable[str]]) -> dict[str, tuple[str, ...]]:
    home: dict[str, tuple[str, ...]] = {}
    for name, nodes in parts.items():
        own = [nodes] if isinstance(nodes, str) else list(nodes)
        if not own:
            raise InputError(f'part "{name}" has no node; leave it out')
        for node in own:
            if node not in scene.nodes:
                raise InputError(
                    f'"{node}" of part "{name}" is no node of the scene: {", ".join(scene.nodes)}'
                )
            home[node] = (*home.get(node, ()), name)
    if left := [n for n in scene.nodes if n not in home]:
        raise InputError(f"in no part: {', '.join(left)}; every node must be somewhere")
    return home


def _damping_of(element: Element, title: str) -> Exact:
    if element.reflection or element.law is not None or element.ratio is not None:
        raise InputError(
            f"{title} lies between two parts: give impedances={{{title!r}: w}}, the wave impedance of its "
            "line; K = w/τ should be well above the stiffness there, and M = w τ well below the masses"
        )
    return Exact(element.resistance(Fraction(1)))


def _stiffness(spring: Element) -> Fraction:
    return spring.resistance(Fraction(2))  # K T/2


def best_parts(scene: Scene, count: int) -> dict[str, tuple[str, ...]]:
    """The parts whose lines add the least: no other choice of as many cuts a softer stiffest spring.

    Only springs are cut, from the softest on: what is left together hangs together by stiffer ones.  A node
    without a mass stays with what its stiffest spring leads to.

    Parameters
    ----------
    scene
        What is to be cut.
    count
        How many parts, 1 or more.

    Raises
    ------
    InputError
        If its springs do not join as many parts.
    """
    if not isinstance(count, int) or count < 1:
        raise InputError(f"count is how many parts, a whole number from 1 on, got {count!r}")
    group = {n: n for n in scene.nodes}

    def root(node: str) -> str:
        while group[node] != node:
            node = group[node]
        return node

    joined = [e for e in scene.elements if GROUND not in e.nodes]
    firm = [e for e in joined if e.reflection != 1]
    springs = sorted((e for e in joined if e.reflection == 1), key=_stiffness, reverse=True)
    bodies = {e.nodes[0] for e in scene.elements if e.reflection == -1}
    light = [e for n in scene.nodes if n not in bodies for e in [s for s in springs if n in s.nodes][:1]]
    left, kept = len(group), len(firm) + len(light)
    for i, element in enumerate((*firm, *light, *springs)):
        a, b = (root(n) for n in element.nodes)
        if a != b and (left > count or i < kept):
            group[b] = a
            left -= 1
    if left < count:
        raise InputError(
            f"count must be from 1 to {left}, the parts that springs join in this scene, got {count}"
        )
    found: dict[str, list[str]] = {}
    for node in scene.nodes:
        found.setdefault(root(node), []).append(node)
    return {f"part {i + 1}": tuple(nodes) for i, nodes in enumerate(found.values())}


# Where a line to another part of a scene ends: a matched damper, and the force of the wave that comes in.
#
#     f̄ = w v̄ − f
#
# f is held over the step, as a port of `zwidth.links` gives it; w is the damping that such a port counts on.


@dataclass(frozen=True)
class LineEnd(Element):
    """The end of a line at a node, ``f̄ = w v̄ − f``.

    What it takes in goes into the line, and what comes out of the line it gives: its losses may be negative.

    Parameters
    ----------
    node
        Where it ends.
    impedance
        w > 0 [N·s/m; N·m·s/rad].
    name
        Of the line.
    """

    symbol: ClassVar[str] = "w"
    leads_elsewhere: ClassVar[bool] = True

    node: str = named_node("where the line ends")
    impedance: Certain = exact("wave_impedance", bound="> 0", why="a wave of no impedance carries no force")
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        return self.node, GROUND

    @property
    def title(self) -> str:
        return self.name or f"line at {self.node}"

    def resistance(self, period: Fraction) -> Fraction:
        return self.impedance.fraction

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} {with_unit('wave_impedance', self.impedance, motion)}"
