"""The page in a browser: what is moved, the verdict that follows, the address that keeps it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import parse_qsl, urlsplit

import pytest
from browser import PATIENCE, WIDE, complaints_of_access
from playwright.sync_api import Browser, Locator, Page, expect

import zwidth as zw
from zwidth.model.specification.write import parsed
from zwidth.show.explorer.pictures import GREY
from zwidth.show.explorer.serving import serve_explorer

SCHEMES = {"Criterion": ("light", "dark"), "Touch": ("light",), "Motion": ("dark",), "Two arms": ("light",)}
"""Under which tabs axe looks: a picture, a choice of hands, a player, a form of its own."""

expect.set_options(timeout=PATIENCE)

one_size = pytest.mark.parametrize("page", [WIDE], indirect=True, ids=["1280x800"])
"""For what a smaller screen does not change."""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with serve_explorer() as page:
        yield page.address


def opened(page: Page, address: str) -> Page:
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    expect(verdict(page).locator("table")).to_be_visible()
    return page


def verdict(page: Page) -> Locator:
    return page.locator("#verdict")


def slider(page: Page, name: str) -> Locator:
    return page.locator("#loop").get_by_role("slider", name=name, exact=True)


def entry(page: Page, name: str) -> Locator:
    return page.locator("#loop").get_by_role("textbox", name=f"{name}, typed with its unit", exact=True)


def held(page: Page) -> dict[str, str]:
    return dict(parse_qsl(urlsplit(page.url).query))


@one_size
def test_a_device_is_chosen_a_slider_moved_and_the_address_keeps_it(page: Page, address: str) -> None:
    """The verdict is that of `zwidth.check` for the numbers shown, and again after a reload."""
    opened(page, address)
    expect(verdict(page)).to_contain_text("passive")
    page.locator("#loop").get_by_role("combobox", name="device").select_option("own-linear")
    expect(entry(page, "damping")).to_have_value("0.1 N·s/m")
    moved = slider(page, "stiffness")
    moved.focus()
    for _ in range(5):
        moved.press("PageUp")
    expect(verdict(page).locator(".badge")).to_have_text("active")
    stiffness = "6000 N/m"  # the very right: thirty times what the slider began with
    expect(entry(page, "stiffness")).to_have_value(stiffness)
    page.wait_for_function("location.search.includes('stiffness=6000')")
    assert held(page)["environment.stiffness"] == stiffness
    device = zw.Device(mass=0.1, damping=0.1, coulomb_friction=0.1, resolution=20e-6, rate=1000)
    said = zw.check(device, zw.Wall(stiffness=stiffness))
    expect(verdict(page)).to_contain_text(said.claim)
    for advice in said.advice:
        if advice.to is not None:
            expect(verdict(page)).to_contain_text(advice.text)
    page.reload()
    expect(verdict(page)).to_contain_text(said.claim)
    expect(entry(page, "stiffness")).to_have_value(stiffness)


@one_size
def test_a_typed_number_is_exact_and_a_wrong_one_is_a_message(page: Page, address: str) -> None:
    opened(page, address)
    typed = entry(page, "stiffness")
    typed.fill("0.3 N/mm")
    typed.press("Enter")
    expect(verdict(page)).to_contain_text("exactly at its limit")
    badge = verdict(page).locator(".badge")
    grey = "one => getComputedStyle(one.getRootNode().host).filter.includes('grayscale(1)')"
    refusal = page.locator("#loop [data-path='environment.stiffness']").get_by_role("alert")
    for wrong in ("300 bananas", "-300"):
        typed.fill(wrong)
        typed.press("Enter")
        expect(refusal).to_contain_text(wrong.removeprefix("300 "))
        expect(typed).to_have_accessible_description(str(refusal.text_content()))
        expect(verdict(page)).to_contain_text("stiffness cannot be used as typed")
        assert badge.evaluate(grey)
    assert held(page)["environment.stiffness"] == "300 N/m"
    page.get_by_role("button", name="The verdict as JSON").click()
    expect(page.get_by_role("alert").first).to_contain_text("nothing is saved")
    typed.fill("300 N/m")
    typed.press("Enter")
    expect(refusal).to_have_count(0)
    expect(verdict(page)).not_to_contain_text("cannot be used")
    assert not badge.evaluate(grey)
    before = page.url
    typed.fill("300 pear")
    slider(page, "stiffness").evaluate("one => (one.value = 900)")
    for happens in ("input", "change"):
        slider(page, "stiffness").dispatch_event(happens)
    expect(page).not_to_have_url(before)  # so the answer is there
    expect(typed).to_have_value("300 pear")
    typed.press("End")
    typed.press_sequentially("s")
    typed.press("Enter")
    expect(refusal).to_contain_text("pears")


@one_size
def test_a_file_is_read_and_what_is_downloaded_is_the_loop(page: Page, address: str, tmp_path: Path) -> None:
    """Its name is shown and not obeyed; the files are those that the command line writes.

    Without a damping it has a mark until that is set; no box is cut; a file that is none changes nothing.
    """
    opened(page, address)
    text = (
        '[device]\nname = "<img src=x onerror=alert(1)>"\ndamping = "0.2 N*s/m"\nrate = "2 kHz"\n'
        '[environment]\ntype = "maxwell"\nstiffness = "300 N/m"\ndamping = "2 N*s/m"\n'
    )
    given = tmp_path / "mine.toml"
    given.write_text(text, encoding="utf-8")
    chosen = page.locator("#loop input[type=file]")
    chosen.set_input_files(given)
    expect(entry(page, "rate")).to_have_value("2 kHz")
    expect(page.locator("#loop option", has_text="<img")).to_have_count(1)
    with page.expect_download() as toml:
        page.get_by_role("button", name="The loop as TOML").click()
    loop, written = parsed(text), parsed(Path(toml.value.path()).read_text(encoding="utf-8"))
    assert (written.device, written.environment) == (loop.device, loop.environment)
    with page.expect_download() as saved:
        page.get_by_role("button", name="The verdict as JSON").click()
    document = json.loads(Path(saved.value.path()).read_text(encoding="utf-8"))
    assert document["outcome"] == zw.check(loop.device, loop.environment).outcome
    assert zw.verify(document["certificate"]).valid

    given = tmp_path / "my-wheel.toml"
    given.write_text(
        '[device]\nmotion = "rotary"\ninertia = "0.006 kg*m^2"\ncounts_per_turn = 65536\nrate = "500 Hz"\n',
        encoding="utf-8",
    )
    chosen.set_input_files(given)
    expect(verdict(page)).to_contain_text("nobody's measurement")
    expect(page.locator("#loop small", has_text="nobody's measurement")).to_have_count(1)
    assert "my-wheel.toml" in chosen.input_value()
    expect(entry(page, "resolution")).to_have_value("95.8738 µrad")
    cut = page.locator("#loop input[type=text]").evaluate_all(
        "boxes => boxes.filter((box) => box.scrollWidth > box.clientWidth).map((box) => box.value)"
    )
    assert not cut
    exactly = held(page)["device.resolution"]
    entry(page, "damping").fill("0.05 N*m*s/rad")
    entry(page, "damping").press("Enter")
    expect(verdict(page)).not_to_contain_text("nobody's measurement")
    expect(page.locator("#loop small", has_text="nobody's measurement")).to_have_count(0)
    assert held(page)["device.resolution"] == exactly
    given.write_text("[device", encoding="utf-8")
    chosen.set_input_files([])
    chosen.set_input_files(given)
    expect(page.get_by_role("alert").first).to_contain_text("The page still shows my-wheel")


@one_size
def test_what_the_address_cannot_say_is_a_message_and_tabs_go_by_arrows(page: Page, address: str) -> None:
    opened(
        page, f"{address}?device.damping=-1&device.rate=1+kHz&environment.type=wall&environment.stiffness=3"
    )
    expect(page.get_by_role("alert").first).to_contain_text("damping must be ≥ 0")
    first, last = page.get_by_role("tab").first, page.get_by_role("tab").last
    first.focus()
    first.press("End")
    expect(last).to_be_focused()
    expect(page.get_by_role("tabpanel", name=str(last.text_content()))).to_be_visible()
    assert page.url.endswith("#play")
    last.press("ArrowRight")
    expect(first).to_be_focused()


def test_the_verdict_is_read_before_any_script_runs(browser: Browser, address: str) -> None:
    page = browser.new_page(java_script_enabled=False)
    page.goto(address)
    expect(verdict(page).locator(".badge")).to_have_text("passive")
    expect(verdict(page)).to_contain_text("No motion of the hand")
    page.close()


@one_size
def test_pictures_are_of_something_and_the_loop_is_played(page: Page, address: str) -> None:
    """No frame around nothing: a loop that is passive has no motion to show, and a spring no inside."""
    opened(page, f"{address}#motion")
    shown = page.get_by_role("tabpanel")
    expect(shown).to_contain_text("there is no motion that takes energy out")
    assert not [one.bounding_box() for one in shown.locator("canvas").all() if one.is_visible()]
    page.get_by_role("tab", name="Play").click()
    stage = page.frame_locator("iframe").get_by_role("slider", name="The hand on the handle")
    stage.click()
    page.get_by_role("tab", name="Touch").click()
    expect(shown.locator("canvas").first).to_be_visible()
    expect(shown).to_contain_text("Largest force")


def test_two_people_do_not_disturb_each_other(browser: Browser, address: str) -> None:
    first, second = (opened(browser.new_page(), address) for _ in range(2))
    typed = entry(first, "stiffness")
    typed.fill("770 N/m")
    typed.press("Enter")
    expect(verdict(first).locator(".badge")).to_have_text("active")
    expect(verdict(second).locator(".badge")).to_have_text("passive")
    assert entry(second, "stiffness").input_value() == "200 N/m"
    for page in (first, second):
        page.close()


@one_size
def test_numbers_along_the_axes_are_read_in_both_themes(page: Page, address: str) -> None:
    """4.5 to 1 on the card, by WCAG's formula; in the dark the picture is the other way round."""
    opened(page, address)
    canvas = page.locator("#view-criterion .bk-Canvas").first

    def luminance(colour: str, turned: bool = False) -> float:
        parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        linear = [((p + 0.055) / 1.055) ** 2.4 for p in ((1 - p if turned else p) for p in parts)]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    for scheme, card in (("light", "#f5f6f8"), ("dark", "#1b1f25")):
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        turned = "invert(1)" in canvas.evaluate("one => getComputedStyle(one).filter")
        assert turned == (scheme == "dark")
        light = sorted((luminance(GREY, turned), luminance(card)))
        assert (light[1] + 0.05) / (light[0] + 0.05) > 4.5


def test_nothing_is_wider_than_the_screen_and_everybody_can_use_it(page: Page, address: str) -> None:
    opened(page, address)
    for tab in page.get_by_role("tab").all():
        if tab.text_content() == "Play":
            continue  # a page of its own, with tests of its own
        tab.click()
        expect(tab).to_have_attribute("aria-selected", "true")
        assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
        for scheme in SCHEMES.get(tab.text_content() or "", ()):
            page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
            found = complaints_of_access(page)
            bad = [v for v in found if v["impact"] in ("serious", "critical")]
            assert not bad, [(v["id"], [n["html"] for n in v["nodes"]]) for v in bad]
