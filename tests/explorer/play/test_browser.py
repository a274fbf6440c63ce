"""The page in a browser: held by a pointer and by keys, heard, recorded, read by those who do not see it."""

from __future__ import annotations

import csv
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import NARROW, PATIENCE, WIDE, complaints_of_access
from explorer.play.engines import Array, simulated
from playwright.sync_api import Browser, Page

import zwidth as zw
from zwidth.show.explorer.play import Played, play_page
from zwidth.show.explorer.play import played as play
from zwidth.show.explorer.play import played_pair as play_pair
from zwidth.show.explorer.play.presets import LIGHT

_LISTEN = """
window.heard = [];
const start = AudioBufferSourceNode.prototype.start;
AudioBufferSourceNode.prototype.start = function (...given) {
    window.heard.push(...this.buffer.getChannelData(0));
    return start.apply(this, given);
};
"""


@pytest.fixture(scope="module")
def loops() -> list[Played]:
    calm = zw.Device(mass=0.036, damping=0.15, coulomb_friction=0.12, resolution=22.4e-6, rate=1000)
    rough = calm.replace(damping=0.1, coulomb_friction=0.01, resolution=3e-4, force_limit=5)
    return [
        play(calm, zw.Wall(300), name="calm"),
        play(rough, zw.Wall(1500, 10), name="rough", hand=LIGHT),
        play_pair(zw.Pair(calm, calm, stiffness=60, delay=0.004), name="arms", hand=LIGHT),
    ]


@pytest.fixture(scope="module")
def address(loops: list[Played], tmp_path_factory: pytest.TempPathFactory) -> str:
    place = tmp_path_factory.mktemp("page") / "play.html"
    place.write_text(play_page(loops), encoding="utf-8")
    return place.as_uri()


_FRAMES = "n => new Promise(done => { const go = () => n-- > 0 ? requestAnimationFrame(go) : done(); go(); })"


def _frames(page: Page, count: int) -> None:
    """Wait for so many pictures of the page, of a sixtieth of a second at least in the loop's own time."""
    page.evaluate(_FRAMES, count)


