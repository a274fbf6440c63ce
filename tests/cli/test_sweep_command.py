"""`zwidth sweep`: report, JSON, picture and files, and one clear line on bad input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.cli.main import main

SWEEP = (
    "sweep", "haptic-paddle", "--vary", "stiffness=50:600:12", "--vary", "delay=0:2 ms:5", "--workers", "1",
)  # fmt: skip


def test_the_report_and_the_json_say_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    """As `zw.sweep` has it: so many loops of each outcome, where they are, and what that means."""
    assert main(SWEEP) == 0
    report = capsys.readouterr().out
    assert main((*SWEEP, "--json")) == 0
    document = json.loads(capsys.readouterr().out)
    found = zw.sweep(
        zw.catalogue.device("haptic-paddle"),
        zw.Wall(1),
        vary={"stiffness": (50, 600, 12), "delay": "0:2 ms:5"},
    )
    passive = int((found.outcome == "passive").sum())
    assert document["outcomes"] == {"active": 60 - passive, "passive": passive}
    assert document["loops"] == 60
    assert document["axes"]["delay_s"] == [0, 0.0005, 0.001, 0.0015, 0.002]
    assert document["numbers"]["max_stiffness_N_per_m"]["largest"] == 300
    assert document["scope"]["hands"] == {"which": "every"}
    assert f"passive     {passive}" in report
    assert "60 loops: stiffness 50 N/m to 600 N/m, 12 values; delay 0 s to 2 ms, 5 values" in report
    assert "by closed forms" in report


def test_hands_that_are_known(capsys: pytest.CaptureFixture[str]) -> None:
    """Of each so many loops that come to rest, in the report and as JSON; of another question refused."""
    few = (
        "sweep",
        "haptic-paddle",
        "--vary",
        "stiffness=100,3000",
        "--hands",
        "none,finger",
        "--workers",
        "1",
    )
    assert main(few) == 0
    report = capsys.readouterr().out
    assert main((*few, "--json")) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["stability"]["none"] == {"stable": 1, "unstable": 1}
    assert "with finger" in report
    assert "dry friction and encoder steps left out" in " ".join(report.split())
    assert main((*few, "--of", "limit")) == 2
    assert "--hands is of check" in capsys.readouterr().err


def test_a_table_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both are written, and said to be; the same command again finds the table whole."""
    table, picture = tmp_path / "sweep.parquet", tmp_path / "sweep.svg"
    command = (*SWEEP, "-o", str(table), "--plot", str(picture))
    assert main(command) == 0
    assert [line for line in capsys.readouterr().out.splitlines() if "written" in line] == [
        f"written: {table}",
        f"written: {picture}",
    ]
    before = table.read_bytes()
    assert main(command) == 2
    assert "sweep.svg exists" in capsys.readouterr().err
    assert main((*command, "--force")) == 0
    assert table.read_bytes() == before
    assert not (tmp_path / "sweep.parquet.begun").exists()
    assert zw.load_sweep(table).sizes == {"stiffness": 12, "delay": 5}


def test_other_questions(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A limit of one parameter over another, and a pair whose link is late."""
    of_limit = ("sweep", "haptic-paddle", "--stiffness", "100", "--of", "limit", "--vary", "damping=0.1,0.2",
                "--tolerance", "0.1")  # fmt: skip
    assert main((*of_limit, "--workers", "1", "--plot", str(tmp_path / "limit.png"))) == 0
    assert "proved passive" in capsys.readouterr().out
    of_pair = ("sweep", "haptic-paddle", "--of", "pair", "--stiffness", "50", "--vary", "link-delay=0, 9 ms")
    assert main((*of_pair, "--workers", "1", "--json")) == 0
    assert json.loads(capsys.readouterr().out)["axes"] == {"link_delay_s": [0, 0.009]}


def test_a_law_of_the_command_line_gets_its_number(capsys: pytest.CaptureFixture[str]) -> None:
    """What is varied need not be given, of a law in a chain either; of `limit` and `simulate` as well."""
    varied = ("sweep", "haptic-paddle", "--stiffness", "200", "--law", "damper", "--workers", "1", "--json",
              "--vary", "law.damping=10:20 mN*s/m:2")  # fmt: skip
    for more in ((), ("--of", "limit"), ("--of", "simulate", "--operator", "dowel", "--duration", "5 ms")):
        assert main((*varied, *more)) == 0
        assert json.loads(capsys.readouterr().out)["axes"] == {"law.damping_N_s_per_m": [0.01, 0.02]}


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ((), "nothing is varied"),
        (("--vary", "window=4", "--stiffness", "9"), "to vary in this loop. What can be varied: coulomb"),
        (("--vary", "type=wall,maxwell", "--stiffness", "9"), 'no number "type" to vary'),
        (("--vary", "law.2.limit=1,2", "--law", "saturation", "--stiffness", "9"), 'mean "law.limit"'),
        (("--vary", "stiffness"), "--vary is NAME=VALUES"),
        (("--vary", "stifness=1,2"), 'did you mean "stiffness"'),
        (("--vary", "rate=1,2", "--vary", "rate=3,4"), "given twice"),
        (("--vary", "stiffness=1,2", "--stiffness", "3"), "--stiffness is given and varied"),
        (("--vary", "stiffness=1,2", "--operator.force", "3"), "--operator.force is no option of check"),
        (("--vary", "stiffness=1,2", "--parameter", "rate"), "--parameter is of limit"),
        (("--vary", "stiffness=1,2", "--of", "serve"), "--of is one of check"),
        (("--vary", "stiffness=1,2", "--workers", "many"), "--workers takes a whole number"),
        (("--vary", "stiffness=1,2", "--plot", "a.txt"), "must end in .png"),
        (("--vary", "stiffness=1,2", "-o", "a.nc"), "ends in .zarr or .parquet"),
        (("--vary", "stiffness=-1,2"), "stiffness must be"),
        (("--vary", "delay=0:5:3", "--stiffness", "9"), "5 without a unit is 5 s"),
    ],
)
def test_bad_input_in_one_line(
    more: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2, and what to do."""
    assert main(("sweep", "haptic-paddle", *more)) == 2
    assert message in " ".join(capsys.readouterr().err.split())


def test_what_was_finished_is_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """After Ctrl-C the same command goes on, and says so."""

    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.study.sweeps.run.sweep", stop)
    assert main((*SWEEP, "-o", str(tmp_path / "s.zarr"))) == 130
    assert "the same command goes on" in " ".join(capsys.readouterr().err.split())
