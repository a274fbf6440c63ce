"""A running loop in the terminal."""

import unicodedata
from io import StringIO
from threading import Event

import numpy as np
import pytest
from live_rows import WrittenRows
from rich.console import Console

from zwidth.machine.servo.live.terminal import cells, watch_in_terminal

DOT = {"1": (0, 0), "2": (1, 0), "3": (2, 0), "7": (3, 0), "4": (0, 1), "5": (1, 1), "6": (2, 1), "8": (3, 1)}


def dots(codes):
    """The dots of a picture, by the names that Unicode gives its characters."""
    picture = np.zeros((4 * codes.shape[0], 2 * codes.shape[1]), bool)
    for (line, column), code in np.ndenumerate(codes):
        for dot in unicodedata.name(chr(code)).partition("DOTS-")[2]:
            down, across = DOT[dot]
            picture[4 * line + down, 2 * column + across] = True
    return picture


class Ending(WrittenRows):
    """Rows that come in parts; after so many looks the watcher is told to stop."""

    def __init__(self, stop, looks, **columns):
        super().__init__(np.arange(4000.0), **columns)
        self._stop, self._looks = stop, looks

    def after(self, count):
        self.count = min(len(self.table), 2000 * (self.asked + 1))
        if self.asked + 1 >= self._looks:
            self._stop.set()
        return super().after(count)


def terminal(**more):
    kind = {"force_terminal": True, "width": 90, "height": 40, "color_system": None}
    return Console(file=StringIO(), **{**kind, **more})


def watched(console, looks=3, **columns):
    stop = Event()
    watch_in_terminal(Ending(stop, looks, **columns), stop, console)
    return console.file.getvalue()


def test_a_curve_is_where_its_numbers_are():
    """Each column of dots from its lowest to its highest; nothing where there is no number."""
    low = np.array([0.0, 1.0, 3.0, np.nan, 6.0, 6.0])
    high = np.array([0.0, 2.0, 5.0, np.nan, 7.0, 6.0])
    picture = dots(cells(low, high, 2, 0.0, 7.0))
    assert picture.shape == (8, 6)
    reached = [set(np.flatnonzero(column[::-1])) for column in picture.T]
    assert reached == [{0}, {0, 1, 2}, {2, 3, 4, 5}, set(), {6, 7}, {6}]  # they join on


def test_the_graphs_have_their_names_units_and_ranges():
    wished = 8 * np.sin(np.arange(4000) * 0.01)
    columns = {"wished_force_N": wished, "force_N": np.clip(wished, -5, 5), "position_m": wished * 1e-3}
    text = watched(terminal(), **columns)
    graphs = ("position [mm]", "force [N]", "energy [mJ]", "lateness [µs]")
    assert all(part in text for part in (*graphs, "━ asked for", "━ given", "━ margin"))
    assert "serving, law 1 · at 4.0 s" in text
    frame = text.split("position [mm]")[-1].split("force [N]")[0].splitlines()[1:]
    graph = [line.partition("│")[0].strip() for line in frame]
    assert (float(graph[0]), float(graph[-2] or graph[-1])) == (8, -8)


def test_a_low_terminal_leaves_out_the_last_graphs():
    text = watched(terminal(width=100, height=13))
    assert "position [mm]" in text
    assert "force [N]" in text
    assert "lateness [µs]" not in text
    assert "deadlines missed" in text


@pytest.mark.parametrize(("width", "height"), [(1, 1), (5, 3), (300, 100)])
def test_any_size_is_drawn(width, height):
    assert watched(terminal(width=width, height=height))


def test_where_there_is_no_terminal_lines_come():
    lines = watched(terminal(force_terminal=False, width=20), looks=1).splitlines()
    assert len(lines) == 2  # one, and one at the end
    assert all(line.startswith("serving, law 1 · at ") and line.endswith(" missed") for line in lines)


def test_what_is_served_is_shown_and_not_obeyed():
    console, stop = terminal(), Event()
    rows = Ending(stop, 3)
    rows.title = "a wall \x1b]0;renamed\x07 [bold]here[/bold]"
    watch_in_terminal(rows, stop, console)
    text = console.file.getvalue()
    assert "\x1b]0;" not in text
    assert "[bold]here[/bold]" in text


def test_nobody_reads_any_more():
    class Gone(StringIO):
        def write(self, text):
            stop.set()
            raise BrokenPipeError

    stop = Event()
    stop.set()
    watch_in_terminal(Ending(stop, 1), stop, Console(file=Gone(), force_terminal=False))
