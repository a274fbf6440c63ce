"""Where the library comes from, and what there is without one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from zwidth.loop.kernel import packed_plant
from zwidth.loop.plant import free_response
from zwidth.machine.servo.cycle import put_at_rest
from zwidth.native import build

MOTIONS = """
import sys, hashlib
import numpy as np
from zwidth.native import build, library
if sys.argv[1] == "plain":
    build.library = library.library = lambda: None
import zwidth as zw
from zwidth.study.bench.bench import standard_laws

device = zw.Device(
    mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=22.4e-6, rate=1000, delay="0.3 ms",
    force_limit=9,
)
for name, law in standard_laws(device, zw.Wall(600)).items():
    for hand in (zw.operators.Dowel(), zw.operators.Finger()):
        trace = zw.simulate(device, law, hand, 0.05)
        seen = [np.ravel(v.values) for v in trace.data_vars.values() if v.dtype.kind == "f"]
        print(name, hashlib.sha256(np.concatenate(seen).tobytes()).hexdigest())
"""


needs_library = pytest.mark.skipif(build.library() is None, reason="no library of step functions here")


def ran(how: str) -> str:
    command = [sys.executable, "-c", MOTIONS, how]
    return subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True).stdout


@needs_library
def test_without_the_library_python_gives_the_same_bits() -> None:
    assert len(ran("library").splitlines()) > 40
    assert ran("library") == ran("plain")


def test_a_call_gives_back_what_the_annotations_say() -> None:
    assert packed_plant(np.arange(9.0)) == packed_plant.py_func(np.arange(9.0))
    assert free_response(2.0, 0.25) == free_response.py_func(2.0, 0.25)


@needs_library
@pytest.mark.parametrize(
    ("given", "says"),
    [((np.zeros(9, kind),), "takes an array of <f8 here") for kind in (int, np.float32)] + [((), "argument")],
)
def test_what_it_does_not_take_is_an_error_of_python(given: tuple[object, ...], says: str) -> None:
    """An array of other numbers, copied silently, would be the copy that is changed."""
    with pytest.raises(TypeError, match=says):
        packed_plant(*given)


def test_a_column_is_taken_and_changed_as_it_is() -> None:
    """Of a table only rows lie one number behind the other."""
    table = np.arange(27.0).reshape(9, 3)
    assert packed_plant(table[:, 1]) == packed_plant(table[:, 1].copy())
    lines = np.ones((2, 2, 9))
    put_at_rest(table[:, 1], lines, 4.0)
    assert (table[:, 1] == 5.0).all()
    assert (table[:, 0] == np.arange(0.0, 27.0, 3.0)).all()


@pytest.mark.parametrize(
    ("is_checkout", "compiler", "told"),
    [
        (True, None, r"as plain Python.*there is no C compiler"),
        (False, build.compiler(), "; a C compiler"),
        (True, [sys.executable, "-c", "raise SystemExit('no such thing')"], "no such thing"),
    ],
    ids=["no compiler", "installed", "a compiler that fails"],
)
def test_without_a_library_it_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, is_checkout: bool, compiler: list[str] | None, told: str
) -> None:
    monkeypatch.setattr(build, "BUILT", tmp_path / "steps.so")
    monkeypatch.setattr(build, "_is_checkout", lambda: is_checkout)
    monkeypatch.setattr(build, "compiler", lambda: compiler)
    with pytest.warns(RuntimeWarning, match=told):
        assert build._library.__wrapped__() is None
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(
    build.compiler() is None or not build._is_checkout(), reason="no checkout, or no C compiler"
)
def test_a_checkout_builds_anew_what_has_changed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(build, "BUILT", tmp_path / "steps.so")
    assert build._library.__wrapped__() is not None
    assert "built anew" in capsys.readouterr().err
    assert build._library.__wrapped__() is not None
    assert capsys.readouterr().err == ""
    os.utime(tmp_path / "steps.so", ns=(0, 0))  # older than its sources, which are those that it was made of
    assert build._library.__wrapped__() is not None
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(build, "digest", lambda sources: "another")
    assert build._is_old(build._opened(tmp_path / "steps.so").table)
