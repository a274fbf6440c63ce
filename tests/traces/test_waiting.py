"""What is told to people who wait for a game."""

from __future__ import annotations

import zwidth as zw
from zwidth.progress import falling


def test_a_number_that_falls_is_shown_as_progress() -> None:
    """The most there were, less what is left; another board may begin with more."""
    told: list[tuple[int, int]] = []
    tell = falling(lambda done, total: told.append((done, total)))
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
