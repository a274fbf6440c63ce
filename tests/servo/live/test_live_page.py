"""A running loop in the browser: the page, and what each of its viewers is sent."""

import re
import sys
import time
from socket import create_connection
from urllib.parse import urlsplit
from urllib.request import urlopen

import numpy as np
import pytest
from bokeh.client import pull_session
from bokeh.document import Document
from bokeh.models import ColumnDataSource, Div, Plot, Toggle
from live_rows import WrittenRows
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from zwidth.errors import InputError
from zwidth.machine.servo.live.browser import SPANS, Shown, make_document, open_page
from zwidth.machine.servo.live.page import HOST
from zwidth.machine.servo.live.rows import CURVES, Envelope, Tally, Watched

HANGS = 6000
"""So many looks without what was waited for: it does not come any more."""


def waited(condition):
    for _ in range(HANGS):
        if condition():
            return True
        time.sleep(0.01)
    return False


def buzzing(count=40000, **more):
    t = np.arange(count) * 1e-3
    x = 0.004 * np.sin(t) + 0.0005 * np.sin(2 * np.pi * 331 * t)
    return WrittenRows(np.arange(float(count)), **{"position_m": x, "late_s": 2e-4, **more})


class Loop:
    """Rows, and what the page's reader makes of them."""

    def __init__(self, rows, surface=0.0):
        self.rows, self._watched = rows, Watched(rows)
        self.shown = Shown(rows, Envelope(len(CURVES), SPANS), Tally(rows), surface, 0.05)

    def runs(self, count):
        self.rows.count = count
        news = self._watched.news()
        self.shown.tally.add(news)
        self.shown.envelope.add(news.times, news.curves)
        return self


class Viewer:
    """A page in a browser, but for the browser: the document, and what the browser would say to it."""

    def __init__(self, loop):
        self.document = Document()
        make_document(self.document, loop.shown)

    def look(self, frames=1):
        for _ in range(frames):
            for frame in self.document.session_callbacks:
                frame.callback()
        return {name: np.asarray(values) for name, values in self.one(ColumnDataSource).data.items()}

    def one(self, kind):
        return self.document.select_one({"type": kind})

    def says(self):
        """That it has drawn all it was sent."""
        self.one(Div).tags = [int(self.one(ColumnDataSource).data["number"][-1])]


@pytest.fixture
def loop():
    return Loop(buzzing()).runs(6000)


@pytest.fixture
def page():
    rows = buzzing()
    rows.count = 6000
    with open_page(rows, open_browser=False) as page:
        assert waited(lambda: rows.asked > 1)
        yield page


def spans(rows, name, data):
    """The numbers of a column that belong to each point of a graph: of a hundredth of a second each."""
    of = np.rint(data["time"] / 0.01 - 0.5)
    mine = np.floor(rows.column("time_s") / 0.01)
    return [rows.column(name)[mine == n] for n in of]


def test_nothing_comes_from_elsewhere(page):
    """What the page loads is on this machine, and is there; an icon may be missing."""
    text = urlopen(page.address).read().decode()
    assert not re.findall(r"""(?:src|href)=["'](?:https?:)?//""", text)
    named = re.findall(r"""(?:src|href)=["']([^"'#]+)["']""", text)
    loaded = [path for path in named if not path.endswith(".ico")]
    assert loaded
    assert all(urlopen(page.address + path.lstrip("/")).status == 200 for path in loaded)


def test_a_viewer_is_sent_what_the_loop_has_written(page):
    session = pull_session(url=page.address)
    source = session.document.select_one({"type": ColumnDataSource})
    assert len(source.data["time"]) == 599
    session.close()


def test_lowest_and_highest_of_every_curve_are_shown(loop):
    data = Viewer(loop).look()
    assert len(data["time"]) == 599
    for curve, name, scale in ((0, "position_m", 1e3), (2, "force_N", 1.0), (3, "energy_out_J", 1e3)):
        parts = spans(loop.rows, name, data)
        np.testing.assert_allclose(data[f"low_{curve}"], [scale * p.min() for p in parts], rtol=1e-12)
        np.testing.assert_allclose(data[f"high_{curve}"], [scale * p.max() for p in parts], rtol=1e-12)
    assert (data["high_0"] - data["low_0"]).min() > 0.7  # of 1 mm


def test_a_missed_deadline_is_marked():
    samples = np.arange(6000.0)
    samples[3000:] += 2
    data = Viewer(Loop(WrittenRows(samples, late_s=2e-5)).runs(6000)).look()
    marked = np.isfinite(data["missed"])
    assert data["missed"][marked] == pytest.approx([2020.0])
    assert data["time"][marked] == pytest.approx([3.005])
    assert data["late"][~marked] == pytest.approx(20.0)


def test_what_is_never_late_is_still_on_the_axis():
    data = Viewer(Loop(WrittenRows(np.arange(200.0), late_s=0.0)).runs(200)).look()
    assert set(data["late"]) == {0.1}


def test_what_comes_is_added_and_what_is_old_is_left_out(loop):
    viewer = Viewer(loop)
    for count in range(6000, 40001, 50):
        loop.runs(count)
        data = viewer.look()
        viewer.says()
    assert len(data["time"]) == SPANS
    assert np.diff(data["time"]) == pytest.approx(0.01)
    assert data["time"][-1] == pytest.approx(39.985)


