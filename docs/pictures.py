"""The pictures of the README and of these pages: what makes each, and which of them are stale.

    python docs/pictures.py                draws all of them anew
    python docs/pictures.py map limit      draws these
    python docs/pictures.py --check        names those that show other numbers or words than are found today

A picture carries in its own file the command that gives it, the numbers that it shows and the words that are
written in it.  Numbers and words are compared, and not pixels, which fonts and versions change.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib.axis import Tick
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

import zwidth as zw
from zwidth.machine.servo.live.rows import CURVES
from zwidth.show import plots
from zwidth.show.plots.identified import identification_figure
from zwidth.show.plots.scores import laws_figure

STATIC = Path(__file__).parent / "_static"
sys.path[:0] = [str(STATIC.parents[1] / "examples"), str(STATIC.parent / "_ext")]

Numbers = dict[str, float]


class Picture(NamedTuple):
    """How it is made: the command that a reader would give, and the same in Python."""

    command: str
    find: Callable[[], Any]
    draw: Callable[[Any], Figure]
    numbers: Callable[[Any], Numbers]
    quick: Callable[[], Any] | None = None
    """Finds the numbers sooner, and not all that is drawn, so that no words are compared; None: as `find`."""
    dots: int = 110
    """To an inch."""


def _paddle() -> zw.Device:
    return zw.catalogue.device("haptic-paddle")


def _check() -> Any:
    return zw.check(_paddle(), zw.Wall(770))


def _touch() -> Any:
    return zw.simulate(_paddle(), zw.Wall(770), zw.operators.Dowel(), 2.0)


def _limit() -> Any:
    return zw.limit(_paddle(), zw.Wall(100, "0.05"), speed="0.5", penetration="0.002")


def _limit_numbers(found: Any) -> Numbers:
    """To two digits: where in its hundredth a bracket ends depends on the order of what was tried."""
    ends = {"passive": found.proved_passive, "active": found.proved_active}
    return {f"proved_{side}_N_per_m": float(f"{end:.2g}") for side, end in ends.items()}


def _laws(names: tuple[str, ...] | None = None) -> Any:
    from zwidth.study.bench import standard_laws

    wall = zw.Wall(2000)
    laws = standard_laws(_paddle(), wall)
    return zw.compare(_paddle(), wall, laws if names is None else {name: laws[name] for name in names})


def _map(cells: tuple[int, int] = (500, 2600)) -> Any:
    return zw.z_width(_paddle(), (0, 35_000), (0, 90), cells=cells)


def _map_numbers(found: Any) -> Numbers:
    """To three digits, in which the cells do not matter."""
    hands = ("none", "dowel", "finger")
    return {f"stiffest_{hand}_N_per_m": float(f"{float(found[f'limit_{hand}'].max()):.3g}") for hand in hands}


def _identified() -> Any:
    from identify_report import record

    with tempfile.TemporaryDirectory() as folder:
        record(Path(folder) / "paddle.csv")
        return zw.identify(zw.read_log(Path(folder) / "paddle.csv", resolution="22.4um"))


def _cable(steps: int = 90) -> Any:
    import cables

    return cables.curves([10 * 500 ** (i / steps) for i in range(steps + 1)])


def _cable_figure(found: Any) -> Figure:
    import cables

    return cables.figure(found)


def _law_numbers(found: Any) -> Numbers:
    felt = found.scores.static_stiffness
    return {f"felt_{name}_N_per_m": float(felt.sel(law=name)) for name in ("wall", "virtual-coupling")}


PICTURES = {
    "check": Picture(
        "zwidth check haptic-paddle --stiffness 770",
        _check,
        plots.check_figure,
        lambda v: {"largest_N_per_m": v.max_stiffness, "energy_J": v.witness.energy},
    ),
    "touch": Picture(
        "zwidth simulate haptic-paddle --stiffness 770 --operator dowel --duration 2",
        _touch,
        lambda trace: trace.zwidth.plot(),
        lambda trace: {"extracted_J": trace.zwidth.energy.extracted},
    ),
    "limit": Picture(
        "zwidth limit haptic-paddle --stiffness 100 --virtual-damping 0.05 "
        "--speed '0.5 m/s' --penetration '2 mm'",
        _limit,
        plots.limit_figure,
        _limit_numbers,
        _limit,
    ),
    "laws": Picture(
        "zwidth compare haptic-paddle --stiffness 2000",
        _laws,
        laws_figure,
        _law_numbers,
        partial(_laws, ("wall", "virtual-coupling")),
    ),
    "map": Picture(
        "zwidth map haptic-paddle --stiffness 0:35000 --virtual-damping 0:90 --cells 500x2600",
        _map,
        plots.z_width_figure,
        _map_numbers,
        partial(_map, (20, 300)),
    ),
    "cable": Picture(
        "python docs/pictures.py cable",
        _cable,
        _cable_figure,
        lambda found: {f"{name}_N_per_m": points[len(points) // 2][1] for name, points in found.items()},
        partial(_cable, 2),
    ),
    "identify": Picture(
        "zwidth identify paddle.csv --resolution 22.4um --stiffness 250",
        _identified,
        identification_figure,
        lambda found: {name: one.value for name, one in found.estimates.items()},
    ),
}
"""By the names of the files."""

LIVE = ("benchmarks/live_pages.py", "--picture", "docs/_static/live.png")
"""Draws the one that a browser shows, `python docs/pictures.py live` too; it is told apart by its curves."""


def told(picture: Picture, found: Any) -> dict[str, str]:
    """What the file says of itself: the command, and the numbers, to four digits."""
    numbers = {name: f"{float(value):.4g}" for name, value in picture.numbers(found).items()}
    return {"Command": picture.command, "Numbers": json.dumps(numbers)}


def written(figure: Figure) -> list[str]:
    """The words in a figure, but for the numbers along its axes."""
    ticks = {id(text) for tick in figure.findobj(Tick) for text in tick.findobj(Text)}
    texts = (t for t in figure.findobj(Text) if t.get_visible() and id(t) not in ticks)
    return sorted({" ".join(t.get_text().split()) for t in texts} - {""})


def make(name: str) -> None:
    """Draw it and write the file."""
    if name == "live":
        subprocess.run([sys.executable, *LIVE], cwd=STATIC.parents[1], check=True)
        return
    picture = PICTURES[name]
    found = picture.find()
    figure = picture.draw(found)
    about = {**told(picture, found), "Words": json.dumps(written(figure))}
    figure.savefig(STATIC / f"{name}.png", dpi=picture.dots, metadata={**about, "Software": None})


def stale(name: str) -> Iterator[str]:
    """What a file shows that is no longer so, on a line each."""
    picture = PICTURES[name]
    with Image.open(STATIC / f"{name}.png") as image:
        before = dict(image.info)
    found = (picture.quick or picture.find)()
    now: dict[str, str] = told(picture, found)
    if picture.quick is None:
        now["Words"] = json.dumps(written(picture.draw(found)))
    for key, value in now.items():
        if before.get(key) != value:
            yield f"{name}.png: {key.lower()} {before.get(key)}, now {value}"


def stale_live() -> Iterator[str]:
    """The same of the picture that a browser draws."""
    with Image.open(STATIC / "live.png") as image:
        before = image.info.get("Words")
    if before != (now := json.dumps(CURVES)):
        yield f"live.png: curves {before}, now {now}; python {' '.join(LIVE)}"


def main() -> int:
    """Draw, or check: 1 if a picture is stale."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="name", help="of pictures, all unless given")
    parser.add_argument("--check", action="store_true", help="draw none, name those that are stale")
    arguments = parser.parse_args()
    names = arguments.names or list(PICTURES)
    if not arguments.check:
        for name in names:
            make(name)
        return 0
    lines = [line for name in names for line in stale(name)]
    lines += [] if arguments.names else stale_live()
    print("\n".join(lines) or "none is stale")
    return int(bool(lines))


if __name__ == "__main__":
    sys.exit(main())
