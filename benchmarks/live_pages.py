"""Is an hour of live graphs dearer at its end than at its beginning, and what do they cost at all?

    python benchmarks/live_pages.py [--minutes 60] [--speed 10] [--viewers 2]
    python benchmarks/live_pages.py --picture docs/_static/live.png

Rows of a loop at 1 kHz come `speed` times as fast as they would.  First, 20 pictures for each second of them
are put into a page that nobody draws.  Then a process of its own serves them, pictures as often as pages take
them: they are looked at in Chromium, which playwright drives (pip install playwright; CHROMIUM names the
program if it is not /usr/bin/chromium), and read over the WebSocket of Foxglove.

Printed are, every tenth of the way, the memory of what serves, that of the scripts in a page after their
garbage was collected, the points that the page holds and how far it is behind; then pictures, bytes, time and
what grew in the second half.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing as mp
import os
import struct
import sys
import threading
import time
from io import BytesIO
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.models import Div
from PIL import Image
from PIL.PngImagePlugin import PngInfo
from playwright.sync_api import Page, sync_playwright
from websockets.sync.client import connect

from zwidth.machine.servo.live import open_page, serve_foxglove
from zwidth.machine.servo.live.browser import SPANS, Shown, make_document
from zwidth.machine.servo.live.rows import CURVES, Envelope, Tally, Watched

RATE = 1000.0
FRAME = 0.05
KEPT = 16384
SIZE: Any = {"width": 1000, "height": 700}


class FastRows:
    """A hand that goes into a wall with a buzz and out again, `speed` times as fast as it would."""

    COLUMNS = (
        "sample", "time_s", "late_s", "position_m", "wished_force_N", "force_N", "energy_out_J",
        "friction_loss_J", "status", "phase", "law", "limited", "exchange_s",
    )  # fmt: skip

    def __init__(self, speed: float, began: float) -> None:
        self.period, self.motion = 1 / RATE, "linear"
        self.title = "A paddle in a wall of 2 N/mm, as a script moves it"
        self._speed, self._began = speed, began

    @property
    def count(self) -> int:
        """Rows so far."""
        return int((time.monotonic() - self._began) * self._speed * RATE)

    def after(self, count: int) -> tuple[int, np.ndarray[Any, Any]]:
        """As of a loop."""
        return self.written(count, self.count)

    def written(self, count: int, written: int) -> tuple[int, np.ndarray[Any, Any]]:
        """Those after `count` of so many."""
        i = np.arange(max(count, written - KEPT), written, dtype=float)
        k = i + 3 * np.floor(i / 7000)  # three deadlines are missed every seven seconds
        t = k * self.period
        x = 0.006 * np.sin(np.pi * t) + 2e-4 * np.sin(2 * np.pi * 180 * t) * (np.sin(np.pi * t) > 0)
        wished = np.where(x > 0, 2000 * x, 0.0)
        late = 5e-6 * np.exp(0.8 * np.sin(k * k))
        out, loss = -1000 * np.maximum(x, 0) ** 2, 0.1 * 0.012 * t  # 0.1 N of friction at 12 mm/s
        none = np.zeros_like(t)
        seen = [k, t + late, late, x, wished, np.minimum(wished, 10), out, loss]
        return written, np.column_stack([*seen, none, none + 2, none, none, none + 4e-5])


class Counted(FastRows):
    """The same by the number of looks, not by the clock."""

    looks = 0

    @property
    def count(self) -> int:
        """A picture more at each look."""
        self.looks += 1
        return round(self.looks * FRAME * RATE)


def memory(process: int) -> float:
    """Resident [MB]."""
    with open(f"/proc/{process}/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def spent(process: int) -> float:
    """Time of the processor that a process has used [s]."""
    with open(f"/proc/{process}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def fill(minutes: float) -> None:
    """Every picture of a viewer that takes all of them, and draws none."""
    rows = Counted(1, 0)
    watched, document = Watched(rows), Document()
    shown = Shown(rows, Envelope(len(CURVES), SPANS), Tally(rows), 0.0, FRAME)
    make_document(document, shown)
    words = document.select_one({"type": Div})
    pictures = round(minutes * 60 / FRAME)
    began, found = time.process_time(), []
    for picture in range(pictures + 1):
        news = watched.news()
        shown.tally.add(news)
        shown.envelope.add(news.times, news.curves)
        for frame in document.session_callbacks:
            frame.callback()
        words.tags = [SPANS * 1000]  # it has them all
        if picture % max(pictures // 10, 1) == 0:
            found.append(memory(os.getpid()))
    took = (time.process_time() - began) / pictures
    print(
        f"{pictures} pictures into a page: {' '.join(f'{m:.1f}' for m in found)} MB, {1e3 * took:.2f} ms each"
    )


def serve(speed: float, began: float, said: Any) -> None:
    """A process that serves, until it is told to end."""
    rows = FastRows(speed, began)
    with open_page(rows, open_browser=False, frame=FRAME / speed) as page, serve_foxglove(rows, 0) as stream:
        said.send((page.address, stream.address))
        said.recv()


class Browser:
    """One viewer: what came, and what its page holds."""

    def __init__(self, page: Page, address: str) -> None:
        self._page = page
        self.bytes = self.pictures = 0
        self.complaints: list[str] = []
        page.on("websocket", lambda socket: socket.on("framereceived", self._received))
        page.on("console", lambda said: self.complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.goto(address)
        page.wait_for_function("window.Bokeh && Bokeh.documents.length && Bokeh.documents[0].is_idle")
        self._tools = page.context.new_cdp_session(page)

    def _received(self, frame: str | bytes) -> None:
        self.bytes += len(frame)
        self.pictures += isinstance(frame, str) and '"ColumnsStreamed"' in frame

    def heap(self) -> float:
        """Of the scripts [MB]."""
        self._tools.send("HeapProfiler.collectGarbage")
        return float(self._tools.send("Runtime.getHeapUsage")["usedSize"]) / 1e6

    def held(self) -> tuple[int, float]:
        """Points that the page holds, and the time of the newest [s]."""
        code = """() => { for (const model of Bokeh.documents[0]._all_models.values())
            if (model.type === "ColumnDataSource" && model.data.time)
                return [model.data.time.length, model.data.time[model.data.time.length - 1]] }"""
        points, newest = self._page.evaluate(code)
        return int(points), float(newest)

    def wait(self, seconds: float) -> None:
        """Let it go on."""
        self._page.wait_for_timeout(1e3 * seconds)


class Follower(threading.Thread):
    """A reader of Foxglove's WebSocket that counts."""

    def __init__(self, address: str) -> None:
        super().__init__(daemon=True)
        self._address = address
        self.messages = self.bytes = self.gaps = 0
        self.start()

    def run(self) -> None:
        """Until the server ends."""
        with connect(self._address, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:  # type: ignore[list-item]
            last = None
            for said in socket:
                if isinstance(said, str):
                    for channel in json.loads(said).get("channels", []):
                        if channel["encoding"] == "cdr":
                            asked = [{"id": 1, "channelId": channel["id"]}]
                            socket.send(json.dumps({"op": "subscribe", "subscriptions": asked}))
                    continue
                self.messages, self.bytes = self.messages + 1, self.bytes + len(said)
                (sample,) = struct.unpack_from("<d", said, 13 + 4)
                self.gaps += last is not None and sample - last not in (1.0, 4.0)
                last = sample


def watch(minutes: float, speed: float, viewers: int) -> int:
    """Print what browsers and what serves them need; 1 if that grew, or a page complained."""
    began = time.monotonic()
    ours, theirs = mp.Pipe()
    server = mp.get_context("spawn").Process(target=serve, args=(speed, began, theirs))
    server.start()
    assert server.pid is not None
    address, stream = ours.recv()
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(**chosen())
        browsers = [Browser(chromium.new_page(viewport=SIZE), address) for _ in range(viewers)]
        follower = Follower(stream)
        print(f"{'loop time':>10} {'served by':>10} {'page':>8} {'points':>7} {'behind':>8}")
        print(f"{'min':>10} {'MB':>10} {'MB':>8} {'':>7} {'s':>8}")
        start, used = time.monotonic(), spent(server.pid)
        found: list[tuple[float, float]] = []
        for step in range(11):
            while (time.monotonic() - start) * speed < minutes * 60 * step / 10:
                browsers[0].wait(0.2)
            found.append((memory(server.pid), browsers[0].heap()))
            points, newest = browsers[0].held()
            now = (time.monotonic() - began) * speed
            row = f"{now / 60:10.1f} {found[-1][0]:10.1f} {found[-1][1]:8.1f} {points:7d} {now - newest:8.2f}"
            print(row, flush=True)
        took, used = time.monotonic() - start, spent(server.pid) - used
        for i, browser in enumerate(browsers):
            print(
                f"viewer {i}: {browser.pictures} pictures, {browser.pictures / took:.1f} a second, "
                f"{browser.bytes / max(browser.pictures, 1) / 1e3:.1f} kB each; "
                f"complaints: {browser.complaints}"
            )
        print(
            f"Foxglove: {follower.messages} messages, {follower.gaps} gaps, "
            f"{follower.bytes / max(follower.messages, 1):.0f} bytes each"
        )
        print(f"what serves used {100 * used / took:.0f} % of a processor, at {speed:g} times the speed")
        chromium.close()
    ours.send(None)
    server.join()
    half = len(found) // 2  # by then everything has been used once
    grown = [found[-1][i] - found[half][i] for i in (0, 1)]
    print(f"in the second half what serves grew by {grown[0]:.1f} MB, the page by {grown[1]:.1f} MB")
    return int(max(grown) > 5 or any(browser.complaints for browser in browsers))


def picture(path: str) -> int:
    """Write what a viewer sees after twelve seconds, for the docs."""
    rows = FastRows(1, time.monotonic())
    with open_page(rows, open_browser=False) as page, sync_playwright() as playwright:
        chromium = playwright.chromium.launch(**chosen())
        browser = chromium.new_page(viewport=SIZE)
        browser.goto(page.address)
        while rows.count < 12 * RATE:
            browser.wait_for_timeout(100)
        seen = browser.screenshot()
        chromium.close()
    about = PngInfo()
    about.add_text("Command", "python benchmarks/live_pages.py --picture docs/_static/live.png")
    about.add_text(
        "Words", json.dumps(CURVES)
    )  # by which `docs/pictures.py --check` knows whether it is stale
    Image.open(BytesIO(seen)).save(path, pnginfo=about)
    return 0


def chosen() -> Any:
    """Which Chromium, and how."""
    return {
        "executable_path": os.environ.get("CHROMIUM", "/usr/bin/chromium"),
        "args": ["--no-sandbox"],
    }


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--speed", type=float, default=10.0)
    parser.add_argument("--viewers", type=int, default=2)
    parser.add_argument("--picture", metavar="FILE", help="write a picture of the page instead")
    given = parser.parse_args()
    if given.picture:
        return picture(given.picture)
    fill(given.minutes)
    return watch(given.minutes, given.speed, given.viewers)


if __name__ == "__main__":
    sys.exit(main())
