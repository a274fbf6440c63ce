"""How every picture looks: colours, sizes, axis labels with units, where titles and legends stand.

Colours are those of Okabe & Ito (2008), told apart with any colour vision; no meaning hangs on a colour
alone.  A page of the docs is as wide as `WIDEST`: what is no wider keeps its letters at the size they have.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from io import BytesIO
from math import ceil, floor, isfinite, log10
from pathlib import Path
from re import sub
from textwrap import fill
from typing import Any, cast

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.text import Text
from matplotlib.textpath import text_to_path

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.scope import TOLD
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import PREFIXES, in_words, prefixed, unit_text
from zwidth.showing import OBEYED, printable
from zwidth.writing import check_target, writing_whole

BLACK, GREY = "#222222", "#777777"
BLUE, SKY = "#0072B2", "#56B4E9"
GREEN, ORANGE, RED, PURPLE = "#009E73", "#E69F00", "#D55E00", "#CC79A7"

OUTCOME = {outcome: told.colour for outcome, told in TOLD.items()}
"""Colour of each outcome; the word always stands beside it."""

WIDEST = 7.2
"""Of a picture [inch]: 700 points of a screen, as wide as a page of the docs."""

SMALL = 8.0
"""The smallest letters [point]."""

LOOK: Any = {
    "figure.facecolor": "white",  # a page of its own, also where everything around it is dark
    "savefig.facecolor": "auto",
    "axes.facecolor": "white",
    "axes.edgecolor": BLACK,
    "axes.titlecolor": BLACK,
    "text.color": BLACK,
    "legend.labelcolor": BLACK,
    "xtick.color": BLACK,
    "ytick.color": BLACK,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-9, 10),  # numbers as people write them, no 1e6 beside the axis
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.labelcolor": BLACK,
    "legend.frameon": False,
    "legend.fontsize": SMALL,
    "legend.handlelength": 2.4,
    "lines.linewidth": 1.8,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
}
"""Settings under which every picture is drawn."""

_BESIDE = 0.7
"""What numbers and label of the upright axis take of the width of its place [inch]."""

_HANDLE = 0.5
"""What the mark takes of an entry of a legend [inch]."""

_LONGEST = 80
"""Characters of a device's name that are drawn."""

_SCALED = ("m", "s", "J", "N", "rad", "N*m")


def new_figure(width: float = WIDEST, height: float = 4.0) -> Figure:
    """An empty figure that belongs to no window; sizes in inches."""
    return Figure(figsize=(width, height), layout="constrained")


def label(name: str, motion: str = "linear", text: str | None = None, unit: str | None = None) -> str:
    """An axis label from the glossary: name, symbol, unit."""
    quantity = GLOSSARY[name]
    words = in_words(quantity.name, motion) if text is None else text
    return with_unit(
        f"{words} {symbol(name)}".strip(), spoken(quantity.unit_for(motion))[1] if unit is None else unit
    )


def with_unit(words: str, unit: str) -> str:
    """What every axis says: "energy out [mJ]"."""
    return f"{words} [{unit_text(unit) or '1'}]"


def axis(
    values: Iterable[float], name: str, motion: str = "linear", text: str | None = None
) -> tuple[float, str]:
    """(factor, label) of an axis on which these values in SI are read: (1000, "position x [mm]").

    `text` stands in the place of name and symbol; "time" is no quantity of the glossary, and has one too.
    """
    factor, unit = scale(values, "s" if name == "time" else GLOSSARY[name].unit_for(motion))
    words = "time t" if name == "time" else f"{in_words(name, motion)} {symbol(name)}"
    return factor, with_unit(words if text is None else text, unit)


def symbol(name: str) -> str:
    """The symbol of a quantity with its index set low."""
    return low_index(GLOSSARY[name].symbol)


def low_index(text: str) -> str:
    """ "f_c/(K Δ)" with the c set low."""
    return sub(r"([A-Za-zτ])_(\w+)", r"$\1_{\2}$", text)


def number(value: float) -> str:
    """Four digits, with a minus sign and no exponent where it is readable."""
    text = f"{value + 0.0:.4g}"  # + 0.0: no negative zero
    if "e" in text:
        mantissa, power = text.split("e")
        text = f"{mantissa}·10{''.join(_SUPERSCRIPT[c] for c in str(int(power)))}"
    return text.replace("-", "−")


_SUPERSCRIPT = dict(zip("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹", strict=True))


def scale(values: Iterable[float], unit: str) -> tuple[float, str]:
    """(factor, unit) with which these values are read without exponents, such as (1000, "mm").

    Of what people seldom prefix, such as N/m, only where `shown` prefixes the largest of them.
    """
    factor, unit = spoken(unit)
    largest = factor * max((abs(v) for v in values if isfinite(v)), default=0.0)
    if unit not in _SCALED or largest == 0:
        power, unit = prefixed(largest, unit, 4)
        return factor * 10.0**-power, unit
    power = max(-12, min(6, 3 * floor(log10(largest * 1.0000001) / 3)))
    return factor * 10.0**-power, PREFIXES[power] + unit_text(unit)


def drawn_in(name: str, motion: str, values: Iterable[float] = ()) -> tuple[float, str]:
    """(factor, unit) of an axis with the `label` of a quantity, prefixed as `shown` does the largest."""
    factor, unit = spoken(GLOSSARY[name].unit_for(motion))
    power, unit = prefixed(factor * max((abs(v) for v in values if isfinite(v)), default=0.0), unit, 4)
    return factor * 10.0**-power, unit


