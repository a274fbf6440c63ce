"""How long after a move of a slider does the explorer page show another verdict?

    python benchmarks/explorer_latency.py [MOVES]

A browser moves the stiffness of a wall, a move at a time, and waits until the words of the verdict have
changed: the outcome and its claim, and then the numbers with limit and advice.  It needs Chromium.
"""

from __future__ import annotations

import os
import shutil
import statistics
import sys

from playwright.sync_api import Browser, Page, sync_playwright

from zwidth.show.explorer.serving import serve_explorer

MOVE = """async (moves) => {
  const within = (root, selector) => {
    const roots = [root];
    while (roots.length) {
      const one = roots.shift();
      const found = one.querySelector(selector);
      if (found) return found;
      for (const part of one.querySelectorAll("*")) if (part.shadowRoot) roots.push(part.shadowRoot);
    }
  };
  const slider = within(document, '[data-path="environment.stiffness"] [type=range]');
  const verdict = document.querySelector("#verdict");
  const words = (selector) => within(verdict, selector).getRootNode();
  const parts = [words(".claim"), words("table")];
  const changed = (part) => new Promise((done) => {
    const began = performance.now();
    const observer = new MutationObserver(() => { observer.disconnect(); done(performance.now() - began); });
    observer.observe(part, { childList: true, subtree: true, characterData: true });
  });
  const times = [];
  for (let k = 0; k < moves; k += 1) {
    const numbers = changed(parts[1]);
    const other = changed(parts[0]);
    slider.value = k % 2 ? 400 - k % 50 : 600 + k % 50;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    times.push([await other, await numbers]);
    await new Promise((go) => setTimeout(go, 100));
  }
  return times;
}"""


LOOPS = {
    "a spring": "",
    "a damped wall": "?device.damping=0.15 N*s/m&device.coulomb_friction=0.12 N&device.resolution=22.4 um"
    "&device.rate=1 kHz&environment.type=wall&environment.stiffness=130 N/m&environment.damping=0.05 N*s/m",
}
"""What is moved: the loop that the page begins with, and one with more to look for."""


def main() -> None:
    """Print the median and the worst of each loop, and how busy the machine was."""
    moves = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    with serve_explorer() as page, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        for name, loop in LOOPS.items():
            report(name, measured(opened(browser, f"{page.address}{loop}"), moves))
        browser.close()
    print(f"{moves} moves each; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


def opened(browser: Browser, address: str) -> Page:
    """The page, when it has come to rest."""
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(600_000)
    page.goto(address)
    page.locator("#verdict table").wait_for()
    page.wait_for_timeout(3000)
    return page


def measured(page: Page, moves: int) -> list[tuple[float, float]]:
    """Of each move, after how long outcome and numbers had changed [ms]."""
    found: list[tuple[float, float]] = page.evaluate(MOVE, moves)
    return found


def report(name: str, times: list[tuple[float, float]]) -> None:
    """A line for the outcome, a line for the numbers."""
    print(name)
    for what, column in (("outcome", 0), ("limit and advice", 1)):
        found = [one[column] for one in times]
        print(f"  {what:<18} median {statistics.median(found):6.0f} ms   worst {max(found):6.0f} ms")


if __name__ == "__main__":
    main()
