"""What a document that was accepted is about, read from the numbers that entered the proof.

A proof says no more than its theorem.  So the checker itself says of each kind which hands it covers,
whether they may break contact, and what of the encoder and the actuator is counted; whoever shows a
verdict shows this, and takes it from nowhere else.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Literal, NamedTuple

Contact = Literal["made and broken", "kept", "both sides"]
FedWith = Literal["position", "penetration", ""]
BROKEN: Contact = "made and broken"
KEPT: Contact = "kept"
BOTH_SIDES: Contact = "both sides"
IDEAL, COUNTED = "ideal", "counted"
PASSIVE, ACTIVE, STABLE, UNSTABLE, INDEX, NO_INDEX = (
    "passive", "active", "stable", "unstable", "index at least", "index below",
)  # fmt: skip


class Scope(NamedTuple):
    """What was shown, and of whom.

    Parameters
    ----------
    shows
        "passive": no hand of these takes energy out.  "active": one does.  "stable", "unstable": a known
        hand comes to rest, or does not.  "index at least", "index below": of a port.
    hands
        "every"; "bounded", within bounds of speed and depth; "activity", that give out no more than a
        stated activity; "known".
    contact
        "made and broken" at will; "kept": the hand stays inside; "both sides": the law has no surface.
        Of a motion: what it does.
    encoder
        "ideal", or "counted": its steps are in the proof.
    force_limit, force_steps
        Whether the actuator's limit, and its converter's steps, are in the proof.
    fed_with
        What a law with a memory must be fed with for the proof to hold, "position" or "penetration"; or "".
    """

    shows: str
    hands: str = "every"
    contact: Contact = BOTH_SIDES
    encoder: str = IDEAL
    force_limit: bool = False
    force_steps: bool = False
    fed_with: FedWith = ""


def scope_of(document: Mapping[str, Any]) -> Scope:
    """The scope of one certificate or witness that the checker has accepted."""
    return _SCOPES[document["kind"]](document)


def weakest(scopes: Sequence[Scope]) -> Scope | None:
    """What proofs claim that cover something only together; None where they show different things."""
    contacts = {scope.contact for scope in scopes}
    first = scopes[0]
    if {scope.shows for scope in scopes} != {first.shows}:
        return None
    return first._replace(
        contact=next(c for c in (KEPT, BROKEN, BOTH_SIDES) if c in contacts),
        hands=next((s.hands for s in scopes if s.hands != "every"), "every"),
        encoder=COUNTED if any(s.encoder == COUNTED for s in scopes) else IDEAL,
        force_limit=all(s.force_limit for s in scopes),
        force_steps=all(s.force_steps for s in scopes),
    )


def _encoder(loop: Mapping[str, Any]) -> str:
    steps = [value for key, value in loop.items() if key.startswith("resolution")]
    return COUNTED if any(Fraction(str(step)) for step in steps) else IDEAL


def _of_every_hand(touched: Contact, shows: str = PASSIVE) -> Callable[[Mapping[str, Any]], Scope]:
    def scope(document: Mapping[str, Any]) -> Scope:
        loop = document["loop"]
        contact = touched if loop["unilateral"] else BOTH_SIDES
        return Scope(shows, "every", contact, _encoder(loop))

    return scope


def _of_a_fed_law(document: Mapping[str, Any]) -> Scope:
    """The proof holds for what its memory is fed with, and may fail for the other."""
    return _of_every_hand(BROKEN)(document)._replace(fed_with=document["law"]["fed_with"])


def _force_bounding(document: Mapping[str, Any]) -> Scope:
    """Whatever is commanded, contact or none; it reckons with its own limit and with half a step."""
    loop = document["loop"]
    stepped = any(Fraction(str(v)) for k, v in loop.items() if k.startswith("force_resolution"))
    return Scope(PASSIVE, "every", BROKEN, _encoder(loop), True, stepped)


def _on_a_grid(shows: str) -> Callable[[Mapping[str, Any]], Scope]:
    def scope(document: Mapping[str, Any]) -> Scope:
        law = document["law"]
        contact = BOTH_SIDES if law.get("surface") == "none" else BROKEN
        limited, stepped = (any(k.startswith(n) for k in law) for n in ("force_limit", "force_step"))
        hands = "bounded" if shows == PASSIVE else "every"
        return Scope(shows, hands, contact, _encoder(document["loop"]), limited, stepped)

    return scope


def _of_a_table(shows: str) -> Callable[[Mapping[str, Any]], Scope]:
    """Laws in a row: the table lists the forces as they come out, whatever made them."""

    def scope(document: Mapping[str, Any]) -> Scope:
        hands = "bounded" if shows == PASSIVE else "every"
        return Scope(shows, hands, BROKEN, _encoder(document["loop"]))

    return scope


def _activity(document: Mapping[str, Any]) -> Scope:
    reduced = document["proof"].get("reduced")
    inner = _SCOPES["linear"](document) if reduced is None else scope_of(reduced)
    return inner._replace(hands="activity")


def _motion(document: Mapping[str, Any]) -> Scope:
    """A motion that stays inside refutes a loop with contact kept; one that leaves does not."""
    loop = document["loop"]
    x = [Fraction(str(v)) for key in document if key.startswith("positions_") for v in document[key]]
    contact = (KEPT if min(x[1:-1], default=1) > 0 else BROKEN) if loop["unilateral"] else BOTH_SIDES
    return Scope(ACTIVE, "every", contact, _encoder(loop))


def _known_hand(shows: str) -> Callable[[Mapping[str, Any]], Scope]:
    return lambda document: Scope(shows, "known", KEPT)


def _port(shows: str) -> Callable[[Mapping[str, Any]], Scope]:
    return lambda document: Scope(shows)


_SCOPES: dict[str, Callable[[Mapping[str, Any]], Scope]] = {
    "spring": _of_every_hand(BROKEN),
    "contact": _of_every_hand(BROKEN),
    "relaxing contact": _of_a_fed_law,
    "multiplier contact": _of_a_fed_law,
    "touching motion": _of_every_hand(BROKEN, ACTIVE),
    "nonlinear spring": lambda document: Scope(PASSIVE, encoder=_encoder(document["loop"])),
    "linear": _of_every_hand(KEPT),
    "quantized": _of_every_hand(KEPT),
    "delays": _of_every_hand(KEPT),
    "force bounding": _force_bounding,
    "slow hands": lambda document: _of_every_hand(BROKEN)(document)._replace(hands="bounded"),
    "storage": _on_a_grid(PASSIVE),
    "coarse storage": _on_a_grid(PASSIVE),
    "row storage": _of_a_table(PASSIVE),
    "active hand": _activity,
    "arm": lambda document: Scope(PASSIVE, encoder=document["loop"]["encoder"]),
    "endless pull": lambda document: Scope(ACTIVE, encoder=_encoder(document["loop"])),
    "violation": _of_every_hand(KEPT, ACTIVE),
    "motion": _motion,
    "contact motion": _on_a_grid(ACTIVE),
    "row motion": _of_a_table(ACTIVE),
    "stability": _known_hand(STABLE),
    "absolute stability": lambda document: Scope(STABLE, "known", BROKEN),
    "instability": _known_hand(UNSTABLE),
    "vibration": _known_hand(UNSTABLE),
    "positive real": _port(INDEX),
    "positive real matrix": _port(INDEX),
    "extraction": _port(NO_INDEX),
    "matrix extraction": _port(NO_INDEX),
}
