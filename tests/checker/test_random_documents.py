"""The fuzzer of proof documents: nothing false is accepted, judges can say no, a seed is a document."""

from __future__ import annotations

import copy
import json
from fractions import Fraction
from math import cos
from pathlib import Path
from random import Random

import numpy as np
import pytest

from zwidth.checker.kinds import KINDS

ALL = (*KINDS, "corners")
SLOW = ("absolute", "known hands")
"""Makers of valid documents that take seconds; the tests write some themselves."""

HAND = {
    "mass_kg": "0.05", "damping_N_s_per_m": "0.7", "stiffness_N_per_m": "350", "sample_period_s": "0.001",
    "delay_s": "0.0004", "numerator": ["1200", "-400"], "denominator": ["1", "0"],
}  # fmt: skip
WRITTEN = {
    "stability": [
        {"kind": "stability", "loop": HAND},
        {"kind": "stability", "loop": {**HAND, "mass_kg": ["0.05", "0.06"]}},
    ],
    "instability": [{"kind": "instability", "loop": {**HAND, "numerator": ["99000", "-400"]}}],
    "absolute stability": [
        {
            "kind": "absolute stability",
            "plant": {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]},
            "nonlinearity": "monotone", "slope": "0.6", "center": "1", "taps": [], "convexity": "0",
            "smoothness": "0",
        }
    ],
    "vibration": [
        {
            "kind": "vibration",
            "plant": {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]},
            "slope": "0.92", "gap": "-1", "inside": [True, False, False],
        }
    ],
}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _benchmarks():
    """Benchmarks are scripts beside one another."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(Path(__file__).parents[2] / "benchmarks"))
        yield


@pytest.fixture(scope="module")
def seeds():
    """Valid documents of every kind."""
    from documents import seeds

    made = seeds.made(name for name in seeds.MAKERS if name not in SLOW)
    for kind, documents in WRITTEN.items():
        made[kind] = [*made.get(kind, []), *copy.deepcopy(documents)]
    return seeds.with_cases(made)


@pytest.fixture(scope="module")
def ready(seeds):
    """The same, to be drawn from."""
    from documents import grammar

    return grammar.ready(seeds)


@pytest.mark.parametrize("kind", ALL)
def test_nothing_false_is_accepted(ready, kind):
    """Nor anything ill-formed, and nothing makes the checker fail."""
    from documents.examine import FINDINGS, examine

    for seed in range(12):
        found = examine(seed, ready, kind)
        assert found.word not in FINDINGS, f"seed {seed}: {found.word}, {found.why}; {found.written.how}"


@pytest.mark.parametrize("kind", ALL)
def test_every_judge_can_say_no(ready, kind):
    """Where the checker is not asked, falsehoods are found among what the grammar writes."""
    from documents.judges import JUDGES
    from documents.opinion import FALSE
    from documents.self_test import blind

    if kind not in (*JUDGES, "corners"):
        pytest.skip("no judge of this kind")
    assert any(blind(kind, ready, number)[FALSE] for number in (10, 30, 90))


def test_nothing_is_found_against_valid_documents(seeds):
    """Each is accepted by the checker, and no judge fails or says that it is false."""
    from documents.checked import ask
    from documents.examine import judged
    from documents.judges import JUDGES
    from documents.opinion import AGREES, OPEN

    assert {*seeds, "corners"} == set(ALL)
    for kind, documents in seeds.items():
        for document in documents:
            assert ask(document).valid, kind
            assert judged(document, 0).word in (AGREES, OPEN), kind
        if kind in (*JUDGES, "corners"):
            assert judged(documents[0], 0).word == AGREES, kind


def test_a_false_document_is_made_smaller(seeds, monkeypatch):
    """If everything is accepted, what is left over after that is false as well, and shorter."""
    from documents import examine
    from documents.checked import Answer

    monkeypatch.setattr(examine, "ask", lambda document: Answer(True, "whatever it is"))
    document = copy.deepcopy(seeds["quantized"][0])
    document["loop"]["damping_N_s_per_m"] = "0.001234567"
    opinion = examine.judged(document, 3)
    assert opinion.word == examine.FALSE
    assert "the criterion asks for" in opinion.why
    found = examine.Examined(examine.Written("quantized", document, "by hand", False), *opinion, 0.0, 0.0)
    smaller = examine.shrunken(found, 3)
    assert len(json.dumps(smaller)) < len(json.dumps(document))
    assert examine.judged(smaller, 3).word == examine.FALSE


def test_a_seed_is_a_document(ready):
    """Written twice it is the same."""
    from documents.grammar import write

    for seed in range(100):
        assert repr(write(seed, ready)) == repr(write(seed, ready))


@pytest.mark.parametrize("seed", range(5))
def test_the_criterion_of_a_document_from_nothing_is_the_one_of_its_loop(seeds, seed):
    """q is 0 at the damping that is needed, by the referee's formula in balls, at any frequency."""
    from attack.referee import needed_at
    from documents import fresh
    from documents.plain import plain_loop

    rng = Random(seed)
    above, below, _, _ = fresh.law(rng)
    loop = fresh.loop_of(rng, above, below)
    for theta in (0.1, 1.0, 2.5, 3.1):
        asked = Fraction(float(needed_at(plain_loop(loop), theta).mid()))
        if asked > 0:
            loop["damping_N_s_per_m"] = str(asked)
            q = [float(c) for c in fresh.criterion(loop)]
            size = sum(abs(float(c)) for c in fresh.criterion(loop, 2 * asked))
            assert np.polyval(q[::-1], cos(theta)) == pytest.approx(0, abs=1e-12 * size)


