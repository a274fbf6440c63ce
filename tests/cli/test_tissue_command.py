"""`zwidth tissue`: from a messy spreadsheet to a tissue, its file and picture, and a wall to render."""

from pathlib import Path

import numpy as np
import pytest
from openpyxl import Workbook

import zwidth as zw

TRUE = {"stiffness": 420, "branch_stiffness": 260, "branch_damping": 90}
SOLID = zw.StandardLinearSolid(*TRUE.values())
ONE = "--model standard-linear-solid"
"""One model alone: these tests are of the file, not of the choice."""


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(run):
    pass


def relaxed(count=300):
    """Half a second of nothing, 4 mm within 0.2 s, and a hold; times [s], depths [m], forces [N]."""
    rng = np.random.default_rng(3)
    time = np.linspace(0, 6, count)
    depth = 0.004 * np.clip((time - 0.5) / 0.2, 0, 1)
    return time, depth, zw.tissue.force_response(SOLID, time, depth) + rng.normal(0, 0.008, count)


def holds_the_truth(found):
    """All three numbers, twice as far off as the interval goes at the most."""
    parameters = found["best"]["parameters"]
    middle = {name: sum(parameters[name]["interval_95"]) / 2 for name in TRUE}
    half = {name: middle[name] - parameters[name]["interval_95"][0] for name in TRUE}
    return all(abs(middle[name] - value) < 2 * half[name] for name, value in TRUE.items())


def test_a_german_sheet_with_everything_the_other_way(run):
    """Semicolons, decimal commas, units below the names, lines above, missing cells, signs, zeros."""
    lines = ["Prüfprotokoll 3", "Prüfer;Müller", "", "Zeit;Standardweg;Standardkraft", "s;mm;N"]
    for k, (t, x, f) in enumerate(zip(*relaxed(), strict=True)):
        force = "" if k in (50, 51, 200) else f"{-f - 0.31:.4f}"
        lines.append(f"{t + 117.2:.3f};{44.1 - 1e3 * x:.4f};{force}".replace(".", ","))
    Path("probe.csv").write_text("\n".join([*lines, ""]), encoding="latin-1")
    found = run(f"tissue probe.csv {ONE} --json").json
    assert (found["kind"], found["samples"]) == ("relaxation", 297)
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
def test_names_and_units_as_people_write_them(run, head, factors):
    table = np.stack([column * factor for column, factor in zip(relaxed(), factors, strict=True)], axis=1)
    np.savetxt("a.csv", table, delimiter=",", header=head, comments="", fmt="%.7g")
    assert holds_the_truth(run(f"tissue a.csv {ONE} --json").json)


PLAIN = "time_s,indentation_mm,force_N"


def columns():
    """Of a plain file."""
    time, depth, force = relaxed()
    return np.stack([time, 1e3 * depth, force], axis=1)


def write(head=PLAIN, rows=None):
    """A plain file, a.csv."""
    table = columns() if rows is None else rows
    np.savetxt("a.csv", table, delimiter=",", header=head, comments="", fmt="%.6f")


def test_several_trials_are_said_and_chosen_between(run, refused):
    """By the number in a column, and by a time that begins anew; the second one is twice as stiff here."""
    time, depth, force = relaxed()
    trials = [np.stack([np.full(300, n), time, 1e3 * depth, n * force], axis=1) for n in (1.0, 2.0)]
    for head, first in ((f"trial,{PLAIN}", 0), (PLAIN, 1)):
        write(head, np.concatenate(trials)[:, first:])
        found = [run(f"tissue a.csv {ONE} --json --trial {n}").json for n in ("1", "2")]
        assert [(each["trial"], len(each["trials"])) for each in found] == [(1, 2), (2, 2)]
        assert "the trials differ in stiffness" in found[0]["doubts"][0]
        once, twice = (each["best"]["parameters"]["stiffness"]["value"] for each in found)
        assert twice == pytest.approx(2 * once, rel=1e-4)
    assert "has 2 trials, and trial 3 is wanted" in refused("tissue a.csv --trial 3")


def test_a_hole_in_time_is_said(run):
    write(rows=np.delete(columns(), slice(150, 200), axis=0))
    out = run(f"tissue a.csv {ONE}").out
    assert "no samples from t = 2.99 to 4.013 s" in out
    assert max(map(len, out.splitlines())) <= 80


def test_the_tissue_that_is_saved_is_the_one_that_was_checked(run):
    """PHANToM: b = 0.27 N·s/m at 1 kHz pays for less than 680 N/m at once; what is saved is passive."""
    write()
    found = run(f"tissue a.csv phantom {ONE} -o t.toml --plot t.png --json", 1).json
    run("check phantom t.toml", 1)
    assert "95 % intervals" in Path("t.toml").read_text(encoding="utf-8")
    assert Path("t.png").stat().st_size > 1000
    largest = found["largest_gain"]["proved_passive"]
    assert largest == pytest.approx(0.27 / (0.001 / 2) / 680, rel=0.02)  # b/(T/2)/(μ0 + μ1), τ far above T
    run(f"tissue a.csv phantom {ONE} --scaled -o s.toml", 1)
    run("check phantom s.toml")


