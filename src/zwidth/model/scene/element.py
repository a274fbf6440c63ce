"""The elements of a scene: what they are, and the one number with which a linear one meets its junction.

    f̄ = R v̄ + b,   a = f̄ + R v̄,   b ← g a at the next step

v̄ is the mean velocity of the element's ends against each other over a step, f̄ its mean force against it;
a and b are the waves of a wave digital filter (Fettweis 1986).

    spring   R = K T/2,  g = 1     b is the spring's force K d at the start of the step
    mass     R = 2 M/T,  g = −1    b is −R times its velocity at the start of the step
    damper   R = B,      g = 0

Each takes in f̄ v̄ T = (a² − b²) T/4R, which is the change of ½ K d² or ½ M u² exactly, and for a damper what
is lost: it is the implicit midpoint rule, with nothing added and nothing left out.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple

from zwidth.errors import InputError
from zwidth.model.environment.environment import with_unit
from zwidth.quantity.parameter import Certain, Parametric, exact, part, plain

GROUND = "ground"
"""The node that never moves."""

GIVES_OUT = "it would give out energy; leave out an element of 0"


def read_node(value: Any, name: str) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise InputError(f'{name} is the name of a node, a text such as "tool" or "{GROUND}", got {value!r}')
    return value


def node(meaning: str) -> Any:
    """The name of a node as a field of an element."""
    return part("node", read_node, meaning=meaning)


def label() -> Any:
    """The name of an element itself, "" for one that is made of its nodes."""

    def read(value: Any, name: str) -> str:
        if not isinstance(value, str) or not (value == "" or value.isprintable()):
            raise InputError(
                f'{name} is the name of an element, a text such as "handle\'s spring", got {value!r}'
            )
        return value

    return part("node", read, "", meaning="name of the element")


class NonlinearLaw(NamedTuple):
    """Which law the compiled step takes, and its numbers."""

    code: float
    numbers: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Element(Parametric, ABC):
    """What joins nodes of a scene."""

    symbol: ClassVar[str]
    """The letter with which it is drawn and named."""

    reflection: ClassVar[int] = 0
    """g of a linear element."""

    leads_elsewhere: ClassVar[bool] = False
    """True of the end of a line, whose wave comes from another part of a scene."""

    @property
    @abstractmethod
    def nodes(self) -> tuple[str, str]:
        """Its two ends; a force that it gives acts against the motion of the first."""

    @property
    def title(self) -> str:
        """Its name, or its kind and its nodes."""
        own: str = getattr(self, "name", "")
        return own or f"{type(self).__name__.lower()} {'–'.join(n for n in self.nodes if n != GROUND)}"

    @property
    def ratio(self) -> Fraction | None:
        """v_second = ratio · v_first of what ties two nodes; None of any other."""
        return None

    @property
    def law(self) -> NonlinearLaw | None:
        """The law of an element that is not linear; None of any other."""
        return None

    def resistance(self, period: Fraction) -> Fraction:
        """R of a linear element at the step T [s]; 0 of any other."""
        return Fraction(0)

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """The element with its number."""


@dataclass(frozen=True)
class Mass(Element):
    """A body that moves along the axis, ``E = ½ M u²``.

    Parameters
    ----------
    node
        What it is, a node of the scene.
    mass
        M > 0 [kg; kg·m²].
    name
        Its name in tables and plots; by default made of its node.
    """

    symbol: ClassVar[str] = "M"
    reflection: ClassVar[int] = -1

    node: str = node("the body")
    mass: Certain = exact("mass", bound="> 0", why=GIVES_OUT, meaning="of the body")
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        return self.node, GROUND

    def resistance(self, period: Fraction) -> Fraction:
        return 2 * self.mass.fraction / period

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} {with_unit('mass', self.mass, motion)}"


@dataclass(frozen=True)
class Between(Element):
    """What joins two nodes."""

    first: str = node("one end")
    second: str = node("the other end")

    @property
    def nodes(self) -> tuple[str, str]:
        return self.first, self.second


@dataclass(frozen=True)
class Spring(Between):
    """A spring between two nodes, ``f = K (y_first − y_second)``.

    Parameters
    ----------
    first, second
        Its ends; "ground" for one that is fixed.
    stiffness
        K > 0 [N/m; N·m/rad].
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "K"
    reflection: ClassVar[int] = 1

    stiffness: Certain = exact("stiffness", bound="> 0", why=GIVES_OUT)
    name: str = label()

    def resistance(self, period: Fraction) -> Fraction:
        return self.stiffness.fraction * period / 2

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} {with_unit('stiffness', self.stiffness, motion)}"


