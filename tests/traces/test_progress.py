"""What is told to people who wait: a bar on a terminal, after a second; a number that falls, of a game."""

from __future__ import annotations

import sys

import pytest

import zwidth as zw
from zwidth import progress


@pytest.mark.parametrize(
    ("watched", "after", "drawn"),
    [(False, 0.0, False), (True, progress.SHOWN_AFTER, False), (True, 0.0, True)],
)
def test_a_bar_is_drawn_of_long_work_where_somebody_watches(
    capsys, monkeypatch, watched: bool, after: float, drawn: bool
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: watched)
    monkeypatch.setattr(progress, "SHOWN_AFTER", after)
    with progress.progress_bar("samples") as tell:
        tell(1, 3)
        tell(3, 3)
    said = capsys.readouterr().err
    assert ("samples" in said) == drawn
    assert watched or said == ""


def test_a_number_that_falls_is_shown_as_progress() -> None:
    """The most there were, less what is left; another board may begin with more."""
    told: list[tuple[int, int]] = []
    tell = progress.falling(lambda done, total: told.append((done, total)))
    for left in (50, 10, 0, 80, 20):
        tell(left)
    assert told == [(0, 50), (40, 50), (50, 50), (0, 80), (60, 80)]


def test_games_and_limits_tell_how_far_they_are() -> None:
    """A `progress` of one's own takes the place of the bar."""
    paddle, wall = zw.catalogue.device("haptic-paddle"), zw.Wall(500, 0.05)
    left: list[int] = []
    zw.available_storage(paddle, wall, penetration="0.0005", speed="0.2", progress=left.append)
    assert left[-1] == 0
    done: list[tuple[int, int]] = []
    zw.limit(paddle, wall, progress=lambda k, total: done.append((k, total)))
    assert [k for k, _ in done] == sorted(k for k, _ in done)
    assert all(k < total for k, total in done)
