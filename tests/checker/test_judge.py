"""Whole documents: nothing is stated without evidence, nothing passed over, and effort is one count."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import zipapp
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from cases import cases_of, files

from zwidth import checker
from zwidth.checker import Scope, Unreadable, Verified, judge, verify
from zwidth.checker.document import refusal as effort
from zwidth.checker.kinds import KINDS
from zwidth.checker.whole import PASSIVITY, REST, SHAPES

Document = dict[str, Any]
VERDICT = "zwidth verdict 1"


@cache
def accepted() -> dict[tuple[str, Scope], Document]:
    """True documents of every kind, a few of each."""
    found: dict[tuple[str, Scope], Document] = {}
    tried: Counter[str] = Counter()
    for case in (case for file in files() for case in cases_of(file)):
        kind = case.document.get("kind") if isinstance(case.document, dict) and not case.refusal else None
        if kind in KINDS and tried[str(kind)] < 6:
            document = json.loads(json.dumps(case.document, default=str))
            scope = None if len(json.dumps(document)) > 3000 else verify(document).scope
            if scope is not None:
                tried[str(kind)] += 1
                found.setdefault((str(kind), scope), document)
    return found


def shows(outcome: str, scope: Scope, contact: str) -> bool:
    """Whether evidence that covers this shows an outcome of every hand, with that contact."""
    every, kept = scope.hands in ("every", "activity"), scope.contact == "kept"
    return {
        "passive": scope.shows == "passive" and every and (not kept or contact == "kept"),
        "passive without encoder steps": scope.shows == "passive"
        and every
        and (not kept or contact == "kept"),
        "passive in contact": scope.shows == "passive" and every,
        "active": scope.shows == "active" and every,
    }.get(outcome, False)


def test_every_kind_is_there() -> None:
    """The property below is of all kinds."""
    assert {kind for kind, _ in accepted()} == set(KINDS)


@pytest.mark.parametrize(
    "outcome", [*PASSIVITY, *REST, "Passive", "passive!", "", "theorem ", None, 1, ["passive"]]
)
def test_only_what_the_evidence_covers_may_be_stated(
    outcome: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For every kind and every outcome: no other word passes, over no other evidence."""
    for (kind, scope), evidence in accepted().items():
        monkeypatch.setattr(
            "zwidth.checker.verdict.verify", lambda _, scope=scope: Verified(True, "", scope=scope)
        )
        for contact in ("made and broken", "kept"):
            stated = {"contact": contact, "fed_with": scope.fed_with, "transmission": scope.transmission}
            document = {"format": VERDICT, "outcome": outcome, "scope": stated}
            name = "certificate" if scope.shows in ("passive", "stable") else "witness"
            valid = judge({**document, name: evidence}).valid
            if outcome == "undecided":  # of an interval, something at its worst corner
                assert valid == (
                    scope.hands in ("every", "activity") and scope.shows in ("passive", "active")
                )
            else:
                assert valid == shows(str(outcome), scope, contact), (kind, outcome, contact)


def test_a_band_that_keeps_contact_is_no_proof_of_a_hand_that_leaves() -> None:
    """The certificate of an active hand with a band covers contact kept, and no other."""
    kept = next(d for (k, s), d in accepted().items() if k == "active hand" and s.contact == "kept")
    stated: Document = {"outcome": "passive", "certificate": kept}
    for scope in ({}, {"scope": {"contact": "made and broken"}}):
        assert not judge({**stated, **scope}).valid
    activity = {"format": "zwidth activity 1", "contact_kept": {"certificate": kept}}
    assert judge(activity).valid
    assert not judge({"format": "zwidth activity 1", "contact_broken": {"certificate": kept}}).valid


def test_an_arm_out_of_reach_stops_no_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """Refused where its cells are looked at; and were they not, the answer is that the checker stopped."""
    (case,) = (case for case in cases_of("arm") if case.name == "arm: out of reach")
    assert "does not reach" in verify(case.document).reason
    monkeypatch.setattr("zwidth.checker.arm.region.positive_in", lambda *_: 1)
    found = judge(case.document).parts[0].verification
    assert (found.valid, found.reason) == (False, f"{checker.STOPPED}: NotPositive: ")


def spring() -> Document:
    """A true certificate."""
    return next(document for (kind, _), document in accepted().items() if kind == "spring")


