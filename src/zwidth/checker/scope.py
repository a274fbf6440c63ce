"""What a document that was accepted is about, read from the numbers that entered the proof.

A proof says no more than its theorem.  So the checker itself says of each kind which hands it covers,
whether they may break contact, and what of the encoder and the actuator is counted; whoever shows a
verdict shows this, and takes it from nowhere else.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

from .document.fields import Read

Contact = Literal["made and broken", "kept", "both sides"]
FedWith = Literal["position", "penetration", ""]
BROKEN: Contact = "made and broken"
KEPT: Contact = "kept"
BOTH_SIDES: Contact = "both sides"
IDEAL, COUNTED = "ideal", "counted"
RIGID = "rigid"
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
        stated activity; "known"; "beside a known one", of two arms one of which that one holds.
    contact
        "made and broken" at will; "kept": the hand stays inside; "both sides": the law has no surface.
        Of a motion: what it does.
    encoder
        "ideal", or "counted": its steps are in the proof.
    force_limit, force_steps
        Whether the actuator's limit, and its converter's steps, are in the proof.
    fed_with
        What a law with a memory must be fed with for the proof to hold, "position" or "penetration"; or "".
    transmission
        "as given": motor and hand are joined by a spring and a damper of these numbers, and by no others.
    """

    shows: str
    hands: str = "every"
    contact: Contact = BOTH_SIDES
    encoder: str = IDEAL
    force_limit: bool = False
    force_steps: bool = False
    fed_with: FedWith = ""
    transmission: str = ""


def weakest(scopes: Sequence[Scope]) -> Scope | None:
    """What proofs claim that cover something only together; None where they show different things."""
    contacts, hands = {scope.contact for scope in scopes}, {scope.hands for scope in scopes}
    fed = {scope.fed_with for scope in scopes if scope.fed_with}
    first = scopes[0]
    if {scope.shows for scope in scopes} != {first.shows} or len(fed) > 1:
        return None
    return first._replace(
        contact=next(c for c in (KEPT, BROKEN, BOTH_SIDES) if c in contacts),
        hands=next(h for h in _FEWEST_FIRST if h in hands),
        encoder=COUNTED if any(s.encoder == COUNTED for s in scopes) else IDEAL,
        force_limit=all(s.force_limit for s in scopes),
        force_steps=all(s.force_steps for s in scopes),
        fed_with=next(iter(fed), ""),
        transmission=next((s.transmission for s in scopes if s.transmission), ""),
    )


_FEWEST_FIRST = ("known", "beside a known one", "bounded", "every", "activity")
"""Each of them is among the hands of the next one: those of an activity may also have none."""


def _encoder(told: Read) -> str:
    return COUNTED if told.loop.resolution else IDEAL


def of_every_hand(touched: Contact, shows: str = PASSIVE) -> Callable[[Read], Scope]:
    """Every hand; with contact as said where the law has a surface."""
    return lambda told: Scope(
        shows, contact=touched if told.loop.unilateral else BOTH_SIDES, encoder=_encoder(told)
    )


def of_a_transmission(shows: str) -> Callable[[Read], Scope]:
    """A hand that stays inside, behind this transmission and no other."""
    return lambda told: of_every_hand(KEPT, shows)(told)._replace(transmission="as given")


def of_a_fed_law(told: Read) -> Scope:
    """The proof holds for what its memory is fed with, and may fail for the other."""
    return of_every_hand(BROKEN)(told)._replace(fed_with=told.law.fed_with)


def of_slow_hands(told: Read) -> Scope:
    """Hands within a bound on their speed."""
    return of_every_hand(BROKEN)(told)._replace(hands="bounded")


def of_points(shows: str) -> Callable[[Read], Scope]:
    """A spring that acts everywhere."""
    return lambda told: Scope(shows, encoder=_encoder(told))


def of_force_bounding(told: Read) -> Scope:
    """Whatever is commanded, contact or none; it reckons with its own limit and with half a step."""
    stepped = told.loop.force_resolution > 0
    return Scope(PASSIVE, "every", BROKEN, _encoder(told), True, stepped)


def of_a_wave_port(told: Read) -> Scope:
    """Any link; it asks for no more than the actuator gives, in its steps."""
    return Scope(PASSIVE, encoder=_encoder(told), force_limit=True, force_steps=True)


def on_a_grid(shows: str) -> Callable[[Read], Scope]:
    """Hands within the grid; a motion is one whatever they are."""

    def scope(told: Read) -> Scope:
        law = told.law
        contact = BOTH_SIDES if law.surface == "none" else BROKEN
        limited, stepped = law.force_limit is not None, law.force_step is not None
        return Scope(shows, _hands(shows), contact, _encoder(told), limited, stepped)

    return scope


def of_a_row(shows: str) -> Callable[[Read], Scope]:
    """Laws in a chain: the table lists the forces as they come out, whatever made them."""
    return lambda told: Scope(shows, _hands(shows), BROKEN, _encoder(told))


def _hands(shows: str) -> str:
    return "bounded" if shows == PASSIVE else "every"


def of_a_motion(told: Read) -> Scope:
    """A motion that stays inside refutes a loop with contact kept; one that leaves does not."""
    stays = min(told.positions[1:-1], default=1) > 0
    return of_every_hand(KEPT if stays else BROKEN, ACTIVE)(told)


def of_a_known_hand(shows: str, contact: Contact = KEPT) -> Callable[[Read], Scope]:
    """One hand, of which everything is known."""
    return lambda told: Scope(shows, "known", contact)


def of_an_arm(told: Read) -> Scope:
    """The document says whether steps are counted."""
    return Scope(PASSIVE, encoder=told.loop.encoder)


def of_a_null_space(told: Read) -> Scope:
    """No steps are counted."""
    return Scope(PASSIVE)


def of_a_pair(shows: str) -> Callable[[Read], Scope]:
    """Two hands, one on each arm; the spring between the arms has no surface."""

    def scope(told: Read) -> Scope:
        counted = told.loop.leader.resolution or told.loop.follower.resolution
        return Scope(shows, encoder=COUNTED if counted else IDEAL)

    return scope


def of_a_held_pair(shows: str) -> Callable[[Read], Scope]:
    """Every hand on one arm; on the other one that is known."""
    return lambda told: of_a_pair(shows)(told)._replace(hands="beside a known one")


def of_a_port(shows: str) -> Callable[[Read], Scope]:
    """A system, and no loop."""
    return lambda told: Scope(shows)
