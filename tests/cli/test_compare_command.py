"""`zwidth compare`: a table, a picture, JSON with units in its keys, and one clear line on bad input."""

import json
from pathlib import Path

import pytest

WALL = "compare haptic-paddle --stiffness 400 --laws"


def test_a_table_and_files(run):
    assert "virtual-damping" in run(f"{WALL} 'wall, virtual-damping' --plot a.png -o a.json").out
    saved = json.loads(Path("a.json").read_text(encoding="utf-8"))
    assert list(saved["laws"]) == ["wall", "virtual-damping"]
    assert saved["laws"]["wall"]["static_stiffness_N_per_m"] == pytest.approx(400, rel=0.05)
    told = run(f"{WALL} passivity-controller-published --fastest '1 m/s' --json").json
    assert told["laws"]["passivity-controller-published"]["status"] == "undecided"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (f"{WALL} wall --fastest fast", "fastest"),
        (f"{WALL} magic", 'no law "magic"'),
        ("compare haptic-paddle --type maxwell --branch-stiffness 3 --branch-damping 1", ""),
    ],
)
def test_bad_input_is_one_line(refused, line, said):
    assert said in refused(line)