def test_a_viewer_that_says_nothing_is_sent_three_pictures(loop):
    """A browser that sleeps fills no memory here; awake again it is sent what is new."""
    viewer, sent = Viewer(loop), []
    for count in range(6000, 30001, 50):
        loop.runs(count)
        sent.append(viewer.look()["time"][-1])
    assert len(set(sent)) == 1 + 3  # what came with the page, and these
    viewer.says()
    assert viewer.look()["time"][-1] == pytest.approx(29.985)


def test_pause_stops_one_viewer_alone(loop):
    viewer, other = Viewer(loop), Viewer(loop)
    button = viewer.one(Toggle)
    button.active = True
    still = viewer.look()["time"][-1]
    loop.runs(20000)
    assert viewer.look()["time"][-1] == still
    assert other.look()["time"][-1] == pytest.approx(19.985)
    button.active = False
    assert viewer.look()["time"][-1] == pytest.approx(19.985)
    loop.runs(20100)
    assert viewer.look()["time"][-1] == pytest.approx(20.085)
    assert np.diff(viewer.look()["time"]) == pytest.approx(0.01)


def test_four_graphs_over_one_time(loop):
    figures = list(Viewer(loop).document.select({"type": Plot}))
    labels = {figure.yaxis[0].axis_label for figure in figures}
    assert labels == {"position [mm]", "force [N]", "energy [mJ]", "lateness [µs]"}
    assert len({figure.x_range.id for figure in figures}) == 1


def test_the_words_are_text_of_the_page(loop):
    viewer = Viewer(loop)
    assert "a paddle &lt;b&gt;in a wall&lt;/b&gt;" in viewer.one(Div).text
    assert "serving, law 1 · at 6.0 s" in viewer.one(Div).text
    loop.runs(8000)
    viewer.look(frames=10)
    assert "serving, law 1 · at 8.0 s" in viewer.one(Div).text


@pytest.mark.parametrize("surface", [0.003, None])
def test_the_wall_is_shaded_from_its_surface_on(surface):
    wall = Viewer(Loop(buzzing(), surface).runs(100)).document.select_one({"name": "wall"})
    assert (wall is None) if surface is None else wall.bottom == pytest.approx(3.0)


def test_rotary_devices_have_their_units():
    viewer = Viewer(Loop(WrittenRows(np.arange(100.0), motion="rotary", force_N_m=0.25)).runs(100))
    labels = {figure.yaxis[0].axis_label for figure in viewer.document.select({"type": Plot})}
    assert labels > {"position [mrad]", "force [mN·m]"}
    assert viewer.look()["high_2"] == pytest.approx(250.0)


def test_a_loop_that_has_not_begun_has_a_page():
    loop = Loop(buzzing())
    viewer = Viewer(loop.runs(0))
    assert len(viewer.look()["time"]) == 0
    loop.runs(100)
    assert len(viewer.look()["time"]) == 9


def test_pages_of_others_are_refused(page):
    """A page that another site serves gets no rows, although the person's browser could reach them."""
    found = re.search(r'"token":"([^"]+)"', urlopen(page.address).read().decode())
    assert found
    protocols = ["bokeh", found[1]]
    address = page.address.replace("http", "ws") + "ws"
    with pytest.raises(InvalidStatus):
        connect(address, origin="http://elsewhere.example", subprotocols=protocols)
    # a name that comes to mean this machine: of the same origin, and told by its Host alone
    foreign = address.replace("127.0.0.1", "elsewhere.example")
    for asked in (foreign, address.replace("ws://127.0.0.1", "ws://127.0.0.2")):
        with (
            create_connection((HOST, urlsplit(address).port)) as stream,
            pytest.raises(InvalidStatus, match="421"),
        ):
            connect(asked, sock=stream, origin="http://" + urlsplit(asked).netloc, subprotocols=protocols)
    with connect(address, origin=page.address.rstrip("/"), subprotocols=protocols) as socket:
        assert "ACK" in socket.recv(timeout=60)


def test_a_loop_that_cannot_be_read_ends_the_graphs_and_nothing_else(caplog, monkeypatch):
    rows = buzzing()
    rows.count = 6000

    def failing(_):
        raise RuntimeError("gone")

    with open_page(rows, open_browser=False) as page:
        monkeypatch.setattr(rows, "after", failing)
        assert waited(lambda: "a live graph has ended" in caplog.text)
        assert urlopen(page.address).status == 200


def test_a_port_in_use_is_refused(page):
    port = int(page.address.rstrip("/").rpartition(":")[2])
    with pytest.raises(InputError, match="give another one, or 0"):
        open_page(buzzing(), port, open_browser=False)
    page.close()
    page.close()
    open_page(buzzing(), port, open_browser=False).close()


def test_without_bokeh_it_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "bokeh.application", None)
    with pytest.raises(InputError, match=r"terminal, or type: .*install .*\[serve\]"):
        open_page(buzzing(), open_browser=False)


def test_the_browser_is_opened_if_asked(monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    with open_page(buzzing()) as page:
        assert opened == [page.address]