@dataclass(frozen=True)
class Damper(Between):
    """A damper between two nodes, ``f = B (v_first − v_second)``.

    Parameters
    ----------
    first, second
        Its ends; "ground" for one that is fixed.
    damping
        B > 0 [N·s/m; N·m·s/rad].
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "B"

    damping: Certain = exact("virtual_damping", bound="> 0", why=GIVES_OUT)
    name: str = label()

    def resistance(self, period: Fraction) -> Fraction:
        return self.damping.fraction

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} {with_unit('virtual_damping', self.damping, motion)}"


@dataclass(frozen=True)
class Lever(Between):
    """A rigid massless lever, ``v_second = r v_first``, ``f_first = r f_second``.

    Parameters
    ----------
    first, second
        Its ends; to tie a node to the ground is to give it "ground" as one end.
    leverage
        r ≠ 0; below 0 with the pivot between the ends.  Default 1: the two nodes are one.
    name
        Its name in tables and plots; by default made of its nodes.
    """

    symbol: ClassVar[str] = "r"

    leverage: Certain = exact(plain("leverage", "velocity of the second end for that of the first", "r"), 1)
    name: str = label()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.leverage:
            raise InputError(
                f'leverage must not be 0: the second end would never move; tie it to "{GROUND}" instead'
            )

    @property
    def ratio(self) -> Fraction:
        return self.leverage.fraction

    def describe(self, motion: str = "linear") -> str:
        return f"{self.title} 1 : {float(self.leverage):g}"


# Which velocities of a scene are free: levers tie nodes, the ground holds them, the port is moved.
#
#     v_node = ratio · v_root        v̄ of an element = α q_i − β q_j + c v_port
#
# Ties are put in exactly, so that no force of a lever is ever computed and loops of levers may be closed:
# where two contradict each other the node does not move.

_ZERO, _ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class Across:
    """The velocity across an element: of free nodes by their number, and of the port."""

    free: Mapping[int, Fraction]
    port: Fraction


@dataclass(frozen=True)
class Ties:
    """A scene as its step sees it.

    Attributes
    ----------
    roots
        The nodes whose velocities are free, in order.
    places
        Of each node its root and v_node/v_root; the root is "ground" or the port where it is one of them.
    across
        Of each element that is no lever, in order, the velocity across it.
    """

    roots: tuple[str, ...]
    places: Mapping[str, tuple[str, Fraction]]
    across: tuple[Across, ...]


def unheld(node: str) -> InputError:
    """That a node has more than one velocity that answers its laws."""
    return InputError(
        f'nothing holds the node "{node}" but what may let go of it, or numbers too far apart: '
        "its velocity has more than one answer; give it a mass, or a damper to a node that has one"
    )


def ties(elements: Sequence[Element], port: str) -> Ties:
    """Nodes and ties of the elements; `port` is "" for none."""
    places = _tied(elements, port)
    if port and places[port][0] == GROUND:
        raise InputError(f'the port "{port}" is tied to the ground: nothing could be felt; untie it')
    joined = [e for e in elements if e.ratio is None]
    roots = tuple(dict.fromkeys(places[n][0] for e in joined for n in e.nodes))
    free = tuple(r for r in roots if r not in (GROUND, port))
    number = {root: i for i, root in enumerate(free)}
    return Ties(free, places, tuple(_across(e.nodes, places, number, port) for e in joined))


def _across(
    nodes: tuple[str, str], places: Mapping[str, tuple[str, Fraction]], number: Mapping[str, int], port: str
) -> Across:
    free: dict[int, Fraction] = {}
    moved = _ZERO
    for sign, name in zip((1, -1), nodes, strict=True):
        root, ratio = places[name]
        if root in number:
            free[number[root]] = free.get(number[root], _ZERO) + sign * ratio
        elif root == port:
            moved += sign * ratio
    return Across({i: weight for i, weight in free.items() if weight}, moved)


def _tied(elements: Iterable[Element], port: str) -> dict[str, tuple[str, Fraction]]:
    """Of each node its root and v_node/v_root."""
    groups: dict[str, dict[str, Fraction]] = {}
    root_of: dict[str, str] = {}
    for name in (GROUND, *([port] if port else []), *(n for e in elements for n in e.nodes)):
        if name not in root_of:
            root_of[name], groups[name] = name, {name: _ONE}
    for element in elements:
        if element.ratio is None:
            continue
        a, b = element.nodes
        ra, rb = root_of[a], root_of[b]
        va, vb = element.ratio * groups[ra][a], groups[rb][b]  # va v_ra = vb v_rb
        if ra == rb and va == vb:
            continue
        if ra == rb or GROUND in (ra, rb):
            for root in {ra, rb} - {GROUND}:
                _join(groups, root_of, GROUND, root, _ZERO)
        elif rb == port:
            _join(groups, root_of, rb, ra, vb / va)
        else:
            _join(groups, root_of, ra, rb, va / vb)
    return {name: (root, groups[root][name]) for name, root in root_of.items()}


def _join(
    groups: dict[str, dict[str, Fraction]], root_of: dict[str, str], kept: str, lost: str, factor: Fraction
) -> None:
    """The nodes of one root become nodes of another, v_lost = factor · v_kept."""
    for name, ratio in groups.pop(lost).items():
        root_of[name] = kept
        groups[kept][name] = ratio * factor