def test_unknown_entries_are_refused_in_every_format() -> None:
    """At every depth, in every sort of document."""
    for name, shape in SHAPES.items():
        if not name.startswith("zwidth"):
            continue
        document: Document = {"format": name, "certificate": spring()}
        inner: list[Document] = [document]
        for key, (how, _) in shape.inside.items():
            inner.append({"certificate": spring()})
            document[key] = {"one": inner[-1], "named": {"finger": inner[-1]}, "listed": [inner[-1]]}[how]
        assert not any("entries that no document" in fault for fault in judge(document).faults), name
        for place in inner:
            place["note"] = 1
            (fault,) = judge(document).faults
            assert fault.startswith("entries that no document of this format has: ")
            del place["note"]


def test_effort_is_one_count(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same evidence again costs nothing, other evidence adds up, and too much is refused unchecked."""

    def devices(number: int, other: int) -> Document:
        loop = spring()["loop"]
        made = [
            {**spring(), "loop": {**loop, "sample_period_s": f"1/{1000 + k * other}"}} for k in range(number)
        ]
        return {"format": "zwidth each 1", "devices": [{"device": "a", "certificate": one} for one in made]}

    def count(document: Document) -> float:
        with effort.one_document():
            judge(document)
            return effort.spent()

    once = count(devices(1, 0))
    assert count(devices(30, 0)) < 3 * once
    assert count(devices(30, 1)) > 25 * once
    monkeypatch.setattr(effort, "MOST", 10 * once)
    found = judge(devices(30, 1))
    assert not found.valid
    assert "more effort than" in found.parts[-1].verification.reason
    assert "too large" not in found.parts[0].verification.reason


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("[" * 100_000, "not JSON"),
        ('{"a":' * 900 + "1" + "}" * 900, "within one another"),
        ('{"kind": 1e99999999999999999999}', "ordinary size"),
        ('{"kind": ' + "9" * 5000 + "}", "kind must be"),
        ("[" + "1," * 500_001 + "1]", "more than 500000 numbers"),
        (" " * 10_000_001, "larger than 10000000 bytes"),
        ("[1]", "expected a JSON object"),
        ('{"kind": "spring", "kind": "spring"}', "given twice"),
    ],
    ids=["lists", "objects", "exponent", "digits", "values", "bytes", "a list", "twice"],
)
def test_what_is_large_is_refused_before_it_is_read(text: str, phrase: str, tmp_path: Path) -> None:
    """Bytes, values, depth and digits have bounds, and what is beyond them is told in a sentence."""
    file = tmp_path / "large.json"
    file.write_text(text, encoding="utf-8")
    try:
        found = checker.judge_file(file)
        said = " ".join([*found.faults, *(part.verification.reason for part in found.parts)])
        assert not found.valid
    except Unreadable as error:
        said = str(error)
    assert phrase in said


def python(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What a Python without the packages around it makes of a command."""
    command = [sys.executable, *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, encoding="utf-8", check=False, env=environment or None
    )


def test_the_checker_runs_alone(tmp_path: Path) -> None:
    """As one file, by a Python without any package, it says the same; it needs its own folder only."""
    house = Path(checker.__file__).parent
    shutil.copytree(
        house, tmp_path / "alone" / "checker", ignore=shutil.ignore_patterns("__pycache__", "schemas")
    )
    archive = tmp_path / "zwidth-checker.pyz"
    zipapp.create_archive(tmp_path / "alone", archive, main="checker.__main__:command")
    false = {**spring(), "loop": {**spring()["loop"], "damping_N_s_per_m": "0"}}
    for name, document, status, word in (
        ("true", {"outcome": "passive", "certificate": spring()}, 0, "VALID"),
        ("false", {"outcome": "passive", "certificate": false}, 1, "NOT VALID"),
        ("more", {"outcome": "stable", "certificate": spring()}, 1, "NOT VALID"),
        ("nothing", {}, 2, ""),
    ):
        file = tmp_path / f"{name}.json"
        file.write_text(json.dumps(document), encoding="utf-8")
        done = python("-I", "-S", str(archive), str(file))
        assert (done.returncode, done.stdout[: len(word)]) == (status, word), done
    program = (
        "import sys; from zwidth.checker.__main__ import main; main([sys.argv[1]])\n"
        "files = {name: str(getattr(one, '__file__', '')) for name, one in sys.modules.items()}\n"
        "print(*sorted(m for m in files if 'site-packages' in files[m] or m.split('.')[0] == 'zwidth'))"
    )
    done = python("-S", "-c", program, str(tmp_path / "true.json"), PYTHONPATH=str(house.parents[1]))
    used = [name for name in done.stdout.splitlines()[-1].split() if not name.startswith("zwidth.checker")]
    assert used == ["zwidth", "zwidth.lazy"]
