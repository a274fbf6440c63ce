"""A scene: a virtual world that never gives out energy of its own.

Nodes move along one axis, or turn about one, and elements join them.  Every element takes in what it stores
and loses, exactly (`element`, `nonlinear`), and what joins them neither makes nor loses energy.  So for every
motion y of the port, with the force f_k of the step that ended at y_k,

    Σ f_k (y_k − y_{k−1}) = E_N − E_0 + losses ≥ −E_0,

however many elements, whatever touches and slides: the scene is passive in the backward pairing, and
behind a virtual coupling that fits the device the whole is.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from zwidth.errors import InputError
from zwidth.model.environment.environment import CouplingLaw, Environment, RationalFunction, Stepped
from zwidth.model.scene.element import GROUND, Element, Ties, read_node, ties
from zwidth.quantity.documented import Pictured
from zwidth.quantity.parameter import Reads, part
from zwidth.showing import Part, Shown, Table

if TYPE_CHECKING:
    from zwidth.model.scene.pack import Packed


MOST_STATES = 60
"""Of more the coefficients of H(z) have so many digits that a proof would take minutes."""


def _elements(given: Iterable[Any], name: str) -> tuple[Element, ...]:
    if isinstance(given, Element) or not isinstance(given, Iterable):
        raise InputError(f'{name} is a list, such as [Mass("tool", 0.1)], got {given!r}')
    elements = tuple(given)
    for element in elements:
        if not isinstance(element, Element):
            raise InputError(
                f"an element is one of zwidth.scene, such as Mass or Spring, got {type(element).__name__}"
            )
        first, second = element.nodes
        if first == second:
            raise InputError(f"{element.title}: both ends are at the same node; give it two different ones")
    if not elements:
        raise InputError("a scene has one element at least: without any there is nothing to feel")
    return elements


def _port(given: Any, name: str) -> str:
    return "" if given == "" else read_node(given, name)


@dataclass(frozen=True, repr=False)
class Scene(Environment, Pictured):
    """Masses, springs, dampers, contacts, friction and levers, stepped so that no energy is made.

    It is at rest where a touch starts, by default at x = 0, and positions are counted from there.

    Parameters
    ----------
    elements
        `Mass`, `Spring`, `Damper`, `Lever`, `Contact`, `CoulombFriction`, `NonlinearSpring` of
        `zwidth.scene`.  What joins them are the names of their nodes; "ground" never moves.
    port
        The node that the hand holds, or that a virtual coupling pulls.  Default "handle"; "" for a scene that
        is moved by lines alone.

    Raises
    ------
    InputError
        If there is no element, the port is no node of them, or tied to the ground; or when it is used, if a
        node is held by nothing but what may let go of it.
    """

    _PICTURE = "plot_scene"

    elements: Reads[tuple[Element, ...], Iterable[Element]] = part(
        "elements", _elements, meaning="masses, springs, … and their nodes"
    )
    port: str = part("node", _port, "handle", meaning="the node that the hand holds")

    def __post_init__(self) -> None:
        super().__post_init__()
        nodes = self.nodes
        if self.port and self.port not in nodes:
            raise InputError(
                f'the port "{self.port}" is no node of the scene, whose nodes are: {", ".join(nodes)}'
            )
        ties(self.elements, self.port)

    @property
    def nodes(self) -> tuple[str, ...]:
        """The nodes that may move, in the order in which they are named."""
        return tuple(dict.fromkeys(n for e in self.elements for n in e.nodes if n != GROUND))

    @cached_property
    def titles(self) -> tuple[str, ...]:
        """A name for each element, all different."""
        own = [e.title for e in self.elements]
        return tuple(t if own.count(t) == 1 else f"{t} {own[: i + 1].count(t)}" for i, t in enumerate(own))

    @property
    def joined(self) -> tuple[Element, ...]:
        """The elements without levers, which are no more than ties."""
        return tuple(e for e in self.elements if e.ratio is None)

    @property
    def ties(self) -> Ties:
        """Free nodes, ties, and what each element is between."""
        return ties(self.elements, self.port)

    @property
    def linear(self) -> bool:
        """True when H(z) says all about it, and is at hand: see `has_transfer_function`."""
        return self.has_transfer_function

    @property
    def has_transfer_function(self) -> bool:
        """True without contact, friction and springs through points, of at most 60 masses and springs."""
        small = self._states <= MOST_STATES
        return self._whole and small and all(e.law is None for e in self.elements)

    @property
    def _states(self) -> int:
        return sum(e.ratio is None and e.law is None and e.reflection != 0 for e in self.elements)

    passive_backward = True
    """True: it is made so."""

    @property
    def starts_at_rest(self) -> bool:
        """True of a scene that can be held, and into which nobody else feeds energy by a line."""
        return self._whole

    @property
    def _whole(self) -> bool:
        return bool(self.port) and not any(e.leads_elsewhere for e in self.elements)

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """E(z), from the position of the port to the mean force of the step before [N/m].

        Raises
        ------
        InputError
            If an element is not linear.
        """
        from zwidth.model.scene.impedance import from_position

        return from_position(self.impedance(sample_period), sample_period)

    def impedance(self, sample_period: Fraction) -> RationalFunction:
        """Z(z), from the mean velocity of the port over a step to the mean force, positive real [N·s/m].

        Raises
        ------
        InputError
            If an element is not linear.
        """
        from zwidth.model.scene.impedance import sampled

        return sampled(self._impedance, sample_period)

    @cached_property
    def _impedance(self) -> RationalFunction:
        """Z(s): of a large scene it takes long, and at every step it is the same."""
        if not self.port:
            raise InputError("the scene has no port: name the node that the hand holds, port=…")
        curved = [t for t, e in zip(self.titles, self.elements, strict=True) if e.law is not None]
        if curved:
            raise InputError(
                f"the scene has no impedance, for {curved[0]} is not linear: put it behind a "
                "virtual coupling, zwidth.VirtualCoupling(stiffness, damping, scene), for zwidth.check"
            )
        from zwidth.model.scene.impedance import impedance

        return impedance(self.joined, self.ties)

    def stepped(self, sample_period: Fraction, couplings: tuple[CouplingLaw, ...] = ()) -> Stepped:
        """The arrays of the compiled step, the port behind couplings, the hand's first."""
        packed = self.packed(sample_period, couplings)
        return Stepped(packed.numbers, float(packed.stored(packed.memory).sum()))

    def packed(self, sample_period: Fraction, couplings: tuple[CouplingLaw, ...] = ()) -> Packed:
        """The same, with what stands where in them."""
        from zwidth.model.scene.pack import pack

        elements, port = coupled(self.elements, self.port, couplings, sample_period)
        return pack([e for e in elements if e.ratio is None], ties(elements, port), sample_period)

    def report(self) -> Iterable[Part]:
        """Its elements, one to a row."""
        held = f'held at "{self.port}"' if self.port else "moved by lines alone"
        yield f"scene of {len(self.elements)} elements and {len(self.nodes)} nodes, {held}"
        yield ""
        yield Table(
            heads=[["element", "first", "second", ""]],
            rows=[
                [title, *e.nodes, e.describe().removeprefix(e.title).strip()]
                for title, e in zip(self.titles, self.elements, strict=True)
            ],
            lefts=4,
        )

    __repr__ = Shown.__repr__

    def describe(self, motion: str = "linear") -> str:
        if len(self.elements) > 4:
            return (
                f'scene of {len(self.elements)} elements and {len(self.nodes)} nodes, held at "{self.port}"'
            )
        return f'scene held at "{self.port}": {"; ".join(e.describe(motion) for e in self.elements)}'


