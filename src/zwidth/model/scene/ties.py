"""Which velocities of a scene are free: levers tie nodes, the ground holds them, the port is moved.

    v_node = ratio · v_root        v̄ of an element = α q_i − β q_j + c v_port

Ties are put in exactly, so that no force of a lever is ever computed and loops of levers may be closed: where
two contradict each other the node does not move.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from zwidth.errors import InputError
from zwidth.model.scene.element import GROUND, Element

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
