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
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple

from zwidth.errors import InputError
from zwidth.model.environment.wording import with_unit
from zwidth.quantity.exact import Exact
from zwidth.quantity.parameter import Certain, Parametric, parameter, part, plain

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
    mass: Certain = parameter("mass", kept=Exact, bound="> 0", why=GIVES_OUT, meaning="of the body")
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        """The body, and the frame in which it moves."""
        return self.node, GROUND

    def resistance(self, period: Fraction) -> Fraction:
        """2 M/T."""
        return 2 * self.mass.fraction / period

    def describe(self, motion: str = "linear") -> str:
        """The body with its mass."""
        return f"{self.title} {with_unit('mass', self.mass, motion)}"


@dataclass(frozen=True)
class Spring(Element):
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

    first: str = node("one end")
    second: str = node("the other end")
    stiffness: Certain = parameter("stiffness", kept=Exact, bound="> 0", why=GIVES_OUT)
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        """Its ends."""
        return self.first, self.second

    def resistance(self, period: Fraction) -> Fraction:
        """K T/2."""
        return self.stiffness.fraction * period / 2

    def describe(self, motion: str = "linear") -> str:
        """The spring with its stiffness."""
        return f"{self.title} {with_unit('stiffness', self.stiffness, motion)}"


@dataclass(frozen=True)
class Damper(Element):
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

    first: str = node("one end")
    second: str = node("the other end")
    damping: Certain = parameter("virtual_damping", kept=Exact, bound="> 0", why=GIVES_OUT)
    name: str = label()

    @property
    def nodes(self) -> tuple[str, str]:
        """Its ends."""
        return self.first, self.second

    def resistance(self, period: Fraction) -> Fraction:
        """B."""
        return self.damping.fraction

    def describe(self, motion: str = "linear") -> str:
        """The damper with its number."""
        return f"{self.title} {with_unit('virtual_damping', self.damping, motion)}"


@dataclass(frozen=True)
class Lever(Element):
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

    first: str = node("one end")
    second: str = node("the other end")
    leverage: Certain = parameter(
        plain("leverage", "velocity of the second end for that of the first", "r"), 1, kept=Exact
    )
    name: str = label()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.leverage:
            raise InputError(
                f'leverage must not be 0: the second end would never move; tie it to "{GROUND}" instead'
            )

    @property
    def nodes(self) -> tuple[str, str]:
        """Its ends."""
        return self.first, self.second

    @property
    def ratio(self) -> Fraction:
        """r."""
        return self.leverage.fraction

    def describe(self, motion: str = "linear") -> str:
        """The lever with its ratio."""
        return f"{self.title} 1 : {float(self.leverage):g}"
