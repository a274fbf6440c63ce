"""Every kind of document: what it consists of, how it is checked, and what it covers once it is accepted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from . import scope
from .active_hand import ACTIVE_HAND, active_hand
from .arm.null_space import NULL_SPACE, null_space
from .arm.region import ARM, arm
from .contact.motion import CONTACT_MOTION, ROW_MOTION, contact_motion_energy, row_motion_energy
from .contact.multiplier import MULTIPLIER_CONTACT, multiplier_contact
from .contact.touching_motion import TOUCHING_MOTION, touching_motion_energy
from .contact.walls import CONTACT, RELAXING_CONTACT, SLOW_HANDS, contact, relaxing_contact, slow_hands
from .document.fields import Choice, Read, Record
from .document.number import about
from .document.refusal import Invalid
from .known_hand.rest import KNOWN_HAND, instability, stability
from .known_hand.wall import ABSOLUTE_STABILITY, VIBRATION, absolute, vibration
from .loop.ledger import FORCE_BOUNDING, WAVE_PORT, force_bounding, wave_port
from .loop.linear import DELAYS, LINEAR, QUANTIZED, delays, linear, quantized
from .loop.motion import MOTION, motion_energy, stored_at_start
from .loop.spring import NONLINEAR_SPRING, SPRING, endless_pull, nonlinear_spring, spring
from .loop.transmission import ELASTIC, ELASTIC_VIOLATION, elastic, elastic_violation
from .loop.violation import VIOLATION, violation
from .pair.held import HELD_MOTION, HELD_PAIR, HELD_VIOLATION, held_motion_energy, held_pair, held_violation
from .pair.motion import PAIR_MOTION, pair_motion_energy, pair_stored_at_start
from .pair.passive import PAIR_PROOF, PAIR_VIOLATION, pair, pair_violation
from .port.index import POSITIVE_REAL, POSITIVE_REAL_MATRIX, positive_real, positive_real_matrix
from .port.motion import EXTRACTION, MATRIX_EXTRACTION, extraction
from .scope import ACTIVE, BROKEN, INDEX, KEPT, NO_INDEX, PASSIVE, STABLE, UNSTABLE, Scope
from .storage.coarse import COARSE_STORAGE
from .storage.grid import STORAGE
from .storage.plainly import checked
from .storage.row import ROW_STORAGE


class Found(NamedTuple):
    """What a check comes to; `Verified` says what of what."""

    reason: str
    valid: bool = True
    energy: Fraction | None = None
    gain: Fraction | None = None
    surplus: tuple[tuple[float, ...], ...] = ()


class Kind(NamedTuple):
    """One kind of document."""

    fields: Record
    check: Callable[[Read], Found]
    scope: Callable[[Read], Scope]


def _proof(check: Callable[[Read], str]) -> Callable[[Read], Found]:
    return lambda told: Found(check(told))


def _with_surplus(
    check: Callable[[Read], tuple[str, tuple[tuple[float, ...], ...]]],
) -> Callable[[Read], Found]:
    def found(told: Read) -> Found:
        reason, surplus = check(told)
        return Found(reason, surplus=surplus)

    return found


def _taken(check: Callable[[Read], tuple[str, Fraction]]) -> Callable[[Read], Found]:
    def found(told: Read) -> Found:
        reason, energy = check(told)
        return Found(reason, energy=energy)

    return found


def _motion(energy_of: Callable[[Read], Fraction], stored_of: Callable[[Read], Fraction]) -> Any:
    """A motion is a witness if more energy comes out than was in, and as much as it says."""

    def found(told: Read) -> Found:
        energy, stored = energy_of(told), stored_of(told)
        out = f"the motion extracts {about(energy)} J"
        if energy <= stored:
            return Found(f"{out}, no more than the {about(stored)} J stored before", False, energy)
        return _as_told(told, Found(out, energy=energy))

    return found


def _round_again(sums_of: Callable[[Read], tuple[Fraction, Fraction]]) -> Callable[[Read], Found]:
    """A motion that gains in all, and gains again with every further round."""

    def found(told: Read) -> Found:
        energy, gain = sums_of(told)
        if energy <= 0 or gain <= 0:
            less = about(min(energy, gain))
            return Found(f"the motion extracts {less} J: none comes out", False, energy, gain)
        reason = f"the motion extracts {about(energy)} J, and {about(gain)} J more with each round"
        return _as_told(told, Found(reason, True, energy, gain))

    return found


def _as_told(told: Read, found: Found) -> Found:
    """Refused where the energy, or the sample period beside the motion, is not the one that is told."""
    energy, period = found.energy or Fraction(0), told.loop.sample_period
    for name, unit, said, is_, room in (
        ("the energy", "J", told.energy, energy, energy / 10**9),
        ("T", "s", told.sample_period, period, Fraction(0)),
    ):
        if said is not None and abs(said - is_) > room:
            wrong = f"{name} is {about(is_)} {unit}, not {about(said)} {unit}"
            return found._replace(valid=False, reason=wrong)
    return found


def _nothing(told: Read) -> Fraction:
    return Fraction(0)


def _activity(told: Read) -> Scope:
    reduced = getattr(told.proof, "reduced", None)
    inner = scope.of_every_hand(KEPT)(told) if reduced is None else KINDS[reduced.kind].scope(reduced)
    return inner._replace(hands="activity")


_of_every_hand, _on_a_grid, _of_a_row = scope.of_every_hand, scope.on_a_grid, scope.of_a_row

KINDS: dict[str, Kind] = {
    "spring": Kind(SPRING, _proof(spring), _of_every_hand(BROKEN)),
    "linear": Kind(LINEAR, _proof(linear), _of_every_hand(KEPT)),
    "quantized": Kind(QUANTIZED, _proof(quantized), _of_every_hand(KEPT)),
    "delays": Kind(DELAYS, _proof(delays), _of_every_hand(KEPT)),
    "transmission": Kind(ELASTIC, _proof(elastic), scope.of_a_transmission(PASSIVE)),
    "transmission violation": Kind(
        ELASTIC_VIOLATION, _proof(elastic_violation), scope.of_a_transmission(ACTIVE)
    ),
    "contact": Kind(CONTACT, _proof(contact), _of_every_hand(BROKEN)),
    "relaxing contact": Kind(RELAXING_CONTACT, _proof(relaxing_contact), scope.of_a_fed_law),
    "multiplier contact": Kind(MULTIPLIER_CONTACT, _proof(multiplier_contact), scope.of_a_fed_law),
    "nonlinear spring": Kind(NONLINEAR_SPRING, _proof(nonlinear_spring), scope.of_points(PASSIVE)),
    "endless pull": Kind(NONLINEAR_SPRING, _proof(endless_pull), scope.of_points(ACTIVE)),
    "force bounding": Kind(FORCE_BOUNDING, _proof(force_bounding), scope.of_force_bounding),
    "wave port": Kind(WAVE_PORT, _proof(wave_port), scope.of_a_wave_port),
    "slow hands": Kind(SLOW_HANDS, _proof(slow_hands), scope.of_slow_hands),
    "active hand": Kind(ACTIVE_HAND, _proof(active_hand), _activity),
    "storage": Kind(STORAGE, _proof(checked), _on_a_grid(PASSIVE)),
    "coarse storage": Kind(COARSE_STORAGE, _proof(checked), _on_a_grid(PASSIVE)),
    "row storage": Kind(ROW_STORAGE, _proof(checked), _of_a_row(PASSIVE)),
    "pair": Kind(PAIR_PROOF, _proof(pair), scope.of_a_pair(PASSIVE)),
    "pair violation": Kind(PAIR_VIOLATION, _proof(pair_violation), scope.of_a_pair(ACTIVE)),
    "pair motion": Kind(
        PAIR_MOTION, _motion(pair_motion_energy, pair_stored_at_start), scope.of_a_pair(ACTIVE)
    ),
    "held pair": Kind(HELD_PAIR, _proof(held_pair), scope.of_a_held_pair(PASSIVE)),
    "held pair violation": Kind(HELD_VIOLATION, _proof(held_violation), scope.of_a_held_pair(ACTIVE)),
    "held pair motion": Kind(
        HELD_MOTION, _motion(held_motion_energy, _nothing), scope.of_a_held_pair(ACTIVE)
    ),
    "arm": Kind(ARM, _with_surplus(arm), scope.of_an_arm),
    "null space": Kind(NULL_SPACE, _with_surplus(null_space), scope.of_a_null_space),
    "violation": Kind(VIOLATION, _proof(violation), _of_every_hand(KEPT, ACTIVE)),
    "motion": Kind(MOTION, _motion(motion_energy, stored_at_start), scope.of_a_motion),
    "touching motion": Kind(
        TOUCHING_MOTION, _motion(touching_motion_energy, _nothing), _of_every_hand(BROKEN, ACTIVE)
    ),
    "contact motion": Kind(CONTACT_MOTION, _round_again(contact_motion_energy), _on_a_grid(ACTIVE)),
    "row motion": Kind(ROW_MOTION, _round_again(row_motion_energy), _of_a_row(ACTIVE)),
    "stability": Kind(KNOWN_HAND, _proof(stability), scope.of_a_known_hand(STABLE)),
    "instability": Kind(KNOWN_HAND, _proof(instability), scope.of_a_known_hand(UNSTABLE)),
    "absolute stability": Kind(ABSOLUTE_STABILITY, _proof(absolute), scope.of_a_known_hand(STABLE, BROKEN)),
    "vibration": Kind(VIBRATION, _proof(vibration), scope.of_a_known_hand(UNSTABLE, BROKEN)),
    "positive real": Kind(POSITIVE_REAL, _proof(positive_real), scope.of_a_port(INDEX)),
    "positive real matrix": Kind(POSITIVE_REAL_MATRIX, _proof(positive_real_matrix), scope.of_a_port(INDEX)),
    "extraction": Kind(EXTRACTION, _taken(extraction), scope.of_a_port(NO_INDEX)),
    "matrix extraction": Kind(MATRIX_EXTRACTION, _taken(extraction), scope.of_a_port(NO_INDEX)),
}


def kind_of(document: Mapping[str, Any]) -> str:
    """The kind that a document says it is of."""
    told = document.get("kind")
    if not isinstance(told, str) or told not in KINDS:
        raise Invalid(f"kind must be corners, {', '.join(KINDS)}; got {str(told)[:40]!r}")
    return told


_FIELDS = {kind: told.fields.extended(kind=Choice(kind, shown=False)) for kind, told in KINDS.items()}


def fields_of(kind: str) -> Record:
    """All that a document of a kind consists of."""
    return _FIELDS[kind]
