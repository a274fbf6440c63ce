"""`zwidth tissue`: from a messy spreadsheet to a tissue, its file and picture, and a wall to render."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from openpyxl import Workbook

import zwidth as zw
from zwidth.cli.main import main

TRUE = {"stiffness": 420, "branch_stiffness": 260, "branch_damping": 90}
SOLID = zw.StandardLinearSolid(*TRUE.values())
ONE = ("--model", "standard-linear-solid")
"""One model alone: these tests are of the file, not of the choice."""


class Result(NamedTuple):
    """What one command line left behind."""

    status: int
    out: str
    err: str


Run = Callable[..., Result]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs `zwidth tissue` in this process, in a folder of its own."""
    monkeypatch.chdir(tmp_path)

    def runner(*argv: str, command: str = "tissue") -> Result:
        status = main([command, *argv])
        said = capsys.readouterr()
        return Result(status, said.out, said.err)

    return runner


def relaxed(seed: int = 3, count: int = 300) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Half a second of nothing, 4 mm within 0.2 s, and a hold; times [s], depths [m], forces [N]."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 6, count)
    depth = 0.004 * np.clip((time - 0.5) / 0.2, 0, 1)
    return time, depth, zw.tissue.force_response(SOLID, time, depth) + rng.normal(0, 0.008, count)


def comma(value: float, digits: int) -> str:
    return f"{value:.{digits}f}".replace(".", ",")


def holds_the_truth(found: dict) -> bool:
    """All three numbers, twice as far off as the interval goes at the most."""
    parameters = found["best"]["parameters"]
    middle = {name: sum(parameters[name]["interval_95"]) / 2 for name in TRUE}
    half = {name: middle[name] - parameters[name]["interval_95"][0] for name in TRUE}
    return all(abs(middle[name] - value) < 2 * half[name] for name, value in TRUE.items())


def test_a_german_sheet_with_everything_the_other_way(run: Run, tmp_path: Path) -> None:
    """Semicolons, decimal commas, units below the names, lines above, missing cells, signs, zeros."""
    lines = ["Prüfprotokoll 3", "Prüfer;Müller", "", "Zeit;Standardweg;Standardkraft", "s;mm;N"]
    for k, (t, x, f) in enumerate(zip(*relaxed(), strict=True)):
        force = "" if k in (50, 51, 200) else comma(-f - 0.31, 4)
        lines.append(f"{comma(t + 117.2, 3)};{comma(44.1 - 1e3 * x, 4)};{force}")
    (tmp_path / "probe.csv").write_text("\n".join([*lines, ""]), encoding="latin-1")
    result = run("probe.csv", *ONE, "--json")
    found = json.loads(result.out)
    assert (result.status, found["kind"], found["samples"]) == (0, "relaxation", 297)
    assert holds_the_truth(found)
    said = " ".join(found["findings"])
    assert "3 of 300 rows lack a number" in said
    assert said.count("counts the other way") == 2


@pytest.mark.parametrize(
    ("head", "factors"),
    [
        ("Time [ms],Compressive extension [um],Compressive load [mN]", (1e3, 1e6, 1e3)),
        ("t/s,Indentation/mm,F/N", (1, 1e3, 1)),
        ("elapsed_s,z_mm,load_g", (1, 1e3, 1 / 9.80665e-3)),
        ("temps (min),enfoncement (cm),effort (N)", (1 / 60, 1e2, 1)),
    ],
)
def test_names_and_units_as_people_write_them(
    head: str, factors: tuple[float, float, float], run: Run, tmp_path: Path
) -> None:
    table = np.stack([column * factor for column, factor in zip(relaxed(), factors, strict=True)], axis=1)
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=head, comments="", fmt="%.7g")
    assert holds_the_truth(json.loads(run("a.csv", *ONE, "--json").out))


def sheet(folder: Path, head: str = "time_s,indentation_mm,force_N", rows: np.ndarray | None = None) -> None:
    """A plain file, a.csv."""
    time, depth, force = relaxed()
    table = np.stack([time, 1e3 * depth, force], axis=1) if rows is None else rows
    np.savetxt(folder / "a.csv", table, delimiter=",", header=head, comments="", fmt="%.6f")


def test_several_trials_are_said_and_chosen_between(run: Run, tmp_path: Path) -> None:
    """By the number in a column, and by a time that begins anew; the second one is twice as stiff here."""
    time, depth, force = relaxed()
    trials = [np.stack([np.full(300, n), time, 1e3 * depth, n * force], axis=1) for n in (1.0, 2.0)]
    for head, first in (("trial,time_s,indentation_mm,force_N", 0), ("time_s,indentation_mm,force_N", 1)):
        sheet(tmp_path, head, np.concatenate(trials)[:, first:])
        found = [json.loads(run("a.csv", *ONE, "--json", "--trial", n).out) for n in ("1", "2")]
        assert [(each["trial"], len(each["trials"])) for each in found] == [(1, 2), (2, 2)]
        assert "the trials differ in stiffness" in found[0]["doubts"][0]
        once, twice = (each["best"]["parameters"]["stiffness"]["value"] for each in found)
        assert twice == pytest.approx(2 * once, rel=1e-4)
    assert "has 2 trials, and trial 3 is wanted" in run("a.csv", "--trial", "3").err.replace("\n", " ")


