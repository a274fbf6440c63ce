"""How every picture looks: colours, sizes, axis labels with units.

Colours are those of Okabe & Ito (2008), told apart with any colour vision;
no meaning hangs on a colour alone.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, isfinite, log10
from re import sub
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.device import Device
from zwidth.passivity.outcome import TOLD
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import PREFIXES, in_words, unit_text
from zwidth.showing import printable

BLACK, GREY = "#222222", "#777777"
BLUE, SKY = "#0072B2", "#56B4E9"
GREEN, ORANGE, RED, PURPLE = "#009E73", "#E69F00", "#D55E00", "#CC79A7"

OUTCOME = {outcome: told.colour for outcome, told in TOLD.items()}
"""Colour of each outcome; the word always stands beside it."""

LOOK: Any = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.labelcolor": BLACK,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.8,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
}
"""Settings under which every picture is drawn."""

_LONGEST = 36
"""Characters of a device's name that are drawn."""

_SCALED = ("m", "s", "J", "N", "rad", "N*m")


def new_figure(width: float = 6.4, height: float = 4.0) -> Figure:
    """An empty figure that belongs to no window; sizes in inches."""
    return Figure(figsize=(width, height), layout="constrained")


def label(name: str, motion: str = "linear", text: str | None = None, unit: str | None = None) -> str:
    """An axis label from the glossary: name, symbol, unit."""
    quantity = GLOSSARY[name]
    words = in_words(quantity.name) if text is None else text
    shown = unit_text(quantity.unit_for(motion) if unit is None else unit) or "1"
    return f"{words} {symbol(name)} [{shown}]".strip()


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
    """(factor, unit) with which these values are read without exponents, such as (1000, "mm")."""
    largest = max((abs(v) for v in values if isfinite(v)), default=0.0)
    if unit not in _SCALED or largest == 0:
        return 1.0, unit_text(unit)
    power = max(-12, min(6, 3 * floor(log10(largest * 1.0000001) / 3)))
    return 10.0**-power, PREFIXES[power] + unit_text(unit)


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


def note(axes: Axes, text: str) -> None:
    """A small line under the picture: what is left out, and why."""
    axes.annotate(
        text, (0, 0), (0, -34), xycoords="axes fraction", textcoords="offset points",
        va="top", fontsize=7.5, color=GREY,
    )  # fmt: skip
