"""What a document consists of: statements, the evidence of each, and what it tells without any.

A piece of evidence has a `kind`, and states what its kind proves.  Any other document has a `format`, an
outcome, and evidence under three names; it may hold others, one, listed or named.  Every entry is read, or is
among those that its format tells without proof, which are named, or is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from .document.file import Unreadable, require_shallow
from .document.refusal import Invalid, spend
from .scope import ACTIVE, BOTH_SIDES, BROKEN, COUNTED, IDEAL, KEPT, PASSIVE, STABLE, UNSTABLE

EVIDENCE = ("certificate", "violation", "witness")
"""The entries that hold what can be checked: the first shows the better outcome, the others the worse."""

NO_STEPS, IN_CONTACT, PAPER, UNDECIDED = (
    "passive without encoder steps", "passive in contact", "theorem", "undecided",
)  # fmt: skip
PASSIVITY = (PASSIVE, IN_CONTACT, NO_STEPS, PAPER, ACTIVE, UNDECIDED)
REST = (STABLE, UNSTABLE, UNDECIDED)
_EVERY = ("every", "activity")
"""Proofs of hands that give out some activity hold for those that give out none."""


class Shape(NamedTuple):
    """What a document of a format consists of.

    Parameters
    ----------
    told
        The first words of entries that nothing proves; a unit may follow.
    inside
        Entries that hold documents: of which formats, and whether it is "one", "listed" or "named" ones.
    outcomes
        The words that may stand as its outcome; none: it has no such entry.
    states
        Without that entry: what its certificate has to show, and what its violation and its motion.
    values
        Entries that are null exactly where the evidence of that name is left out.
    hands
        Whom its evidence may be about, where not every hand.
    kept
        True if contact is kept, whatever its scope says.
    """

    told: tuple[str, ...] = ()
    inside: Mapping[str, tuple[str, str]] = {}
    outcomes: tuple[str, ...] = PASSIVITY
    states: tuple[str, str] | None = None
    values: Mapping[str, str] = {}
    hands: tuple[str, ...] = _EVERY
    kept: bool = False


_LOOP = ("limit", "advice", "required_damping")
_OF_AN_ARM = (
    "arm",
    "joint_damping",
    "joint_names",
    "wall",
    "sample_period",
    "delay_samples",
    "stiffness_factor",
    "largest_stiffness",
    "motion",
)
_HOLDS_ARMS = (*_EVERY, "beside a known one")

_ACTIVITY = Shape(
    outcomes=(), states=(PASSIVE, ACTIVE), values={"activity": "certificate"}, hands=("activity",)
)

VERDICT = "zwidth verdict 1"
SHAPES: dict[str, Shape] = {
    VERDICT: Shape(
        told=(
            *_LOOP, "decided_by", "mode", "max_stiffness", "max_gain", "critical_frequency",
            "admissible_speed", "margins", "actuator", "real_hand", "ranges",
            "max_stiffness_any_transmission", "max_stiffness_viscous", "resonance", "hand_motion",
            "active_at",
        ),
        inside={
            "best_corner": ("one", "zwidth verdict 1"),
            "worst_hand": ("one", "zwidth worst hand 1"),
            "active_hand": ("one", "zwidth activity 1"),
            "known_hands": ("named", "zwidth stability 1"),
        },
    ),
    "zwidth worst hand 1": Shape(hands=(*_EVERY, "bounded")),
    "zwidth bounding 1": Shape(),
    "zwidth limit 1": Shape(
        told=(
            "parameter", "relative_width", "hand", "every_hand", "evaluations", "cut_by_time", "hand_motion",
        ),
        outcomes=(),
        states=(PASSIVE, ACTIVE),
        values={"proved_passive": "certificate", "proved_active": "violation"},
        hands=(*_EVERY, "bounded"),
    ),
    "zwidth stability 1": Shape(
        told=("spectral_radius", "frequency", "max_stiffness", "limit_frequency"),
        outcomes=REST,
        hands=("known",),
    ),
    "zwidth absolute stability 1": Shape(
        told=("slopes", "linear_limit", "motions"), outcomes=(), states=(STABLE, UNSTABLE), hands=("known",)
    ),
    "zwidth activity 1": Shape(
        told=("below", "shaking_hand"),
        inside={"contact_kept": ("one", "contact kept"), "contact_broken": ("one", "contact broken")},
        outcomes=(),
    ),
    "contact kept": _ACTIVITY._replace(kept=True),
    "contact broken": _ACTIVITY,
    "zwidth pair 1": Shape(
        told=(
            *_LOOP, "notes", "power_ratio", "largest_stiffness", "required", "largest_compensation",
            "compensation_takes",
        )
    ),
    "zwidth held pair 1": Shape(
        told=(*_LOOP, "held", "power_ratio", "largest_stiffness", "required"), hands=_HOLDS_ARMS
    ),
    "zwidth gains 1": Shape(told=("family", "notes"), inside={"joints": ("listed", "joint of two arms")}),
    "joint of two arms": Shape(
        told=(
            *_LOOP, "name", "leader", "follower", "with_ideal_drive", "damping", "is_searched", "stiffest",
            "best", "largest_compensation",
        )
    ),
    "zwidth held joints 1": Shape(told=("notes",), inside={"joints": ("listed", "joint of an arm")}),
    "joint of an arm": Shape(told=(*_LOOP, "name", "source", "stiffness", "integral", "damping")),
    "zwidth passive masses 1": Shape(
        told=("body", "intervals"), inside={"verdicts": ("listed", "one mass")}, outcomes=()
    ),
    "one mass": Shape(told=("virtual_mass",)),
    "zwidth each 1": Shape(inside={"devices": ("listed", "one device")}, outcomes=()),
    "zwidth indices 1": Shape(told=("input_index", "output_index", "violated", "damping"), hands=("port",)),
    "zwidth scattering 1": Shape(told=("signs", "largest_gain", "violated"), hands=("port",)),
    "zwidth coupling condition 1": Shape(told=("stiffness", "damping", *_LOOP)),
    "zwidth coupling design 1": Shape(
        told=("stiffness", "damping", *_LOOP, "margin", "felt_slowly_stiffness", "felt_quickly_stiffness")
    ),
    "zwidth transformed condition 1": Shape(told=("required_damping", "binding")),
    "zwidth port 1": Shape(told=("port", "link", "motion")),
    "zwidth workspace 1": Shape(
        told=(
            *_OF_AN_ARM, "region", "torque", "encoder", "largest_forces", "largest_moments",
            "can_be_refuted", "smallest_margin", "encoder_steps", "addition_to_all", "addition_to_one",
            "least_additions", "wall_leaves_out", "too_little", "proved_part",
        )
    ),
    "zwidth postures 1": Shape(
        told=(*_OF_AN_ARM, "postures", "worst_joints", "damping_factor", "encoder_factor")
    ),
    "zwidth null space 1": Shape(
        told=(
            *_OF_AN_ARM, "null_stiffness", "null_damping", "null_rest", "regularization", "within", "covered",
            "why_not_more", "wall_factor", "largest_null_damping", "fast_motion", "slow_loop",
        )
    ),
}  # fmt: skip
"""By format; those of entries in others by a name of their own."""
SHAPES["one device"] = SHAPES[VERDICT]._replace(told=(*SHAPES[VERDICT].told, "device", "measured_stiffness"))


class Statement(NamedTuple):
    """What one object of a document states, and the evidence that it gives for it.

    `listed` are the outcomes of those that it lists; None where it has no list.
    """

    at: str
    shape: Shape
    outcome: str | None
    scope: Mapping[str, Any]
    evidence: Mapping[str, Mapping[str, Any]]
    listed: tuple[str | None, ...] | None = None

    def place(self, name: str) -> str:
        """Where an entry of it stands."""
        return f"{self.at}.{name}" if self.at else name


class Whole(NamedTuple):
    """A document as it was read.

    Parameters
    ----------
    statements
        In the order in which they stand.
    told
        Where entries stand that nothing proves.
    """

    statements: tuple[Statement, ...]
    told: tuple[str, ...]


_SCOPE = {
    "contact": (BROKEN, KEPT, BOTH_SIDES),
    "encoder": (IDEAL, COUNTED, "not counted"),
    "fed_with": ("position", "penetration", ""),
    "force_limit_counted": (True, False),
    "force_steps_counted": (True, False),
    "transmission": ("rigid", "any", "as given", ""),
}
"""What of a scope is held against the evidence, beside the hands."""
_HANDS = ("every", "bounded", "known", "activity")
_OF_A_SCOPE = Shape(
    told=(
        "sampling", "clamped", "damping", "coulomb_friction", "friction_speed", "largest_force",
        "largest_moment", "torque", "friction", "region", "bounds", "intervals", "assumed",
        "law", "also",
    )
)  # fmt: skip
"""What of it nothing proves."""

_NONE = f"no evidence found: the object has no key kind, {', '.join(EVIDENCE[:-1])} or {EVIDENCE[-1]}"


def read_whole(document: object) -> Whole:
    """What a document states and holds; `Unreadable` where there is nothing to check, else `Invalid`."""
    if not isinstance(document, Mapping):
        raise Unreadable("expected a JSON object with a certificate, a violation or a witness")
    require_shallow(document)
    if not {"kind", "format", *EVIDENCE, *SHAPES[VERDICT].inside} & set(document):
        raise Unreadable(_NONE)
    told: list[str] = []
    if "kind" in document:
        statements = [Statement("", Shape(outcomes=()), None, {}, {"": document})]
    else:
        statements = _statements(document, "", str(document.get("format", VERDICT)), told)
    if not any(statement.evidence for statement in statements):
        said = str(document.get("outcome", ""))[:40]
        without = f"no evidence found: it says {said!r}, and holds no proof or motion that is checked"
        raise Unreadable(without if said and "format" in document else _NONE)
    return Whole(tuple(statements), tuple(told))


def _statements(document: object, at: str, sort: str, told: list[str]) -> list[Statement]:
    """What an object of a sort states, and then what those in it do; `told` grows."""
    spend(200)
    document, shape, place = _object(document, at), SHAPES.get(sort), f"{at}." if at else ""
    given = document.get("format", sort)
    if shape is None or (sort.startswith("zwidth") and given != sort):
        raise Unreadable(
            f"no evidence found: a document of format {str(given)[:60]!r} holds none that is checked"
        )
    inner: list[Statement] = []
    evidence: dict[str, Mapping[str, Any]] = {}
    scope: Mapping[str, Any] = {}
    outcome = listed = None
    for key, value in document.items():
        if key in EVIDENCE:
            if value is not None:
                evidence[key] = _object(value, place + key)
        elif key == "outcome" and shape.outcomes:
            outcome = _one_of(value, shape.outcomes, place + key)
        elif key == "scope":
            scope = _scope(_object(value, place + key), place + key, told)
        elif key in shape.inside:
            how, inside = shape.inside[key]
            found = [_statements(one, there, inside, told) for there, one in _held(value, place + key, how)]
            inner += (stated for part in found for stated in part)
            listed = tuple(part[0].outcome for part in found) if how == "listed" else listed
        elif key != "format":
            _require_told(key, shape, place)
            told.append(place + key)
    for name, needs in shape.values.items():
        stated = any(v is not None for k, v in document.items() if _is(k, name))
        if stated and not (needs in evidence or (needs != "certificate" and "witness" in evidence)):
            raise Invalid(f"{place}{name} is stated, and no {needs} shows it")
    return [Statement(at, shape, outcome, scope, evidence, listed), *inner]


def _scope(scope: Mapping[str, Any], at: str, told: list[str]) -> Mapping[str, Any]:
    """What a scope says, each word as it may stand; `told` grows."""
    for key, value in scope.items():
        if key == "hands":
            _one_of(_object(value, f"{at}.hands").get("which"), _HANDS, f"{at}.hands.which")
        elif key not in _SCOPE:
            _require_told(key, _OF_A_SCOPE, f"{at}.")
            told.append(f"{at}.{key}")
        elif not any(value is word or (word == value and isinstance(value, str)) for word in _SCOPE[key]):
            words = " or ".join(str(word).lower() for word in _SCOPE[key])
            raise Invalid(f"{at}.{key} must be {words}, got {str(value)[:40]!r}")
    return scope


def _held(value: object, at: str, how: str) -> Iterator[tuple[str, object]]:
    """The documents of an entry, and where they stand."""
    if how == "one":
        yield at, value
    elif how == "named":
        yield from ((f"{at}.{name[:60]}", one) for name, one in _object(value, at).items())
    elif isinstance(value, list):
        yield from ((f"{at}[{place}]", one) for place, one in enumerate(value))
    else:
        raise Invalid(f"{at} must be a list")


def _object(value: object, at: str) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise Invalid(f"{at} must be an object")
    return value


def _one_of(value: Any, words: tuple[str, ...], at: str) -> Any:
    if value not in words:
        raise Invalid(f"{at} must be {', '.join(words[:-1])} or {words[-1]}, got {str(value)[:40]!r}")
    return value


def _is(key: str, name: str) -> bool:
    """True of an entry of that name, with its unit or without one."""
    return key == name or key.startswith(f"{name}_")


def _require_told(key: str, shape: Shape, place: str) -> None:
    known = ("claim", "assumptions", *shape.told, *shape.values)
    if not any(_is(key, name) for name in known):
        raise Invalid(f"entries that no document of this format has: {place}{str(key)[:60]}")