def test_a_scale_says_while_which_contact_it_is_proved(run):
    """Behind a delay more is proved of a hand that stays inside: what is saved is that, and says so."""
    write()
    told = run(f"tissue a.csv phantom --delay '1 ms' {ONE} --scaled -o s.toml", None).out.replace("\n", " ")
    assert "while contact is kept" in told
    assert "not given, taken as 0" in " ".join(told.split())
    remark = Path("s.toml").read_text(encoding="utf-8")
    assert (
        "proved passive while contact is kept on phantom, Coulomb friction, resolution taken as 0" in remark
    )
    assert "PASSIVE IN CONTACT" in run("check phantom s.toml --delay '1 ms'", 4).out


@pytest.mark.parametrize(
    ("head", "argv", "says"),
    [
        ("time,indentation,force", "", "--unit time=s --unit indentation=mm --unit force=N"),
        ("time_s,indentation_mm,b", "", "no column is known to be the force"),
        ("time_s,force_1_N,force_2_N", "--column indentation=force_1_N", "no unit of length"),
        (PLAIN, "--column force=F", 'has no column "F"'),
        (PLAIN, "--column speed=F", "there is no quantity"),
        (PLAIN, "--kind creeep", "creep"),
        (PLAIN, "--model spring", "there is no model"),
        (PLAIN, "--trial 0", "whole number from 1"),
        (PLAIN, "--scaled", "give DEVICE"),
        (PLAIN, "-o tissue.json", "saved as TOML"),
    ],
)
def test_what_cannot_be_is_one_message(refused, head, argv, says):
    write(head)
    assert says in refused(f"tissue a.csv {argv}")


def test_two_columns_that_may_be_the_force_are_not_chosen_between(run, refused):
    write("time_s,z_mm,force_tip_N,force_base_N", columns()[:, [0, 1, 2, 2]])
    assert "--column force=force_tip_N" in refused("tissue a.csv")
    run(f"tissue a.csv {ONE} --column force=force_base_N")


def test_what_nobody_published_is_taken_within_the_ranges_as_check_takes_it(run):
    """Of the Touch the damping, too: the scale is of the worst ends, and says whether of every value."""
    write()
    found = run(f"tissue a.csv touch {ONE} --scaled -o s.toml --json", 3)
    assert "damping 0.05 N·s/m, Coulomb friction 0.03 N, resolution 100 µm, delay 1 ms" in found.err
    assert set(found.json["ranges"]["stated"]) == {
        "damping_N_s_per_m", "coulomb_friction_N", "resolution_m", "delay_s"
    }  # fmt: skip
    assert found.json["check"]["outcome"] == "undecided"
    throughout = found.json["largest_gain"]["for_every_value_of_the_intervals"]
    assert throughout == {"made_and_broken": False, "kept": True}
    run("check touch s.toml --contact kept")
    out = " ".join(run(f"tissue a.csv touch {ONE}", 3).out.split())
    assert "delay 0 … 1 ms; stated, not measured" in out
    assert "while contact is kept (for every value of the device's intervals)" in out
    known = "--damping 1 --delay 0 --coulomb-friction 1 --resolution 0"
    assert "ranges" not in run(f"tissue a.csv touch {ONE} {known} --json").json


def test_a_workbook_and_a_device_by_its_parameters(run, refused):
    """Its sheets are trials, one may be named, and a device that is in no file is typed."""
    book = Workbook()
    for sheet in (book.active, book.create_sheet("Probe 2")):
        sheet.append(["Prüfzeit [s]", "Standardweg [mm]", "Standardkraft [N]"])
        for t, x, f in zip(*relaxed(count=150), strict=True):
            sheet.append([float(t), 1e3 * float(x), float(f)])
    book.save("a.xlsx")
    found = run(f"tissue a.xlsx {ONE} --json").json
    assert (len(found["trials"]), holds_the_truth(found)) == (2, True)
    assert run(f"tissue a.xlsx {ONE} --sheet 'probe 2' --json").json["trials"] == []
    typed = f"tissue a.xlsx {ONE} --damping '2 N*s/m' --rate"
    assert run(f"{typed} '1 kHz' --json").json["check"]["outcome"] == "passive"
    assert "rate must be" in refused(f"{typed} 0")


def test_a_workbook_of_an_old_program_is_refused_with_what_to_do(refused):
    """Locked workbooks begin alike."""
    start = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600)
    for content, says in ((b"", "save it as .xlsx"), ("EncryptedPackage".encode("utf-16-le"), "a password")):
        Path("a.xls").write_bytes(start + content)
        assert says in refused("tissue a.xls")


@pytest.mark.parametrize("column", [1, 2])
def test_nothing_was_pushed(refused, column):
    """A probe that stays at 0, or a force that is always 0."""
    rows = columns()
    rows[:, column] = 0.0
    write(rows=rows)
    assert "nothing was pushed" in refused("tissue a.csv")
