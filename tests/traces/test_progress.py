"""The progress bar: on a terminal, after a second, and nowhere else."""

from __future__ import annotations

import sys

import zwidth.progress as module


class _Terminal:
    def __init__(self, inner) -> None:
        self._inner = inner

    def isatty(self) -> bool:
        return True

    def __getattr__(self, name):
        return getattr(self._inner, name)


def test_nothing_is_drawn_where_nobody_watches(capsys, monkeypatch) -> None:
    monkeypatch.setattr(module, "SHOWN_AFTER", 0.0)
    with module.progress_bar("samples") as tell:
        tell(1, 3)
    assert capsys.readouterr().err == ""


def test_short_work_draws_no_bar(capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "stderr", _Terminal(sys.stderr))
    with module.progress_bar("samples") as tell:
        tell(1, 3)
        tell(3, 3)
    assert "samples" not in capsys.readouterr().err


def test_long_work_draws_a_bar(capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "stderr", _Terminal(sys.stderr))
    monkeypatch.setattr(module, "SHOWN_AFTER", 0.0)
    with module.progress_bar("samples") as tell:
        tell(1, 3)
        tell(2, 3)
    assert "samples" in capsys.readouterr().err
