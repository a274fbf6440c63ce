"""What does the page of `zwidth play` weigh and cost, and is what it plays what `zw.simulate` simulates?

    python benchmarks/play_pages.py [--seconds S]

Every loop of the page is played in Chromium for so long, by a pointer that goes to and fro, at the sizes of a
notebook and of a telephone; pictures are counted while it does, and the time
that the page works at each.  What the page recorded is simulated again.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Page, sync_playwright

import zwidth as zw
from zwidth.model.operator import LinearHand, Tracking
from zwidth.show.explorer.play import Played, play_page, presets

SIZES = ({"width": 1280, "height": 800}, {"width": 390, "height": 844})

COLUMNS = ("position", "velocity", "actuator_force", "hand_work", "actuator_work")

COUNT = """seconds => new Promise(done => {
    let pictures = 0;
    const began = performance.now();
    const next = () => {
        pictures += 1;
        const passed = (performance.now() - began) / 1000;
        if (passed < seconds) requestAnimationFrame(next); else done(pictures / passed);
    };
    requestAnimationFrame(next);
})"""
"""Pictures a second."""

WORK = """
window.work = [];
const later = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = told => later(now => {
    const began = performance.now();
    told(now);
    window.work.push(performance.now() - began);
});
"""
"""How long the page works at each picture [ms]."""

RATE = """number => {
    const facts = JSON.parse(document.getElementById("facts").textContent)[number];
    const loop = new engine.Engine(facts, plant, laws[number]);
    const steps = count => {
        for (let k = 0; k < count; k += 1) loop.step(0.3 * facts.reach * Math.sin(0.01 * k), () => {});
    };
    steps(20000);
    const began = performance.now();
    steps(100000);
    return 1e8 / (performance.now() - began);
}"""
"""Samples a second that the engine steps, as fast as it can."""


def played(page: Page, number: int, seconds: float) -> tuple[float, np.ndarray[Any, Any]]:
    """Pictures a second, and the recording, of one loop."""
    page.locator("#loops button").nth(number).click()
    page.locator("#stage").scroll_into_view_if_needed()
    box: Any = page.locator("#stage").bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.5 * box["width"], middle)
    page.mouse.down()
    page.evaluate(f"() => {{ window.counted = ({COUNT})({seconds}); }}")
    began = time.monotonic()
    while (passed := time.monotonic() - began) < seconds:
        part = 0.5 + 0.25 * np.sin(2.5 * passed) + 0.05 * np.sin(17.0 * passed)
        page.mouse.move(box["x"] + part * box["width"], middle)
        page.wait_for_timeout(16)
    pictures = page.evaluate("window.counted")
    with page.expect_download() as download:
        page.locator("#download").evaluate("button => button.click()")
    page.mouse.up()
    with Path(download.value.path()).open(encoding="utf-8", newline="") as file:
        return pictures, np.array(list(csv.reader(file))[1:], dtype=np.float64)


def difference(loop: Played, rows: np.ndarray[Any, Any]) -> float:
    """The largest between what was played and what is simulated, over all columns, SI."""
    assert rows[:, 2].all()
    hand = _tracking(rows[:, 1], loop.hand)
    if len(loop.loop) == 1:
        pair = loop.loop[0]
        follower = _tracking(np.array([loop.start]), loop.follower)
        trace = zw.simulate(pair, hand, follower, (len(rows) - 1) * pair.sample_period / pair.own_readings)
        parts = [trace.sel(arm=arm) for arm in ("leader", "follower")]
    else:
        device, environment = loop.loop
        parts = [zw.simulate(device, environment, hand, (len(rows) - 1) * device.exact("sample_period"))]
    return max(
        float(np.abs(part[name].values - rows[:, 3 + 6 * arm + k]).max())
        for arm, part in enumerate(parts)
        for k, name in enumerate(COLUMNS)
    )


def _tracking(path: np.ndarray[Any, Any], hand: LinearHand) -> Tracking:
    return Tracking(path, stiffness=hand.stiffness, damping=hand.damping, mass=hand.mass)


def main() -> int:
    """The command line; 1 if anything played differs from what is simulated."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=10.0)
    seconds = parser.parse_args().seconds
    began = time.monotonic()
    loops = presets()
    decided = time.monotonic()
    text = play_page(loops).encode()
    print(f"{len(text) / 1e3:.1f} kB; {decided - began:.2f} s for laws and verdicts, ", end="")
    print(f"{time.monotonic() - decided:.2f} s for the page")
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        place = Path(folder) / "play.html"
        place.write_bytes(text)
        path = os.environ.get("CHROMIUM", "/usr/bin/chromium")
        chromium = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        pages = [chromium.new_page(viewport=size) for size in SIZES]
        for page in pages:
            page.add_init_script(WORK)
        heads = ("samples/s", "wide, 1/s", "narrow, 1/s", "work, ms", "samples", "differ by")
        print(f"{'loop':36}" + "".join(f" {head:>11}" for head in heads))
        for number, loop in enumerate(loops):
            shown = []
            for page in pages:
                page.bring_to_front()
                page.goto(place.as_uri())
                pictures, rows = played(page, number, seconds)
                worst = max(worst, difference(loop, rows))
                shown.append(pictures)
            work = float(np.median([row for page in pages for row in page.evaluate("window.work")]))
            rate = pages[0].evaluate(RATE, number)
            figures = (
                f"{rate:.0f}",
                *(f"{pictures:.1f}" for pictures in shown),
                f"{work:.1f}",
                str(len(rows)),
                f"{worst:.2g}",
            )
            print(f"{loop.name:36}" + "".join(f" {figure:>11}" for figure in figures), flush=True)
        chromium.close()
    return int(worst > 0.0)


if __name__ == "__main__":
    sys.exit(main())
