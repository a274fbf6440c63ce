"""Whole documents: what may be stated over which evidence, what is told beside it, and in which words.

Where it is the statement that matters, evidence is a stand-in that names what it covers: every scope is met
by every statement, with the rules written out once more.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from io import StringIO
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from . import Case, plain
from .parts import part
from .spring import spring

Document = dict[str, Any]
VERDICT = "zwidth verdict 1"
BETTER, WORSE = ("passive", "stable"), ("active", "unstable")
PORT = ("index at least", "index below")
HANDS = ("every", "activity", "bounded", "known", "beside a known one", "port")
OUTCOMES = (
    "passive", "passive in contact", "passive without encoder steps", "theorem", "active", "undecided",
    "stable", "unstable",
)  # fmt: skip


@contextmanager
def put_in_place(module: str, **values: Any) -> Iterator[None]:
    """Something else under these names of a part of the checker, meanwhile."""
    changed = part(module)
    before = {name: getattr(changed, name) for name in values}
    for name, value in values.items():
        setattr(changed, name, value)
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(changed, name, value)


def covering(shows: str = "passive", hands: str = "every", **scope: Any) -> Document:
    """Evidence that is taken for true, of that scope."""
    return {"kind": "stand-in", "scope": {"shows": shows, "hands": hands, **scope}}


def judged(document: object) -> Any:
    """What the checker says of a document whose evidence is made of stand-ins."""
    one, scope = part("one"), part("scope").Scope

    def verify(evidence: Mapping[str, Any]) -> Any:
        covers = evidence.get("scope")
        return one.Verified("false" not in evidence, "as it says", scope=scope(**covers) if covers else None)

    with put_in_place("verdict", verify=verify):
        return part("verdict").judge(document)


def fault(document: object) -> str:
    """Why a document is not valid; "" where it is."""
    found = judged(document)
    wrong = [*found.faults, *(one.verification.reason for one in found.parts if not one.verification.valid)]
    if bool(wrong) is found.valid:
        raise ValueError(f"valid: {found.valid}, and {wrong}")
    return "; ".join(wrong)


def first_wrong(told: Iterator[tuple[str, object, str]]) -> str:
    """Of names, documents and a phrase of the fault, "" for none: the first that comes out otherwise."""
    for name, document, phrase in told:
        try:
            said = fault(document)
        except part("document.file").Unreadable as error:
            said = f"unreadable: {error}"
        if (phrase not in said) if phrase else said:
            return f"{name}: {said or 'valid'}"
    return ""


def fits(said: str, name: str, shows: str, evidence: Document) -> bool:
    """Whether evidence of that name, which shows this of every hand, may stand beside a statement."""
    if shows in PORT:
        wanted = {"passive": "index at least", "active": "index below"}.get(said)
        return said == "undecided" or (
            wanted == shows and evidence["index"] == "input" and evidence["level"] == 0
        )
    if said in ("passive", "passive in contact", "passive without encoder steps"):
        return shows == "passive"
    if said in ("active", "stable", "unstable"):
        return shows == said
    return said != "theorem" and shows in (BETTER if name == "certificate" else WORSE)


def evidence_shows_what_is_stated() -> str:
    """Every outcome, over every evidence, in every format that states one."""
    shapes = part("whole").SHAPES.items()
    unlike = {(one.outcomes, one.hands): name for name, one in shapes if name.startswith("zwidth")}
    for ((outcomes, of_hands), format_), said, name, shows, hands in product(
        unlike.items(), OUTCOMES, ("certificate", "violation", "witness"), (*BETTER, *WORSE, *PORT), HANDS
    ):
        if said not in outcomes:
            continue
        of_a_port = shows in PORT
        for level, index in (
            ((0, "input"), (1, "input"), (-1, "input"), (0, "output")) if of_a_port else ((0, ""),)
        ):
            evidence = {**covering(shows, hands), "level": level, "index": index}
            found = fault({"format": format_, "outcome": said, name: evidence})
            right = fits(said, name, shows, evidence) and ("port" if of_a_port else hands) in of_hands
            if right is bool(found):
                return f"{said} by {name} of {evidence}, {format_}: {found or 'valid'}"
    return ""


def without_an_outcome() -> Iterator[tuple[str, object, str]]:
    """What evidence of each name shows by itself, and what may be told of it alone."""
    limit, rest = "zwidth limit 1", "zwidth absolute stability 1"
    yes, no = covering("passive"), covering("active")
    known, shaking = covering("stable", "known"), covering("unstable", "known")
    yield "passive", {"format": limit, "certificate": yes}, ""
    yield "active", {"format": limit, "violation": no}, ""
    yield "an active motion", {"format": limit, "witness": no}, ""
    yield "the other way round", {"format": limit, "certificate": no}, "this certificate is no such thing"
    yield "a proof as a motion", {"format": limit, "witness": yes}, "this witness is no such thing"
    yield "a proof as a violation", {"format": limit, "violation": yes}, "is a proof of passivity"
    yield "energy comes out", {"format": limit, "certificate": no}, "shows that energy comes out"
    yield "rest", {"format": rest, "certificate": known}, ""
    yield "no rest", {"format": rest, "violation": shaking}, ""
    yield "rest as a violation", {"format": rest, "violation": known}, "something else: that it comes to rest"
    yield "no rest as a proof", {"format": rest, "certificate": shaking}, "that it does not come to rest"
    yield "no outcome", {"certificate": yes}, ""
    yield "no outcome, active", {"certificate": no}, "this certificate is no such thing"
    yield "no outcome, kept", {"certificate": covering(contact="kept")}, ""
    yield "of corners", {"certificate": {"kind": "corners"}}, "of corners that show different things"
    yield "false", {"certificate": {"kind": "x", "false": True}}, "as it says"
    for name, shown_by in (
        ("proved_passive", ("certificate",)),
        ("proved_active_N", ("violation", "witness")),
    ):
        yield "null", {"format": limit, name: None, "certificate": yes}, ""
        for entry, evidence in (("certificate", yes), ("violation", no), ("witness", no)):
            needs = f"{name.removesuffix('_N')} is stated, and no {shown_by[0]} shows it"
            yield name, {"format": limit, name: 1, entry: evidence}, "" if entry in shown_by else needs
    activity = covering("passive", "activity", contact="kept")
    at = {"format": "zwidth activity 1"}
    yield "an activity", {**at, "contact_kept": {"certificate": activity, "activity_W": 1}}, ""
    yield (
        "by a violation",
        {**at, "contact_kept": {"violation": no, "activity_W": 1}},
        ("contact_kept.activity is stated, and no certificate shows it"),
    )
    yield "by a motion", {**at, "contact_kept": {"witness": no, "activity": 1}}, "no certificate shows it"
    yield "of the other", {**at, "contact_broken": {"certificate": activity}}, "keeps contact only"


def of_fewer_hands() -> Iterator[tuple[str, object, str]]:
    """A proof that covers less than the scope that stands beside it."""
    for said, stated, phrase in (
        ({"contact": "kept"}, {}, "covers a hand that keeps contact only"),
        ({"contact": "kept"}, {"contact": "made and broken"}, "covers a hand that keeps contact only"),
        ({"contact": "kept"}, {"contact": "kept"}, ""),
        ({"contact": "made and broken"}, {"contact": "kept"}, ""),
        ({"contact": "both sides"}, {}, ""),
        ({"hands": "bounded"}, {}, "covers hands within bounds only"),
        ({}, {"hands": {"which": "activity"}}, "covers no hand that gives out energy"),
        ({"hands": "activity"}, {"hands": {"which": "activity"}}, ""),
        ({"hands": "activity"}, {"hands": {"which": "every"}}, ""),
        ({}, {"hands": {"which": "bounded", "bounds": 1}}, ""),
        ({}, {"encoder": "counted"}, "leaves out the steps of the encoder"),
        ({"encoder": "counted"}, {"encoder": "counted"}, ""),
        ({"encoder": "counted"}, {"encoder": "ideal"}, ""),
        ({}, {"encoder": "not counted"}, ""),
        ({}, {"force_limit_counted": True}, "leaves out the force limit"),
        ({"force_steps": True}, {"force_limit_counted": True}, "leaves out the force limit"),
        ({"force_limit": True}, {"force_limit_counted": True}, ""),
        ({}, {"force_limit_counted": False}, ""),
        ({}, {"force_steps_counted": True}, "leaves out the force steps"),
        ({"force_limit": True}, {"force_steps_counted": True}, "leaves out the force steps"),
        ({"force_steps": True}, {"force_steps_counted": True, "force_limit_counted": False}, ""),
        ({"fed_with": "position"}, {}, ""),
        ({"fed_with": "position"}, {"fed_with": "position"}, ""),
        ({"fed_with": "position"}, {"fed_with": "penetration"}, "is of a law that is fed with the position"),
        ({"fed_with": "position"}, {"encoder": "ideal"}, "is of a law that is fed with the position"),
        ({"fed_with": "position"}, {"contact": "kept"}, ""),
        ({}, {"fed_with": "position"}, ""),
    ):  # fmt: skip
        document = {"outcome": "passive", "scope": stated, "certificate": covering(**said)}
        yield f"{said} under {stated}", document, phrase
    for outcome, phrase in (("passive in contact", ""), ("passive without encoder steps",
     "keeps contact only"),
                            ("undecided", "")):  # fmt: skip
        yield outcome, {"outcome": outcome, "certificate": covering(contact="kept")}, phrase
    yield "no evidence against", {"outcome": "active", "violation": covering("active", contact="kept")}, ""
    for which, phrase in (("every", "within bounds only"), ("known", "within bounds only"), ("bounded", "")):
        worst = {"outcome": "passive", "scope": {"hands": {"which": which}}}
        whole = {"format": "zwidth worst hand 1", **worst, "certificate": covering(hands="bounded")}
        yield f"bounded for {which}", whole, phrase
    whole = {"format": "zwidth worst hand 1", "outcome": "passive", "certificate": covering(hands="bounded")}
    yield "bounded, and nothing said", whole, ""
    for hands, phrase in (
        ("known", "is of a hand that is known"), ("beside a known one", "of two arms of which a known hand"),
        ("bounded", "covers hands within bounds only"), ("others", "is of other hands"),
    ):  # fmt: skip
        yield hands, {"outcome": "passive", "certificate": covering(hands=hands)}, phrase
    port = {**covering("index at least"), "index": "input", "level": "1/2"}
    yield "a port", {"outcome": "passive", "certificate": port}, "is of a port"
    yield (
        "a level",
        {"format": "zwidth indices 1", "outcome": "passive", "certificate": port},
        "another level",
    )


def of_a_list() -> Iterator[tuple[str, object, str]]:
    """What is said of all that are listed is said of each, and one that is active is enough for that."""
    of = {name: {"outcome": name, "certificate": covering()} for name in OUTCOMES[:3]}
    of["active"] = {"outcome": "active", "violation": covering("active")}
    of["undecided"] = {"outcome": "undecided"}
    allowed = {"passive": {"passive"}, "passive in contact": {"passive", "passive in contact"},
               "passive without encoder steps": {"passive", "passive without encoder steps"}}  # fmt: skip
    lists = [[], *([name] for name in of), *map(list, product(of, repeat=2))]
    for said, listed in product((*of, "theorem", None), lists):
        document: Document = {"format": "zwidth gains 1", "joints": [of[name] for name in listed]}
        document |= {} if said is None else {"outcome": said}
        if said == "theorem":
            phrase = "the outcome is a theorem, a proof on paper: no evidence shows it"
        elif said == "active":
            phrase = "" if "active" in listed else "the outcome is active, and not that of all that it lists"
        elif said in allowed:
            right = listed and set(listed) <= allowed[said]
            phrase = "" if right else f"the outcome is {said}, and not that of all that it lists"
        else:
            phrase = ""
        if set(listed) <= {"undecided"} and phrase != "unreadable":
            phrase = "unreadable: no evidence found"
        yield f"{said} of {listed}", document, phrase
    empty = {"format": "zwidth gains 1", "outcome": "passive", "joints": [], "certificate": covering()}
    yield "evidence beside an empty list", empty, "not that of all that it lists"


def nothing_is_passed_over() -> Iterator[tuple[str, object, str]]:
    """Entries of another sort, of no format, or without evidence, at every depth."""
    true: Document = {"format": VERDICT, "outcome": "passive", "certificate": covering()}
    stable = {"format": "zwidth stability 1", "outcome": "stable", "certificate": covering("stable", "known")}
    bare = {key: value for key, value in true.items() if key != "format"}
    no_key = "unreadable: no evidence found: the object has no key kind, certificate, violation or witness"
    yield from (
        ("as it is", true, ""),
        ("without a format", bare, ""),
        ("the evidence by itself", covering(), ""),
        ("a kind beside", {**covering(), "outcome": "active", "x": 1}, ""),
        ("one of two false", {**true, "outcome": "active", "certificate": None,
         "violation": covering("active"),
                              "witness": {"kind": "x", "false": True}}, "as it says"),
        ("no object", [1], "unreadable: expected a JSON object"),
        ("nothing", {}, no_key), ("something else", {"a": 1, "scope": {}}, no_key),
        ("no evidence", {"outcome": "passive"}, no_key), ("null", {"certificate": None}, no_key),
        ("a format alone", {"format": VERDICT}, no_key), ("a motion alone", {"witness": covering("active")},
         ""),
        ("a violation alone", {"violation": covering("active")}, ""),
        ("undecided", {"format": "zwidth postures 1", "outcome": "undecided"}, "says 'undecided', and holds"),
        ("another format", {**true, "format": "zwidth verdict 2"},
         "document of format 'zwidth verdict 2' holds"),
        ("a format of no text", {**true, "format": 1}, "unreadable: no evidence found"),
        ("one that stands only in others", {**true, "format": "one mass"}, ""),
        ("a long format", {**true, "format": "f" * 70}, f"format '{'f' * 60}' holds"),
        ("known hands", {**true, "known_hands": {"finger": stable}}, ""),
        ("known hands alone", {"known_hands": {"finger": stable}}, ""),
        ("a worst hand alone", {"worst_hand": true | {"format": "zwidth worst hand 1"}}, ""),
        ("an active hand alone",
         {"active_hand": {"contact_kept": {"certificate": covering(hands="activity")}}}, ""),
        ("known hands as a list", {**true, "known_hands": [stable]}, "known_hands must be an object"),
        ("no hand", {**true, "known_hands": {"finger": 5}}, "known_hands.finger must be an object"),
        ("a long name", {**true, "known_hands": {"f" * 70: 5}}, f"known_hands.{'f' * 60} must be"),
        ("a hand of another format", {**true, "known_hands": {"a": true}}, "unreadable: no evidence found"),
        ("another format before it", {**true, "known_hands": {"a": {**stable, "format": "zwidth a"}}},
         "unreadable: no evidence found: a document of format 'zwidth a'"),
        ("a verdict in a list", {"format": "zwidth passive masses 1", "verdicts": [true]}, ""),
        ("a hand without evidence", {**true, "known_hands": {"a": {"outcome": "stable"}}},
         "the outcome in known_hands.a is stable, and no evidence shows it"),
        ("a theorem", {**true, "known_hands": {}, "worst_hand": {"outcome": "theorem"}},
         "the outcome in worst_hand is a theorem"),
        ("evidence of a hand that is none", {**true, "known_hands": {"a": {**stable, "witness": 5}}},
         "known_hands.a.witness must be an object"),
        ("an outcome of a hand", {**true, "known_hands": {"a": {**stable, "outcome": "passive"}}},
         "known_hands.a.outcome must be stable"),
        ("a scope of a hand", {**true, "known_hands": {"a": {**stable, "scope": 5}}},
         "hands.a.scope must be an"),
        ("in a scope of a hand", {**true, "known_hands": {"a": {**stable, "scope": {"x": 5}}}},
         "hands.a.scope.x"),
        ("below a hand", {**true, "active_hand": {"contact_kept": 5}}, "active_hand.contact_kept must be"),
        ("joints that are no list", {"format": "zwidth gains 1", "outcome": "passive", "joints": {"a": true}},
         "joints must be a list"),
        ("a joint that is none", {"format": "zwidth gains 1", "outcome": "passive", "joints": [bare, 5]},
         "joints[1] must be an object"),
        ("evidence that is none", {**true, "witness": 5}, "witness must be an object"),
        ("an outcome that is none", {**true, "outcome": "Passive"},
         "outcome must be passive, passive in contact"),
        ("an outcome in a list", {**true, "outcome": ["passive"]}, "outcome must be"),
        ("a long outcome", {**true, "outcome": "p" * 50}, f"or undecided, got {'p' * 40!r}"),
        ("an outcome where none is", {"format": "zwidth limit 1", **bare},
         "no document of this format has: outcome"),
        ("another entry", {**true, "note": 1}, "entries that no document of this format has: note"),
        ("a long one", {**true, "n" * 70: 1}, f"has: {'n' * 60}"),
        ("one within", {**true, "known_hands": {"a": {**stable, "note": 1}}}, "has: known_hands.a.note"),
        ("one in a list", {"format": "zwidth gains 1", "joints": [{**bare, "note": 1}]},
         "has: joints[0].note"),
        ("a scope that is none", {**true, "scope": ["every"]}, "scope must be an object"),
        ("hands that are none", {**true, "scope": {"hands": "every"}}, "scope.hands must be an object"),
        ("hands of a word", {**true, "scope": {"hands": {"which": "all"}}},
         "scope.hands.which must be every, bou"),
        ("no such contact", {**true, "scope": {"contact": "Kept"}},
         "scope.contact must be made and broken or kept or both sides, got 'Kept'"),
        ("a long one", {**true, "scope": {"contact": "k" * 50}}, f"got {'k' * 40!r}"),
        ("no truth", {**true, "scope": {"force_limit_counted": 1}},
         "force_limit_counted must be true or false"),
        ("no truth as text", {**true, "scope": {"force_steps_counted": "true"}}, "must be true or false"),
        ("an entry of a scope", {**true, "scope": {"motors": 1}}, "this format has: scope.motors"),
        ("deep", {**true, "claim": json.loads("[" * 18 + "{}" + "]" * 18)}, ""),
        ("too deep", {**true, "claim": json.loads("[" * 19 + "{}" + "]" * 19)},
         "more than 20 objects and lists"),
        ("too deep in objects", {**true, "claim": json.loads('{"a":' * 20 + "1" + "}" * 20)}, "more than 20"),
    )  # fmt: skip


def what_nothing_proves_is_told() -> str:
    """Where it stands; what was checked is not among it, and the same evidence is checked once."""
    true = {"outcome": "passive", "certificate": covering()}
    stable = {"outcome": "stable", "certificate": covering("stable", "known"), "frequency_Hz": 1}
    found = judged({
        **true, "limit": 1, "max_stiffness_N_per_m": 2, "claim": "c", "assumptions": [],
        "scope": {"contact": "kept", "law": "a", "damping_N_s_per_m": 1, "hands": {"which": "every"}},
        "known_hands": {"finger": stable}, "worst_hand": true, "active_hand": {"below": 3},
    })  # fmt: skip
    if found.faults or not found.valid:
        return f"{found.faults}"
    told = ["limit", "max_stiffness_N_per_m", "claim", "assumptions", "scope.law", "scope.damping_N_s_per_m",
            "known_hands.finger.frequency_Hz", "active_hand.below"]  # fmt: skip
    if list(found.told) != told:
        return f"told {found.told}"
    if [one.at for one in found.parts] != [
        "certificate",
        "known_hands.finger.certificate",
        "worst_hand.certificate",
    ]:
        return f"{[one.at for one in found.parts]}"
    if part("verdict").not_checked(found) != "limit, max_stiffness_N_per_m, claim, assumptions, law, " + (
        "damping_N_s_per_m, frequency_Hz, below"
    ):
        return part("verdict").not_checked(found)
    if found.parts[0].verification is not found.parts[2].verification or judged(covering()).parts[0].at:
        return "the same evidence is not checked once"
    return "" if judged({**true, "known_hands": {}}).told == () else "told"


def a_wrong_word_is_that_of_its_statement() -> str:
    """With the outcome, where one stands there."""
    said = fault({"outcome": "active", "certificate": covering()})
    if said != "the verdict says active, and its evidence is a proof of passivity":
        return said
    said = fault({"format": "zwidth limit 1", "violation": covering()})
    return "" if said == "this violation is no such thing: the evidence is a proof of passivity" else said


def words_are_of_what_is_covered() -> str:
    """The answer to a whole document, and the headline of each proof."""
    words, verdict, one, scope = part("verdict"), part("verdict"), part("one"), part("scope").Scope
    loop, arms = "out of the loop below, proved", "out of the arms below, proved"
    for kind, covered, said in (
        ("x", scope("stable"), "Proved"), ("x", scope("unstable", "known"), "Proved"),
        ("x", scope("index at least"), "Of the port below, proved"),
        ("x", scope("index below"), "Of the port below, proved"),
        ("x", scope("active", "beside a known one"), f"A hand can take any amount of energy {arms}"),
        ("x", scope("passive", "beside a known one"),
         f"A hand on the arm that is not held takes no energy {arms}"),
        ("pair", scope("passive"), "The two arms below are passive, proved"),
        ("pair violation", scope("active"), f"Two hands can take any amount of energy {arms}"),
        ("x", scope("active"), f"A hand can take any amount of energy {loop}"),
        ("x", scope("active", "bounded"), f"A hand can take any amount of energy {loop}"),
        ("x", scope("passive", "bounded"), f"No hand within these bounds takes energy {loop}"),
        ("x", scope("passive", "activity"),
         "No hand of this activity goes on gaining energy from the loop below, "
         "proved"),
        ("x", scope("passive", "activity", "kept"),
         "No hand of this activity goes on gaining energy from the loop "
         "below as long as contact is kept, proved"),
        ("x", scope("passive"), "The loop below is passive, proved"),
        ("x", scope("passive", contact="kept"),
         "The loop below is passive as long as contact is kept, proved"),
        ("arm", scope("passive"), "The arm below is passive, proved"),
        ("null space", scope("passive"), "The arm below is passive, proved"),
        ("corners", scope("passive", contact="kept"),
         "Every corner, as the one below, is passive as long as contact "
         "is kept, proved"),
        ("corners", None, "Proved"),
    ):  # fmt: skip
        found = verdict.Part("", {"kind": kind}, one.Verified(True, "why", scope=covered))
        if words.headline(found) != ("VALID", f"{said}: why"):
            return f"{kind}, {covered}: {words.headline(found)}"
    for found, headline in (
        (one.Verified(False, "why", scope=scope("passive")), ("NOT VALID", "why")),
        (one.Verified(True, "why\n", 1, scope=scope("active")), ("VALID", "why?")),
        (one.Verified(False, "y" * 400), ("NOT VALID", "y" * 400)),
        (one.Verified(False, "y" * 401), ("NOT VALID", f"{'y' * 397}...")),
    ):
        if words.headline(verdict.Part("", {}, found)) != headline:
            return f"{words.headline(verdict.Part('', {}, found))}"
    right, wrong = (verdict.Part("here", {}, one.Verified(valid, "")) for valid in (True, False))
    for parts, faults, said in (
        ([right], (), None), ([wrong], (), None), ([right], ("a", "b"), ("NOT VALID", "a; b")),
        ([right, right], (), ("VALID", "all 2 proofs and motions below, each of what is stated of it")),
        ([right, wrong], (), ("NOT VALID", "1 of the 2 proofs and motions below: here")),
        ([wrong] * 13, (), ("NOT VALID",
         f"13 of the 13 proofs and motions below: {', '.join(['here'] * 12)}")),
    ):  # fmt: skip
        if words.answer(verdict.Judged(tuple(parts), faults)) != said:
            return f"{parts}, {faults}"
    long = words.not_checked(verdict.Judged((), (), (f"a.{'b' * 400}", "b.c", "c", "c")))
    return "" if long == f"{'b' * 297}..." else long


def rows_are_of_what_was_checked() -> str:
    """The numbers that entered a proof that holds."""
    words, verdict, one, scope = part("verdict"), part("verdict"), part("one"), part("scope").Scope
    row = part("document.fields").Row
    entries = (
        row("b", "4", "N·s/m", False),
        row("n" * 61, "5" * 300, "", False),
        row("law", "a" * 301, "", True),
    )
    kind = row("kind", "k" * 57 + "...", "", False)
    energy = row("energy extracted", "2", "J", False)
    below = [row("b", "4 N·s/m", "N·s/m", False), row(f"{'n' * 57}...", "5" * 300, "", False),
             row("told, not checked", f"{'a' * 297}...", "", True)]  # fmt: skip
    long = row("of the document", f"a.{'b' * 95}...", "", False)
    for at, evidence, found, right in (
        ("violation", {"kind": "k" * 61}, one.Verified(True, "", 2, 1, scope("active"), entries), [energy,
         kind, *below]),
        (f"a.{'b' * 99}", {"kind": "k" * 61}, one.Verified(True, "", None, None, None, entries), [long,
         kind, *below]),
        ("", {"kind": "p"}, one.Verified(True, "", 2, None, scope("index below")), [kind._replace(text="p")]),
        ("", {}, one.Verified(False, "", 2, None, None, entries), [energy]),
        ("", {"kind": "corners", "corners": [1, 2]}, one.Verified(True, ""),
         [kind._replace(text="corners"), row("corner below", "1 of 2, each with a proof of its own", "",
          False)]),
    ):  # fmt: skip
        said = list(words.rows(verdict.Part(at, evidence, found)))
        if said != right:
            return f"{said}"
    return ""


def what_a_check_finds_is_told() -> str:
    """Energy, what a round more gives, and what joints have to spare, each in its place."""
    kinds, told = part("kinds"), ("all of it", Fraction(2), Fraction(3), ((4.0,),))
    found = kinds.Found(told[0], True, *told[1:])
    kind = kinds.KINDS["spring"]._replace(check=lambda _: found)
    with put_in_place("one", KINDS={"spring": kind}):
        said = part("one").verify(spring(4))
    return "" if (said.reason, said.energy, said.gain, said.surplus) == told and said.valid else f"{said}"


def run(main: Callable[..., Any], *arguments: str) -> tuple[Any, str, str]:
    """What a command returns, or leaves with, and what it says."""
    out, err, before = StringIO(), StringIO(), sys.argv
    sys.argv = ["zwidth-checker", *arguments]
    try:
        with redirect_stdout(out), redirect_stderr(err):
            status = main(list(arguments)) if main.__name__ == "main" else main()
    except SystemExit as left:
        status = left.code
    finally:
        sys.argv = before
    return status, out.getvalue(), err.getvalue()


def the_command_says_what_was_found() -> str:
    """Its status, and its words."""
    command = import_module("zwidth.checker.__main__")
    row = f"  {'energy extracted':20} 2 J\n  {'kind':20} k\n  {'b':20} 4 N·s/m\n"
    one, scope, fields = part("one"), part("scope").Scope, part("document.fields")

    def verify(evidence: Mapping[str, Any]) -> Any:
        rows = (fields.Row("b", "4", "N·s/m", False),)
        return one.Verified("false" not in evidence, "why", 2, scope=scope("active"), rows=rows)

    with TemporaryDirectory() as folder, put_in_place("verdict", verify=verify):
        for document, status, said in (
            ({"violation": {"kind": "k"}}, 0, f"VALID  why\n{row}"),
            ({"violation": {"kind": "k", "false": 1}}, 1, f"NOT VALID  why\n  {'energy extracted':20} 2 J\n"),
            ({"violation": {"kind": "k"}, "limit": 1, "witness": {"kind": "k"}}, 0,
             "VALID  all 2 proofs and motions below, each of what is stated of it\n"
             f"VALID  why\n{row}VALID  why\n{row}told, not checked: limit\n"),
        ):  # fmt: skip
            file = Path(folder, "document.json")
            file.write_text(json.dumps(document), encoding="utf-8")
            for main in (command.main, command.command):
                found = run(main, str(file))
                if found != (status, said, ""):
                    return f"{found}"
        for arguments, phrase in (
            ((), "python -m zwidth.checker FILE"), (("a", "b"), "FILE"), (("--help",), "FILE"), (("-",),
             "FILE"),
            ((str(Path(folder, "none.json")),), "none.json: No such file"),
        ):  # fmt: skip
            status, out, err = run(command.main, *arguments)
            if status != 2 or out or phrase not in err:
                return f"{arguments}: {status}, {out}, {err}"
    status, _, err = run(command.command, "a", "b")
    return "" if status == 2 and "FILE" in err else "two files"


def files_are_read_with_every_digit() -> str:
    """As they are written, once each, and not beyond their bounds."""
    file = part("document.file")

    def read(content: bytes | str, **bounds: int) -> object:
        path = Path(folder, "document.json")
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        try:
            with put_in_place("document.file", **bounds):
                return file.read_file(path)
        except file.Unreadable as error:
            return f"unreadable: {error}"

    with TemporaryDirectory() as folder:
        nines = "9" * 4001
        for content, right in (
            ('{"a": [0.10, 1e-2, 3, "x", null, true]}',
             {"a": [Decimal("0.10"), Decimal("0.01"), 3, "x", None, True]}),
            (nines[1:], int(nines[1:])), (nines, Decimal(nines)), ('{"a": 1, "b": 1}', {"a": 1, "b": 1}),
        ):  # fmt: skip
            found = read(content)
            if found != right or repr(found) != repr(right):
                return f"{content[:40]}"
        for content, phrase in (
            ('{"b": 1, "a": 1, "b": 2}', "'b' is given twice in one object"),
            ("{" + ", ".join([f'"{"k" * 70}": 1'] * 2) + "}", f"'{'k' * 60}' is given twice"),
            ("{'a': 1}", "not JSON: "), (b'{"a": "\xff"}', "not UTF-8 text (b"), ("[" * 2000, "not JSON"),
            ("1e99999999999999999999", "expected a number of ordinary size, got 1e99999999999999999999"),
            ("1e" + "9" * 60, f"got 1e{'9' * 38}"),
        ):  # fmt: skip
            if phrase not in str(read(content)) or f"{phrase}9" in str(read(content)):
                return f"{content[:40]!r}: {read(content)}"
        for content in ("[1,2,3]", "[{},[]]", "[[],{}]"):
            if "unreadable" in str(read(content, MOST_VALUES=4)) or "unreadable" in str(
                read(content, LARGEST_FILE=7)
            ):
                return f"{content} is too large"
            most = content.count(",") + content.count("[") + content.count("{")
            if read(content, MOST_VALUES=most) == read(content, MOST_VALUES=most - 1):
                return "more than so many values"
            if "larger than 6 bytes" not in str(read(content, LARGEST_FILE=6)):
                return "more than so many bytes"
        if "unreadable: Is a directory" not in f"unreadable: {_unreadable(file, folder)}":
            return "a folder"
        if "embedded null" not in _unreadable(file, "a\0b"):
            return "no path"
    return ""


def _unreadable(file: Any, path: str) -> str:
    try:
        return str(file.read_file(path))
    except file.Unreadable as error:
        return str(error)


def reading_counts_as_effort() -> str:
    """A file of many values is refused with what it costs, whole as in its evidence."""
    effort, verdict, one = part("document.refusal"), part("verdict"), part("one")
    counts: list[float] = []

    def verify(_: object) -> Any:
        counts.append(effort.spent())
        return one.Verified(False, "")

    with TemporaryDirectory() as folder:
        file = Path(folder, "document.json")
        file.write_text(json.dumps({"kind": "spring", "x": [1] * 1000}), encoding="utf-8")
        with put_in_place("verdict", verify=verify):
            verdict.judge_file(file)
            verdict.judge({"certificate": covering(), "violation": covering("active")})
    if not 1000 <= counts[0] < 1500 or not counts[1] == counts[2] < 500:
        return f"{counts}"
    with put_in_place("document.refusal", MOST=90):
        hands = {str(k): {} for k in range(5)}
        return (
            "" if verdict.judge({"certificate": {}, "known_hands": hands}).faults else "too many statements"
        )


def _table(rows: Callable[[], Iterator[tuple[str, object, str]]]) -> Case:
    return Case(
        rows.__name__.replace("_", " "), lambda: first_wrong((n, plain(d), p) for n, d, p in rows()), ""
    )


CHECKS = (
    evidence_shows_what_is_stated,
    what_nothing_proves_is_told,
    a_wrong_word_is_that_of_its_statement,
    words_are_of_what_is_covered,
    rows_are_of_what_was_checked,
    what_a_check_finds_is_told,
    the_command_says_what_was_found,
    files_are_read_with_every_digit,
    reading_counts_as_effort,
)

CASES = [
    *(Case(check.__name__.replace("_", " "), check, "") for check in CHECKS),
    *map(_table, (without_an_outcome, of_fewer_hands, of_a_list, nothing_is_passed_over)),
]
