"""Laws in a chain in a document: `zwidth verify` builds them from their parameters and steps them again."""

import base64
import copy
import zlib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from tampered import tampered

import zwidth as zw
from zwidth.model import rendering
from zwidth.passivity.storage import chain_document as documents
from zwidth.passivity.storage import law_of
from zwidth.quantity.text import to_json

DEVICE = zw.Device(damping="0.26", coulomb_friction="0.027", resolution="0.0001", sample_period="0.001")
BOUNDS = {"penetration": "0.0008", "speed": "0.4"}


class Own(zw.Wall):
    """A wall that no specification has a word for."""


@cache
def found(kind, wall=zw.Wall):
    """A proof or a motion against hysteresis."""
    laws = rendering.Hysteresis("0.005", 150) if kind == "row storage" else rendering.Hysteresis("0.05", 900)
    game = zw.available_storage(DEVICE, zw.render(wall(200), laws, rendering.Saturation("5")), **BOUNDS)
    shown = game.certificate if kind == "row storage" else game.witness
    document = shown.to_dict()
    assert document["kind"] == kind
    return document


KINDS = ("row storage", "row motion")


@pytest.fixture
def verify(run):
    """What `zwidth verify` prints of a document, and that it ends with this status."""

    def runner(document, status=0):
        Path("document.json").write_text(to_json(document), encoding="utf-8")
        result = run("verify document.json", status)
        assert not result.err
        return result.words

    return runner


def respecified(document, old, new):
    """The same document with other parameters."""
    text = document["law"]["specification"]
    assert old in text
    return tampered(document, ("law", "specification"), text.replace(old, new))


@pytest.mark.parametrize("kind", KINDS)
def test_the_law_is_said_as_it_was_built(kind, verify):
    """In words of the law itself: those of the document are not shown at all."""
    document = tampered(found(kind), ("law", "description"), "a wall of a million newtons per metre")
    said = verify(document)
    assert "law, stepped again wall, 200 N/m, with hysteresis of" in said
    assert "million" not in said
    assert "told, not checked" not in said
    assert law_of(document) == found(kind)["law"]["description"]


@pytest.mark.parametrize("kind", KINDS)
def test_another_law_is_refused(kind, verify):
    """By a hair more stiffness, another order of the laws, or one law less."""
    document = found(kind)
    text = document["law"]["specification"]
    first, last = text.split("[[law]]")[1:]
    assert "saturation" in last
    for other in (
        respecified(document, "200 N/m", "200.0000001 N/m"),
        tampered(document, ("law", "specification"), text.replace(f"[[law]]{first}", "")),
        respecified(document, 'limit = "5 N"', 'limit = "0.01 N"'),
    ):
        assert "the law of its specification gives other forces than it lists" in verify(other, 1)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("0.26 N*s/m", "0.27 N*s/m"),
        ("0.027 N", "0.028 N"),
        ("0.0001 m", "0.0002 m"),
        ("0.001 s", "0.002 s"),
        ("[device]", '[device]\ndelay = "0.001 s"'),
        ("[device]", '[device]\ndelay = "400000000 s"'),
    ],
)
@pytest.mark.parametrize("kind", KINDS)
def test_another_loop_is_refused(kind, old, new, verify):
    """The numbers of the proof are those of the device whose law it is; a long delay takes no time."""
    said = verify(respecified(found(kind), old, new), 1)
    assert "its specification is of a loop with other numbers" in said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[device", "not TOML"),
        ("[device]\nrate = 1000\ndamping = 1", "no environment is given"),
        ("[operator]\ntype = 'finger'", "zwidth simulate"),
        ("[device]\ncatalogue = 'nothing'\n[environment]\ntype = 'wall'\nstiffness = 1", "catalogue"),
        ("a = " + "[" * 5000, "specification"),
    ],
)
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_no_specification_is_refused(kind, text, said, verify):
    """In one sentence, and never with a traceback."""
    assert said in verify(tampered(found(kind), ("law", "specification"), text), 1)


@pytest.mark.parametrize("kind", KINDS)
def test_a_law_of_ones_own_is_told(kind, verify):
    """Nobody else has it: the proof is of the table, and the words stand beside it as words."""
    document = found(kind, Own)
    assert "specification" not in document["law"]
    assert "told, not checked wall, 200 N/m, with hysteresis of" in verify(document)
    assert law_of(document) is None


def test_a_document_that_would_take_long_is_told(verify, monkeypatch):
    """A small file does not keep the command busy."""
    monkeypatch.setattr(documents, "MOST_WORK", 5)
    for kind in KINDS:
        assert "told, not checked wall, 200 N/m" in verify(found(kind))


def test_weaker_forces_are_refused(verify):
    """Less force than the law's needs no more storage, and the checker alone accepts it."""
    document = found("row storage")
    forces = np.frombuffer(zlib.decompress(base64.b64decode(document["table"]["forces"])), "<f8").copy()
    strongest = int(forces.argmax())
    forces[strongest] = np.nextafter(forces[strongest], 0)
    weaker = tampered(document, ("table", "forces"), documents.packed(forces, "<f8"))
    assert zw.verify(weaker).valid
    assert "other forces than it lists" in verify(weaker, 1)


def test_a_motion_from_far_outside_takes_no_time(verify):
    """A hand that rests a kilometre outside rests at one count, not at each on the way."""
    document = copy.deepcopy(found("row motion"))
    document["bounds"] = {}
    document["positions_m"] = [-1000.0, -1000.0, -1000.0]
    document["forces_N"] = [0, 0]
    document["repeats"] = {"first": 0, "last": 2, "times": 1}
    assert "NOT VALID" in verify(document, 1)
