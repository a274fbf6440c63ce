"""`zwidth examples`: files that say where their numbers come from, and commands that do what they say."""

import json
from pathlib import Path
from runpy import run_path

import pytest

import zwidth as zw
from zwidth.model.samples import EXAMPLES

SAYS = {
    "wheel.toml": (0, "PASSIVE"),
    "paddle.toml": (1, "ACTIVE"),
    "knob.toml": (0, "TOUCH"),
    "session.csv": (0, "IDENTIFIED"),
    "relaxation.csv": (0, "relaxation test of a standard linear solid"),
    "shaking.csv": (0, "DELAY"),
    "hapkit.toml": (0, "hapkit.ino"),
    "arm.urdf": (0, "PASSIVE"),
    "leader.toml": (0, "PASSIVE"),
    "arms.toml": (0, "PASSIVE"),
    "leader.yaml": (1, "8 joints"),
    "room.toml": (0, "paddle: haptic-paddle"),
    "firmware/device.toml": (0, "PASSIVE"),
}
"""By the first file of an example, the exit status of its command and what stands in its report."""


@pytest.mark.parametrize("first", SAYS)
def test_the_command_of_an_example_does_what_it_says(run, first):
    (example,) = (e for e in EXAMPLES if e.files[0] == first)
    run("examples .")
    status, word = SAYS[first]
    assert example.command.startswith("zwidth ")
    assert word in run(example.command.removeprefix("zwidth "), status).out


def test_every_example_that_zwidth_runs_is_tried_here():
    assert {e.files[0] for e in EXAMPLES if e.command.startswith("zwidth")} == set(SAYS)


def test_the_fit_of_the_relaxation_test_finds_the_tissue_that_it_was_made_of(run, capsys):
    """310 and 145 N/m, 60 N·s/m, as examples/sample_logs.py has them; numbers are printed to four digits."""
    run("examples .")
    run_path("fit_tissue.py")
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    for name, truth in (("stiffness", 310), ("branch_stiffness", 145), ("branch_damping", 60)):
        (row,) = (row for row in rows if row and row[0] == name)
        assert float(row[2]) <= truth <= float(row[4])


def test_the_log_holds_the_paddle_that_it_was_made_of():
    """36 g, 0.15 N·s/m, 0.12 N, as examples/sample_logs.py has them."""
    found = zw.identify(zw.samples.path("session.csv"))
    for name, truth in (("mass", 0.036), ("damping", 0.15), ("coulomb_friction", 0.12)):
        low, high = found.estimates[name].interval(0.99)
        assert low < truth < high


def test_the_list_fits_80_columns_and_names_every_file_and_command(run):
    said = run("examples").out
    assert max(map(len, said.splitlines())) <= 80
    assert all(name in said for name in zw.samples.names())
    assert all(example.command in said for example in EXAMPLES)


def test_every_file_of_the_folder_is_listed_and_says_where_its_numbers_come_from():
    package = zw.samples.path("wheel.toml").parent
    files = (path for path in package.rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc"))
    there = {path.relative_to(package).as_posix() for path in files} | {"fit_tissue.py"}
    assert there == set(zw.samples.names())
    told = ("invented", "Simulated", "Abbott and Okamura", "its example", "relaxation.csv")
    for name in there:
        head = "\n".join(zw.samples.path(name).read_text(encoding="utf-8").splitlines()[:20])
        assert name.endswith((".ipynb", ".yml")) or any(word in head for word in told), name


def test_nothing_is_replaced_without_force(run, refused):
    mine = Path("wheel.toml")
    mine.write_text("mine", encoding="utf-8")
    assert "wheel.toml exists" in refused("examples .")
    assert [path.name for path in Path().iterdir()] == ["wheel.toml"]
    run("examples . --force")
    assert "[device]" in mine.read_text(encoding="utf-8")


def test_a_folder_that_cannot_be_made_is_one_message(refused):
    Path("file").write_text("", encoding="utf-8")
    for folder in ("file", "no/such"):
        refused(f"examples {folder}")
    Path("firmware").write_text("", encoding="utf-8")
    assert "firmware" in refused("examples .")


def test_an_unknown_sample_is_refused_with_the_names_there_are():
    with pytest.raises(zw.InputError, match=r"wheel\.toml"):
        zw.samples.path("../catalogue.toml")


@pytest.mark.parametrize("lesson", [n for n in zw.samples.names() if n.endswith(".ipynb")])
def test_the_cells_of_a_lesson_run(lesson, tmp_path, monkeypatch, capsys):
    """One after the other, from a kernel's empty start; no outputs are stored."""
    monkeypatch.chdir(tmp_path)
    import matplotlib.pyplot as plt

    book = json.loads(zw.samples.path(lesson).read_text(encoding="utf-8"))
    assert (book["nbformat"], len({cell["id"] for cell in book["cells"]})) == (4, len(book["cells"]))
    names = {}
    for cell in book["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            exec(compile("".join(cell["source"]), lesson, "exec"), names)
    plt.close("all")
    said = capsys.readouterr().out
    for part in SAID[lesson]:
        assert part in said


SAID = {
    "lesson-1-sampling.ipynb": ("300 N/m: passive", "301 N/m: active", "out: 1.427 mJ", "200 N/m: 0.00 mJ"),
    "lesson-2-friction.ipynb": (
        "active - quantization against Coulomb friction",
        "100 N/m: passive",
        "280 N/m: undecided",
        "400 N/m: active",
    ),
    "lesson-answers.ipynb": (
        "2000 Hz: 600 N/m, 0.2 ms late 312 N/m",
        "0.1 kg: 300.0 N/m, 0.00 mJ came out",
        "'50.0 mm', '0.0 mm'] 12.97 mJ",
        "0.7 mm: sampling against viscous damping, up to 300.0 N/m",
        "0.9 mm: quantization against Coulomb friction, up to 266.7 N/m",
        "Active for some values of its intervals: at damping 0.1304 N·s/m",
        "B = 0.075 N·s/m: 150.0 N/m",
        "PassivityController undecided\nForceBounding passive",
        "this is not emitted, it is active",
    ),
    "lesson-3-laws.ipynb": ("with controller: 0.00 mJ came out", "undecided"),
}
"""What the text between the cells relies on."""