def _stroke(page: Page, parts: list[float], release: bool = False) -> None:
    box: Any = page.locator("#stage").bounding_box()
    page.mouse.move(box["x"] + parts[0] * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    for part in parts:
        page.mouse.move(box["x"] + part * box["width"], box["y"] + 0.5 * box["height"])
        _frames(page, 2)
    if release:
        page.mouse.up()


def _recording(page: Page) -> tuple[list[str], Array]:
    with page.expect_download() as download:
        page.locator("#download").evaluate("button => button.click()")  # the pointer may hold the handle
    with Path(download.value.path()).open(encoding="utf-8", newline="") as file:
        heads, *rows = csv.reader(file)
    return heads, np.array(rows, dtype=np.float64)


one_size = pytest.mark.parametrize("page", [WIDE], indirect=True, ids=["1280x800"])
"""For what a smaller screen does not change."""


@pytest.mark.parametrize(
    ("page", "number"), [(WIDE, 1), (NARROW, 2)], ids=["1280x800-rough", "390x844-arms"], indirect=["page"]
)
def test_what_a_person_did_is_simulated_to_the_bit(
    page: Page, address: str, loops: list[Played], number: int
) -> None:
    """The recorded pointer, as the path of the same hand of `zw.simulate`: the same motion and energies."""
    page.goto(address)
    page.locator("#loops button").nth(number).click()
    _stroke(page, [0.5, 0.4, 0.35, 0.5, 0.6, 0.62, 0.7, 0.71, 0.55, 0.66, 0.75, 0.75])
    heads, rows = _recording(page)
    assert heads[:3] == ["time_s", "pointer_m", "held"]
    assert len(heads) == (15 if number == 2 else 9) == rows.shape[1]
    assert len(rows) > 250
    assert rows[:, 2].all()
    assert np.unique(rows[:, 1]).size > 50
    assert np.abs(rows[:, 5]).max() > 0.05
    assert (rows[:, 3:] == simulated(loops[number], rows[:, 1])).all()


@one_size
def test_a_person_without_a_pointer_plays(page: Page, address: str) -> None:
    page.goto(address)
    stage = page.get_by_role("slider", name="The hand on the handle")
    stage.focus()
    for _ in range(28):
        page.keyboard.press("ArrowRight")
    page.wait_for_function("document.querySelector('#stage').ariaValueNow === '30'")
    page.wait_for_function("/force [1-9.]/.test(document.querySelector('#stage').ariaValueText)")
    assert "held" in (stage.get_attribute("aria-valuetext") or "")
    hold = page.get_by_role("button", name="Hold")
    page.keyboard.press("Space")
    assert hold.get_attribute("aria-pressed") == "false"
    page.wait_for_function("/let go/.test(document.querySelector('#stage').ariaValueText)")
    page.keyboard.press("Space")
    assert hold.get_attribute("aria-pressed") == "true"
    page.wait_for_function("/handle at .* friction took/.test(document.querySelector('#live').textContent)")


@one_size
@pytest.mark.parametrize(("inertia", "thing"), [(0.02, "wheel"), (2e-5, "knob")])
def test_what_turns_is_turned_round(page: Page, tmp_path: Path, inertia: float, thing: str) -> None:
    """By the angle that the pointer goes round its middle, also beyond half a turn; in degrees and N·m."""
    device = zw.rotary(inertia=inertia, damping=0.02, coulomb_friction=0.01, resolution=1e-3, rate=1000)
    place = tmp_path / "play.html"
    place.write_text(play_page([play(device, zw.Wall(0.5), reach=6.0)]), encoding="utf-8")
    page.goto(place.as_uri())
    box: Any = page.get_by_role("slider", name=f"The hand on the {thing}").bounding_box()
    for degrees in range(60, 335, 5):
        angle = np.radians(degrees)
        across, down = box["width"] / 2 + 60 * np.sin(angle), box["height"] / 2 + 8 - 60 * np.cos(angle)
        page.mouse.move(box["x"] + across, box["y"] + down)
        if degrees == 60:
            page.mouse.down()
    _frames(page, 40)
    pointer = _recording(page)[1][:, 1]
    assert pointer[-1] - pointer[0] == pytest.approx(np.radians(270), abs=0.05)
    told = f"/^{thing} at [^m]*°, torque [^m]* m?N·m, held$/"
    page.wait_for_function(f"{told}.test(document.querySelector('#stage').ariaValueText)")
    assert f"Take the {thing}" in page.locator("#do").inner_text()
    assert "inertia" in page.locator("#numbers").inner_text()


@one_size
def test_two_wheels_say_where_they_are_and_the_page_how_high_it_is(page: Page, tmp_path: Path) -> None:
    """Angle and torque below each; around it what frames the page hears its height."""
    wheel = zw.rotary(inertia=0.02, damping=0.02, coulomb_friction=0.01, resolution=1e-3, rate=1000)
    place = tmp_path / "play.html"
    place.write_text(play_page([play_pair(zw.Pair(wheel, wheel, stiffness=20))]), encoding="utf-8")
    page.add_init_script(
        """
        window.written = new Set();
        const write = CanvasRenderingContext2D.prototype.fillText;
        CanvasRenderingContext2D.prototype.fillText = function (words, ...place) {
            window.written.add(words);
            return write.call(this, words, ...place);
        };
        addEventListener("message", ({ data }) => { window.high = data; });
        """
    )
    page.goto(place.as_uri())
    for who in ("leader", "follower"):
        page.wait_for_function(f"[...written].some((words) => /^{who} [^ ]*°, [^ ]* N·m$/.test(words))")
    page.wait_for_function("window.high === document.querySelector('#play').offsetHeight")


@one_size
def test_letting_go_frees_the_handle(page: Page, address: str) -> None:
    page.goto(address)
    _stroke(page, [0.5, 0.6, 0.7, 0.75, 0.75], release=True)
    _frames(page, 20)
    _, rows = _recording(page)
    held = rows[:, 2] > 0
    last = int(np.flatnonzero(held).max())
    assert rows[last, 3] > 0.001
    assert rows[-1, 3] < 0.0
    assert rows[-1, 6] == rows[last + 1, 6]


def test_it_is_silent_until_asked_and_a_buzz_is_loud(browser: Browser, address: str) -> None:
    page = browser.new_page()
    page.set_default_timeout(PATIENCE)
    page.add_init_script(_LISTEN)
    page.goto(address)
    _stroke(page, [0.5, 0.7, 0.75])
    assert page.evaluate("window.heard.length") == 0
    page.mouse.up()
    page.get_by_role("button", name="Sound").click()
    loud = []
    for number in (0, 1):
        page.locator("#loops button").nth(number).click()
        _stroke(page, [0.5, 0.6, 0.7, 0.74])
        _frames(page, 25)
        page.evaluate("window.heard.length = 0")
        for part in (0.76, 0.75, 0.77, 0.76, 0.75, 0.76):
            _stroke(page, [part])
        page.wait_for_function("window.heard.length > 10000")
        loud.append(float(np.std(page.evaluate("window.heard"))))
        page.mouse.up()
    page.close()
    assert 0.0 < loud[0] < 0.2 * loud[1]


def test_nobody_is_left_out(page: Page, address: str) -> None:
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        page.goto(address)
        found = complaints_of_access(page)
        assert not [v["id"] for v in found if v["impact"] in ("serious", "critical")], scheme
        wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0


@one_size
def test_it_works_in_a_frame_that_asks_for_nothing(page: Page, loops: list[Played]) -> None:
    """As the text of a frame without an address, with a policy that lets nothing be fetched."""
    policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'"
    inside = play_page(loops[:1]).replace(
        "<head>", f'<head><meta http-equiv="Content-Security-Policy" content="{policy}">'
    )
    page.set_content(
        f'<iframe sandbox="allow-scripts" width="380" height="800" srcdoc="{escape(inside)}"></iframe>'
    )
    frame = page.frame_locator("iframe")
    frame.get_by_role("heading", name="calm").wait_for()
    stage = frame.get_by_role("slider", name="The hand on the handle")
    stage.focus()
    for _ in range(12):
        page.keyboard.press("ArrowRight")
    frame.locator("#work", has_text="mJ").wait_for()
    assert frame.locator("#loops").is_hidden()


@one_size
def test_a_page_that_was_hidden_does_not_catch_up(page: Page, address: str) -> None:
    """A picture that comes two seconds late moves the loop by a tenth of one; the others are 10 ms apart."""
    page.add_init_script(
        """
        const frame = window.requestAnimationFrame.bind(window);
        window.skip = window.shown = 0;
        window.requestAnimationFrame = (told) => frame(() => told(10 * ++window.shown + window.skip));
        """
    )
    page.goto(address)
    page.wait_for_function("window.shown > 10")
    before = page.evaluate("window.skip = 2000, window.shown")
    page.wait_for_function(f"window.shown > {before + 10}")
    _, rows = _recording(page)
    after = page.evaluate("window.shown")
    assert 0.01 * before + 0.1 < rows[-1, 0] < 0.01 * after + 0.1