def test_a_hole_in_time_is_said(run: Run, tmp_path: Path) -> None:
    rows = np.delete(
        np.stack([relaxed()[0], 1e3 * relaxed()[1], relaxed()[2]], axis=1), slice(150, 200), axis=0
    )
    sheet(tmp_path, rows=rows)
    result = run("a.csv", *ONE)
    assert "no samples from t = 2.99 to 4.013 s" in result.out
    assert max(map(len, result.out.splitlines())) <= 80


def test_the_tissue_that_is_saved_is_the_one_that_was_checked(run: Run, tmp_path: Path) -> None:
    """PHANToM: b = 0.27 N·s/m at 1 kHz pays for less than 680 N/m at once; what is saved is passive."""
    sheet(tmp_path)
    result = run("a.csv", "phantom", *ONE, "-o", "t.toml", "--plot", "t.png", "--json")
    found = json.loads(result.out)
    assert result.status == 1
    assert run("phantom", "t.toml", command="check").status == 1
    assert "95 % intervals" in (tmp_path / "t.toml").read_text(encoding="utf-8")
    assert (tmp_path / "t.png").stat().st_size > 1000
    largest = found["largest_gain"]["proved_passive"]
    assert largest == pytest.approx(0.27 / (0.001 / 2) / 680, rel=0.02)  # b/(T/2)/(μ0 + μ1), τ far above T
    assert run("a.csv", "phantom", *ONE, "--scaled", "-o", "s.toml").status == 1
    assert run("phantom", "s.toml", command="check").status == 0


@pytest.mark.parametrize(
    ("head", "argv", "says"),
    [
        ("time,indentation,force", (), "--unit time=s --unit indentation=mm --unit force=N"),
        ("time_s,indentation_mm,b", (), "no column is known to be the force"),
        ("time_s,force_1_N,force_2_N", ("--column", "indentation=force_1_N"), "no unit of length"),
        ("time_s,indentation_mm,force_N", ("--column", "force=F"), 'has no column "F"'),
        ("time_s,indentation_mm,force_N", ("--column", "speed=F"), "there is no quantity"),
        ("time_s,indentation_mm,force_N", ("--kind", "creeep"), "creep"),
        ("time_s,indentation_mm,force_N", ("--model", "spring"), "there is no model"),
        ("time_s,indentation_mm,force_N", ("--trial", "0"), "whole number from 1"),
        ("time_s,indentation_mm,force_N", ("--scaled",), "give DEVICE"),
        ("time_s,indentation_mm,force_N", ("-o", "tissue.json"), "saved as TOML"),
    ],
)
def test_what_cannot_be_is_one_message(
    head: str, argv: tuple[str, ...], says: str, run: Run, tmp_path: Path
) -> None:
    sheet(tmp_path, head)
    result = run("a.csv", *argv)
    assert (result.status, result.out) == (2, "")
    assert says in " ".join(result.err.split())


def test_two_columns_that_may_be_the_force_are_not_chosen_between(run: Run, tmp_path: Path) -> None:
    time, depth, force = relaxed()
    sheet(tmp_path, "time_s,z_mm,force_1_N,force_2_N", np.stack([time, 1e3 * depth, force, force], axis=1))
    assert "--column force=force_1_N" in run("a.csv").err
    assert run("a.csv", *ONE, "--column", "force=force_2_N").status == 0


def test_a_workbook_and_a_device_by_its_parameters(run: Run, tmp_path: Path) -> None:
    """Its sheets are trials, one may be named, and what the catalogue does not know of a device is typed."""
    book = Workbook()
    for sheet in (book.active, book.create_sheet("Probe 2")):
        sheet.append(["Prüfzeit [s]", "Standardweg [mm]", "Standardkraft [N]"])
        for t, x, f in zip(*relaxed(count=150), strict=True):
            sheet.append([float(t), 1e3 * float(x), float(f)])
    book.save(tmp_path / "a.xlsx")
    found = json.loads(run("a.xlsx", *ONE, "--json").out)
    assert (len(found["trials"]), holds_the_truth(found)) == (2, True)
    assert json.loads(run("a.xlsx", *ONE, "--sheet", "probe 2", "--json").out)["trials"] == []
    said = run("a.xlsx", "omega.3", "--damping", "2 N*s/m").err
    assert "no source gives the rate" in " ".join(said.split())


def test_a_workbook_of_an_old_program_is_refused_with_what_to_do(run: Run, tmp_path: Path) -> None:
    """Locked workbooks begin alike."""
    start = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600)
    for content, says in ((b"", "save it as .xlsx"), ("EncryptedPackage".encode("utf-16-le"), "a password")):
        (tmp_path / "a.xls").write_bytes(start + content)
        result = run("a.xls")
        assert result.status == 2
        assert says in " ".join(result.err.split())


@pytest.mark.parametrize("column", [1, 2])
def test_nothing_was_pushed(column: int, run: Run, tmp_path: Path) -> None:
    """A probe that stays at 0, or a force that is always 0."""
    rows = np.stack([relaxed()[0], 1e3 * relaxed()[1], relaxed()[2]], axis=1)
    rows[:, column] = 0.0
    sheet(tmp_path, rows=rows)
    assert "nothing was pushed" in " ".join(run("a.csv").err.split())