# Virtual couplings before a scene, as elements of it.
#
#     f_k = K u_k + B (u_k − u_{k−1})/T,  u the stretch,
#
# is a spring K of the scene with a damper B + K T/2 beside it: K T/2 is what backward Euler loses more than
# the midpoint rule.


@dataclass(frozen=True)
class CouplingPart(Element):
    """Spring or damper of a coupling, of any sign: whether it is passive is not the scene's to say."""

    symbol: ClassVar[str] = "Z"

    ends: tuple[str, str]
    number: Fraction
    reflects: int

    @property
    def reflection(self) -> int:  # type: ignore[override]  # it has either
        """1 of the spring, 0 of the damper."""
        return self.reflects

    @property
    def nodes(self) -> tuple[str, str]:
        return self.ends

    @property
    def title(self) -> str:
        return f"coupling's {'spring' if self.reflects else 'damper'}"

    def resistance(self, period: Fraction) -> Fraction:
        return self.number

    def describe(self, motion: str = "linear") -> str:
        return self.title


def coupled(
    elements: Sequence[Element], port: str, couplings: Sequence[CouplingLaw], period: Fraction
) -> tuple[tuple[Element, ...], str]:
    """The elements with those of the couplings, the hand's first; and the hand's node, the new port."""
    if not couplings:
        return tuple(elements), port
    hands = [" " * (i + 1) for i in range(len(couplings))]  # no node of a person's is called so
    more = [
        part
        for (k, b), ends in zip(couplings, zip(hands, [*hands[1:], port], strict=True), strict=True)
        for part in (CouplingPart(ends, k * period / 2, 1), CouplingPart(ends, b + k * period / 2, 0))
        if part.number
    ]
    return (*more, *elements), hands[0]
