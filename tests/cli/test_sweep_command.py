"""`zwidth sweep`: report, JSON, picture and files, and one clear line on bad input."""

from pathlib import Path

import zwidth as zw

SWEEP = "sweep haptic-paddle --vary stiffness=50:600:12 --vary 'delay=0:2 ms:5' --workers 1"


def test_the_report_and_the_json_say_the_same(run):
    """As `zw.sweep` has it: so many loops of each outcome, where they are, and what that means."""
    report = run(SWEEP).out
    document = run(f"{SWEEP} --json").json
    vary = {"stiffness": (50, 600, 12), "delay": "0:2 ms:5"}
    found = zw.sweep(zw.catalogue.device("haptic-paddle"), zw.Wall(1), vary=vary)
    passive = int((found.outcome == "passive").sum())
    assert document["outcomes"] == {"active": 60 - passive, "passive": passive}
    assert document["loops"] == 60
    assert document["axes"]["delay_s"] == [0, 0.0005, 0.001, 0.0015, 0.002]
    assert document["numbers"]["max_stiffness_N_per_m"]["largest"] == 300
    assert document["scope"]["hands"] == {"which": "every"}
    assert f"passive     {passive}" in report
    assert "60 loops: stiffness 50 N/m to 600 N/m, 12 values; delay 0 s to 2 ms, 5 values" in report
    assert "by closed forms" in report


def test_hands_that_are_known(run, refused):
    """Of each so many loops that come to rest, in the report and as JSON; of another question refused."""
    few = "sweep haptic-paddle --vary stiffness=100,3000 --hands none,finger --workers 1"
    run(few).says("with finger", "dry friction and encoder steps left out")
    assert run(f"{few} --json").json["stability"]["none"] == {"stable": 1, "unstable": 1}
    assert "--hands is of check" in refused(f"{few} --of limit")


def test_a_table_and_a_picture(run, refused):
    """Both are written, and said to be; the same command again finds the table whole."""
    table, command = Path("sweep.parquet"), f"{SWEEP} -o sweep.parquet --plot sweep.svg"
    told = [line for line in run(command).out.splitlines() if "written" in line]
    assert told == ["written: sweep.parquet", "written: sweep.svg"]
    before = table.read_bytes()
    assert "sweep.svg exists" in refused(command)
    run(f"{command} --force")
    assert table.read_bytes() == before
    assert not Path("sweep.parquet.begun").exists()
    assert zw.load_sweep(table).sizes == {"stiffness": 12, "delay": 5}


def test_other_questions(run):
    """A limit of one parameter over another, and a pair whose link is late."""
    paddle = "sweep haptic-paddle --workers 1"
    of_limit = f"{paddle} --stiffness 100 --of limit --vary damping=0.1,0.2 --tolerance 0.1"
    assert "proved passive" in run(f"{of_limit} --plot limit.png").out
    of_pair = f"{paddle} --of pair --stiffness 50 --vary 'link-delay=0, 9 ms'"
    assert run(f"{of_pair} --json").json["axes"] == {"link_delay_s": [0, 0.009]}


def test_a_law_of_the_command_line_gets_its_number(run):
    """What is varied need not be given, of a law in a chain either; of `limit` and `simulate` as well."""
    law = "--stiffness 200 --law damper --vary 'law.damping=10:20 mN*s/m:2'"
    for more in ("", "--of limit", "--of simulate --operator dowel --duration '5 ms'"):
        found = run(f"sweep haptic-paddle {law} --workers 1 --json {more}").json
        assert found["axes"] == {"law.damping_N_s_per_m": [0.01, 0.02]}


def test_what_was_finished_is_kept(run, monkeypatch):

    def stop(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("zwidth.study.sweeps.run.sweep", stop)
    assert "the same command goes on" in " ".join(run(f"{SWEEP} -o s.zarr", 130).err.split())
