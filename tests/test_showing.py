"""Text of others is shown, never obeyed: in a notebook, in a picture, on a terminal."""

import ast
import json
import os
import re
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import zwidth as zw
from zwidth.cli.main import main
from zwidth.data.gains.controllers import CartesianGains, Controllers, JointLaw
from zwidth.machine.servo.recording.replayed import Replay
from zwidth.model.arms.reading import built_in
from zwidth.showing import (
    OBEYED,
    Headline,
    Html,
    Lines,
    Picture,
    Shown,
    Table,
    element,
    one_line,
    printable,
    void,
)

SCRIPT = "<script>alert(1)</script>"
HOSTILE = f"{SCRIPT} $\\frac{{$ & \x1b[2J\x9b31m \u202e\"'"
SOURCE = sorted(Path(zw.__file__).parent.rglob("*.py"))
DEVICE = zw.Device(mass=0.04, damping=0.15, sample_period=0.001, name=HOSTILE)
LOG = zw.Log.from_arrays(time=np.arange(50) / 1000, position=np.sin(np.arange(50)))
CONTROLLERS = Controllers(
    joints=(JointLaw("shoulder", Fraction(201, 2), Fraction(0), Fraction(5, 2), "file"),),
    cartesian=(CartesianGains((1, 2, 3, 4, 5, 6), (1,) * 6, 0, 0, None, "file"),),
    rate=Fraction(1000),
    notes=(HOSTILE,),
)


def test_only_html_becomes_a_part_of_html():
    """Text is escaped wherever it stands, attributes too; what was escaped is not escaped again."""
    assert element("p", "a < b") == "<p>a &lt; b</p>"
    assert element("p", element("b", "&")) == "<p><b>&amp;</b></p>"
    assert element("p", style='"><b>') == '<p style="&quot;&gt;&lt;b&gt;"></p>'
    assert Table(heads=[["<"]], rows=[["1"]]).html == (
        "<table><thead><tr><th>&lt;</th></tr></thead><tbody><tr><td>1</td></tr></tbody></table>"
    )


def test_a_picture_stands_within_the_page():
    """Its file in the address, what it shows as text; of its own markup nothing is a part of the page."""
    drawn = Picture(b"<svg/>", "svg+xml", 'a "curve" <b>', "below it")
    assert drawn.html == (
        '<figure><img src="data:image/svg+xml;base64,PHN2Zy8+" alt="a &quot;curve&quot; &lt;b&gt;" '
        'style="max-width:100%;height:auto"/><figcaption>below it</figcaption></figure>'
    )
    assert str(drawn) == 'a "curve" <b>'
    assert void("meta", name="a\x1b&") == '<meta name="a?&amp;"/>'


class Shows(Shown):
    """Says one thing of each kind."""

    def report(self):
        yield Headline("passive", "#123456", "No <motion>.")
        yield ""
        yield "in words"
        yield Table(
            caption="of <b>", heads=[["name", "", "N"]], rows=[["a <", "of", "10"], ["b", "no", "9"]], lefts=2
        )
        yield Lines(["x < 0"], "assumptions")
        yield Lines(["beware"], mark="!")


def test_what_is_said_once_is_shown_in_both_places():
    """In a terminal in columns, set left or right; in a notebook in elements, and no blank lines."""
    assert repr(Shows()) == (
        "passive: No <motion>.\n\nin words\n"
        "of <b>\n\nname       N\na <   of  10\nb     no   9\n"
        "· x < 0\n! beware"
    )
    assert Shows()._repr_html_() == (
        '<div><b style="color:#123456">passive</b> No &lt;motion&gt;.<p>in words</p>'
        "<table><caption>of &lt;b&gt;</caption>"
        "<thead><tr><th>name</th><th></th><th>N</th></tr></thead><tbody>"
        "<tr><td>a &lt;</td><td>of</td><td>10</td></tr><tr><td>b</td><td>no</td><td>9</td></tr>"
        "</tbody></table><details><summary>assumptions</summary><ul><li>x &lt; 0</li></ul></details>"
        "<ul><li>beware</li></ul></div>"
    )


def test_rows_without_headings_have_a_name_first():
    assert Table(rows=[["K", "1 N/m"]]).html == (
        '<table><tbody><tr><th scope="row" style="text-align:left">K</th>'
        '<td style="text-align:left">1 N/m</td></tr></tbody></table>'
    )


def test_what_a_terminal_obeys_is_not_printed():
    """Escapes, carriage returns, C1 controls, a change of direction; line ends and Greek letters stay."""
    assert printable("a\x1b[31m\rb\x9bc\u202ed\ue000") == "a?[31m?b?c?d\ue000"
    assert printable("2b/T ≥ K·s²\n\tμ") == "2b/T ≥ K·s²\n\tμ"


def _pages():
    for path in SOURCE:
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if "Html" in text else ():
            if isinstance(node, ast.FunctionDef) and node.name in ("_repr_html_", "html"):
                yield path.name, node


def test_every_page_of_a_notebook_is_made_of_escaped_parts():
    """By its type: `Html` comes from one module only, and a text or an f-string is none."""
    pages = list(_pages())
    assert {name for name, _ in pages} == {"showing.py", "device.py"}
    for name, page in pages:
        assert ast.unparse(page.returns) == "Html", name
        answers = [part.value for part in ast.walk(page) if isinstance(part, ast.Return)]
        assert not [one for one in answers if isinstance(one, (ast.JoinedStr, ast.Constant, ast.BinOp))], name
    makers = {path.name for path in SOURCE if re.search(r"\bHtml\(", path.read_text(encoding="utf-8"))}
    assert makers == {"showing.py"}