def test_a_ledger_says_what_is_left_to_run(tmp_path):
    """Stretches that touch become one; seeds between them are run, in pieces."""
    from documents import ledger
    from documents.examine import Examined
    from documents.grammar import Written

    done = []
    for first, last in ((0, 4), (5, 9), (20, 29)):
        stretch = ledger.Stretch(first, last)
        for word, spent in (("refused", 0.5), ("agrees", 0.25)):
            stretch.add(first, Examined(Written("spring", {}, "", False), word, "", spent, 100.0))
        done = ledger.joined([*done, stretch])
    path = tmp_path / "ledger.csv"
    ledger.write(path, done)
    read = ledger.read(path)
    assert [(s.first, s.last) for s in read] == [(0, 9), (20, 29)]
    assert ledger.seeds_run(read) == "Seeds 0 to 9, 20 to 29:"
    assert ledger.still_to_run(read, 0, 35, 6) == [(10, 15), (16, 19), (30, 34)]
    assert ledger.still_to_run(read, 3, 5, 6) == []
    assert "| spring | 6 | 3 | 3 | 0 | 0 | 0 | 0 | 0.50 | 20 | 100 |" in ledger.table(read)


def _corners(numerators, **changes):
    """Springs around one device, the last of them around one with some numbers changed."""
    loop = {
        "damping_N_s_per_m": "1", "coulomb_friction_N": "0", "resolution_m": "0", "sample_period_s": "0.001",
        "delay_s": "0", "denominator": ["1"], "unilateral": True,
    }  # fmt: skip
    corners = [{"kind": "spring", "loop": {**loop, "numerator": [k]}} for k in numerators]
    corners[-1]["loop"] |= changes
    return {"kind": "corners", "corners": corners}


@pytest.mark.parametrize(
    ("document", "wrong"),
    [
        (_corners(["100", "200"]), ""),
        (_corners(["100", "200"], damping_N_s_per_m="2"), "mixes of laws of several devices"),
        (_corners(["100", "200"], denominator=["2"]), ""),
        (_corners(["100", "200"], unilateral=False), "mixes of laws of several devices"),
        (_corners(["100", "200000"]), "a mix, "),
    ],
)
def test_a_claim_about_mixes_is_judged(document, wrong):
    """Of one device and denominator alone, and no mix of the laws may be active."""
    from documents.judges import mixes

    corners, rng = document["corners"], np.random.default_rng(0)
    assert mixes.between(corners, rng, "").word == "agrees"
    found = mixes.between(corners, rng, f"all corners; and {mixes.CLAIM}")
    assert (found.word, found.why.startswith(wrong)) == ("false" if wrong else "agrees", True)


def test_what_the_checker_does_not_foresee_is_an_error(ready, monkeypatch):
    """A refusal that says so is a fault of the checker, and no refusal."""
    from documents import checked
    from documents.examine import ERROR, examine

    from zwidth.checker import STOPPED, Verified

    monkeypatch.setattr(checked, "verify", lambda document: Verified(False, f"{STOPPED}: KeyError"))
    found = examine(0, ready, "spring")
    assert (found.word, STOPPED in found.why) == (ERROR, True)


def test_a_check_that_does_not_end_is_stopped(ready, monkeypatch):
    """After some ticks of the processor's clock, and that is an error of the checker."""
    import signal

    from documents import checked, examine

    def without_end(document):
        while True:
            pass

    monkeypatch.setattr(examine, "TICK", 0.01)
    monkeypatch.setattr(examine, "PATIENCE", 0.02)
    monkeypatch.setattr(checked, "verify", without_end)
    before = signal.getsignal(signal.SIGPROF)
    try:
        examine.watch.begin()
        found = examine.examine(0, ready, "spring")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    assert (found.word, found.why) == (examine.ERROR, "not checked in 0.02 s")


def test_valid_documents_are_drawn_from_text(ready):
    """Small ones more often, and what is drawn may be changed."""
    valid = ready["spring"]
    assert sorted(valid.shares, reverse=True) == [
        share for _, share in sorted(zip(map(len, valid.texts), valid.shares, strict=True))
    ]
    first, again = (valid.one(Random(0)) for _ in range(2))
    first["loop"].clear()
    assert again == valid.one(Random(0))


PORT = {"time": "discrete", "numerator": ["0.3", "-0.1", "-0.2"], "denominator": ["1", "0", "0"]}
BURST = {"kind": "burst", "step_rad_per_s": "1", "cycles": 10**9, "power": 2}
LATE = _corners(["100"], sample_period_s="1.00000000000000002e-3", delay_s="0.001")["corners"][0]


@pytest.mark.parametrize(
    ("document", "word"),
    [
        ({"kind": "positive real", "system": PORT, "index": "input", "level": "-1e-18"}, "cannot say"),
        ({"kind": "positive real", "system": PORT, "index": "input", "level": "1e-3"}, "false"),
        ({"kind": "extraction", "system": PORT, "index": "input", "level": 9, "motion": BURST}, "cannot say"),
        (LATE, "agrees"),
        ({**LATE, "loop": {**LATE["loop"], "numerator": [10**6000]}}, "cannot say"),
    ],
    ids=("level of rounding", "level above it", "long burst", "almost a sample late", "more than a double"),
)
def test_a_judge_knows_what_doubles_cannot_hold(document, word):
    """It then says so, or goes another way, and does not fail."""
    from documents.examine import judged

    assert judged(document, 0).word == word