def quantity_text(value: float, name: str, motion: str = "linear") -> str:
    """A value with its unit, such as "6.6 µJ" or "0.15 N·s/m"."""
    factor, unit = scale([value], GLOSSARY[name].unit_for(motion))
    return f"{number(value * factor)} {unit}"


def shown_name(device: Device) -> str:
    """The name of a device on one short line; it is drawn as it is, without mathematics."""
    name = printable(" ".join(device.name.split()))
    return name if len(name) <= _LONGEST else name[: _LONGEST - 1] + "…"


def verbatim(text: str) -> str:
    """Text of others as it is drawn: nothing in it is mathematics, and nothing obeyed."""
    return printable(text).replace("$", r"\$")


def legend(axes: Axes, handles: Sequence[Any] | None = None) -> None:
    """Above the axes, so that no curve runs through it, in as many columns as the width allows.

    It comes before `heading`, which stands above it.
    """
    handles = axes.get_legend_handles_labels()[0] if handles is None else handles
    words = [broken(str(one.get_label()), room(axes) - _HANDLE, SMALL) for one in handles]
    for columns in range(len(handles), 0, -1):
        drawn = axes.legend(
            handles, words, ncols=columns, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2,
            columnspacing=1.2,
        )  # fmt: skip
        if drawn.get_window_extent().width <= room(axes) * cast("Figure", axes.figure).dpi:
            return


def legend_of_all(figure: Figure, handles: Sequence[Any]) -> None:
    """One legend for all axes, below them, in as many columns as the width allows."""
    for columns in range(len(handles), 0, -1):
        drawn = figure.legend(handles=handles, ncols=columns, loc="outside lower left", columnspacing=1.2)
        if columns == 1 or drawn.get_window_extent().width <= 0.97 * figure.bbox.width:
            return
        drawn.remove()


def room(axes: Axes) -> float:
    """Width of the axes within their place in the figure [inch]."""
    place, figure = axes.get_subplotspec(), cast("Figure", axes.figure)
    if place is None:
        return float(axes.get_position().width * figure.get_figwidth())
    share = place.get_position(figure).width / (figure.subplotpars.right - figure.subplotpars.left)
    return float(share * figure.get_figwidth() - _BESIDE)


def heading(axes: Axes, text: str, size: float = 10.0, **style: Any) -> None:
    """A title above the legend, as wide as the axes at most, on as many lines as that takes."""
    drawn = axes.get_legend()
    above = 0 if drawn is None else 72 * drawn.get_window_extent().height / cast("Figure", axes.figure).dpi
    axes.set_title(broken(text, room(axes), size), fontsize=size, pad=6 + above, **style)


def page_heading(figure: Figure, text: str, size: float = 10.5, color: str = BLACK) -> None:
    """A title over all of a figure, as it is written, on as many lines as the width takes."""
    lines = broken(text, 0.95 * figure.get_figwidth(), size)
    figure.suptitle(lines, x=0.01, ha="left", fontsize=size, color=color, parse_math=False)


def broken(text: str, width: float, size: float = 10.0) -> str:
    """Text on as few lines as a width [inches] allows at a size [points]; its own breaks stay."""
    return "\n".join(_broken(line, 72 * width, size) for line in text.splitlines())


def _broken(line: str, room: float, size: float) -> str:
    lines = max(1, ceil(_long(line, size) / room))
    for count in range(lines, lines + 3):
        split = fill(line, max(1, ceil(len(line) / count) + 8)) if count > 1 else line
        if all(_long(part, size) <= room for part in split.splitlines()):
            break
    return split


def _long(text: str, size: float) -> float:
    """How wide it is drawn [points]."""
    wide, _, _ = text_to_path.get_text_width_height_descent(text, FontProperties(size=size), False)
    return float(wide)


def as_written(text: object) -> str:
    """A description with its units as people write them: "30 N*m" with a point, "kg*m^2" with a raised 2."""
    return str(text).replace("*", "·").replace("^2", "²")


def note(axes: Axes, text: str) -> None:
    """A small line under the picture: what is left out, and why."""
    axes.annotate(
        broken(text, room(axes), SMALL), (0, 0), (0, -34), xycoords="axes fraction",
        textcoords="offset points", va="top", fontsize=SMALL, color=GREY,
    )  # fmt: skip


ENDINGS = ("png", "svg", "pdf")

_METADATA: dict[str, dict[str, Any]] = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
"""No date in a file."""


def save_figure(draw: Callable[[], Figure], path: str | Path, overwrite: bool = False) -> None:
    """Draw and write to a file; its ending, png, svg or pdf, says how.

    Raises
    ------
    InputError
        If the ending is another one, the file exists, or it cannot be written.
    """
    target = Path(path)
    ending = target.suffix.removeprefix(".").lower()
    if ending not in ENDINGS:
        raise InputError(
            f"a picture is written as .png, .svg or .pdf, got {target.name!r}; for example check.png"
        )
    check_target(target, overwrite, "overwrite=True")
    picture = encoded(draw(), ending)
    with writing_whole(target) as file:
        file.write(picture)


def encoded(figure: Figure, ending: str, dpi: float = 160) -> bytes:
    """The figure as a file of one of `ENDINGS`."""
    picture = BytesIO()
    with rc_context({"svg.hashsalt": "zwidth"}):
        _printable(figure).savefig(picture, format=ending, dpi=dpi, metadata=_METADATA[ending])
    return picture.getvalue()


def _printable(figure: Figure) -> Figure:
    """No control characters, of which an SVG must have none."""
    for text in figure.findobj(Text):
        if OBEYED.search(text.get_text()):
            text.set_text(printable(text.get_text()))
    return figure