@pytest.fixture(scope="module")
def trace():
    """Of a device whose name is hostile."""
    return zw.simulate(DEVICE, zw.Wall(200), zw.operators.ConstantForce(1), 0.02)


def test_names_are_escaped_in_notebooks(trace):
    """Whatever can hold a name of a user shows it as it was typed."""
    verdict = zw.check(DEVICE, zw.Wall(200))
    active = zw.check(DEVICE, zw.Wall(2000))
    shown = (
        DEVICE, verdict, verdict.certificate, active, active.witness, zw.replay(active), trace.zwidth.energy,
        zw.traces.compare_traces({HOSTILE: trace}), replace(LOG, source=HOSTILE), CONTROLLERS,
    )  # fmt: skip
    for page in (one._repr_html_() for one in shown):
        assert isinstance(page, Html)
        assert "<script" not in page
        assert not OBEYED.search(page)
        ElementTree.fromstring(page)
    assert "&lt;script&gt;" in DEVICE._repr_html_()


def test_what_is_read_and_what_is_found_says_what_it_is():
    """A log, gains of an arm, a replay, what the checker says: in a terminal a few lines, and no fields."""
    assert repr(LOG) == (
        "arrays: 50 ms, 50 samples, one every 1 ms; encoder step none; forces: none\n"
        "· sample period 1 ms from the stamps\n· the positions show no step; the resolution is taken as 0\n"
        "· no column of the hand's force is used"
    )
    assert repr(CONTROLLERS).splitlines()[:4] == [
        "joint     stiffness     integral    damping",
        "            N·m/rad  N·m/(rad·s)  N·m·s/rad",
        "shoulder      100.5            0        2.5",
        "at the end                  x  y  z  about x  about y  about z",
    ]
    assert "rate: 1 kHz" in repr(CONTROLLERS)
    replayed = Replay(simulated=None, samples=2000, different=3, largest=0.25, motion="rotary")
    told = "the simulation gives another force in 3 of 2,000 samples, by 0.25 N·m at most"
    assert repr(replayed) == told
    assert told in replayed._repr_html_()
    verified = zw.verify(zw.check(DEVICE, zw.Wall(2000)).witness.to_dict())
    assert repr(verified) == f"proved: {verified.reason}"
    assert not OBEYED.search(repr(zw.verify({"kind": HOSTILE})))


def test_what_xarray_shows_is_not_obeyed_either(trace, tmp_path):
    """A Dataset says its attributes as they are: those of a device, and those of a file of others."""
    for suffix in (".nc", ".csv", ".parquet"):
        path = tmp_path / f"touch{suffix}"
        trace.assign_attrs(device=HOSTILE, operator="two\nlines").zwidth.save(path)
        loaded = zw.traces.load_trace(path)
        assert loaded.attrs["operator"] == "two\nlines"
        for one in (trace, loaded):
            assert "<script" not in one._repr_html_()
            assert not OBEYED.search(repr(one) + one._repr_html_())


@given(st.text(), st.text())
def test_no_name_and_no_message_holds_what_is_obeyed(name, more):
    """Whoever made the text: a device, an arm, a message that quotes it."""
    device = zw.Device(mass=1, damping=1, sample_period=1, name=name)
    arm = replace(built_in("two-link", damping=0.1), name=name)
    for shown in (device.name, arm.name, str(zw.InputError(f"{name!s}: {more}")), one_line(name)):
        assert not OBEYED.search(shown)
    assert one_line(name).isprintable()


DRAWN = {
    "trace": lambda trace, path: trace.zwidth.plot(path),
    "traces": lambda trace, path: zw.traces.compare_traces({HOSTILE: trace}).plot(path),
    "verdict": lambda _, path: zw.check(DEVICE, zw.Wall(200)).plot(path),
    "law": lambda _, path: zw.compare(DEVICE, zw.Wall(200), {HOSTILE: zw.Wall(200)}).plot(path),
}


@pytest.mark.parametrize("draw", DRAWN)
def test_names_are_drawn_as_they_are(draw, trace, tmp_path):
    """Neither markup nor mathematics; the picture is whole XML without a script."""
    path = tmp_path / "picture.svg"
    DRAWN[draw](trace, path)
    tree = ElementTree.parse(path)
    assert not [part for part in tree.iter() if "script" in str(part.tag)]


TOML = """
[device]
name = {name}
mass = 0.04
damping = 0.15
sample_period = 0.001

[environment]
type = "wall"
stiffness = 200
"""


def test_a_file_cannot_command_the_terminal(tmp_path, capsys):
    """What a specification calls its device is printed without what a terminal obeys."""
    path = tmp_path / "loop.toml"
    path.write_text(TOML.format(name='"bad \\u001b[2J \\u009b31m \\u202e"'), encoding="utf-8")
    assert main(["check", str(path)]) == 0
    printed = capsys.readouterr().out
    assert "bad" in printed
    assert not OBEYED.search(printed)


@pytest.mark.skipif(os.name != "posix", reason="no such names of files")
@pytest.mark.parametrize("options", [[], ["--json"]])
def test_the_name_of_a_file_cannot_command_the_terminal(options, trace, tmp_path, capsys, monkeypatch):
    """A trace is called by it, in the table and in JSON, where it can be read back."""
    monkeypatch.chdir(tmp_path)
    name = "\x1b[2J\x7f\x9btouch.nc" if sys.getfilesystemencoding() == "utf-8" else "\x1b[2J\x7ftouch.nc"
    trace.zwidth.save(name)
    assert main(["traces", name, *options]) == 0
    printed = capsys.readouterr().out
    assert "touch.nc" in printed
    assert not OBEYED.search(printed)
    assert not options or name in json.loads(printed)
