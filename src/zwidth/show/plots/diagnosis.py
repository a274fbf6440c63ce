"""The picture of a diagnosis: some cycles, the spectrum, where the energy comes from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    RED,
    heading,
    label,
    new_figure,
    page_heading,
    scale,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from zwidth.data.diagnosis.evidence import Evidence
    from zwidth.data.diagnosis.recording import Recording
    from zwidth.data.diagnosis.vibration import Vibration


class Shaking(Protocol):
    """What is drawn of any vibration."""

    @property
    def vibration(self) -> Vibration:
        """Where, how fast, how far."""

    @property
    def rotary(self) -> bool:
        """Of what turns."""

    @property
    def supplied(self) -> Mapping[str, float]:
        """[J] by each term in a cycle."""

    @property
    def lost(self) -> float | None:
        """[J] that friction takes in a cycle."""


Drawn = TypeVar("Drawn", bound=Shaking)

_CYCLES = 8
"""That are drawn as they went."""


def diagnosis_figure(recording: Recording, seen: Evidence | None, claim: str) -> Figure:
    """Position and force over some cycles; the spectrum beside the energy of a cycle, term by term.

    Raises
    ------
    InputError
        If nothing vibrates: there is nothing to draw.
    """
    return figure_of(recording, seen, claim, lambda axes, seen: _cycles(axes, recording, seen))


@rc_context(LOOK)
def figure_of(
    recording: Recording, seen: Drawn | None, claim: str, draw_cycles: Callable[[Axes, Drawn], None]
) -> Figure:
    """What is drawn above, the spectrum of a recording and the energy of a cycle below."""
    if seen is None:
        raise InputError("nothing vibrates in this recording, so there is no picture of a vibration")
    figure = new_figure(9.0, 6.6)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.1, 1.0))
    draw_cycles(figure.add_subplot(grid[0, :]), seen)
    _spectrum(figure.add_subplot(grid[1, 0]), recording, seen)
    _energy(figure.add_subplot(grid[1, 1]), seen)
    page_heading(figure, claim)
    return figure


def last_cycles(vibration: Vibration, period: float) -> slice:
    """Some cycles at the end of the stretch."""
    rows = max(8, int(_CYCLES / vibration.frequency / period))
    return slice(max(vibration.rows.start, vibration.rows.stop - rows), vibration.rows.stop)


def _cycles(axes: Axes, recording: Recording, seen: Evidence) -> None:
    part = last_cycles(seen.vibration, recording.period)
    t = recording.time[part]
    length, force = ("rad", "N*m") if seen.rotary else ("m", "N")
    factor, unit = scale(recording.position[part] - recording.position[part].mean(), length)
    axes.plot(t, factor * recording.position[part], color=BLUE, label="position")
    axes.set_xlabel("time [s]")
    axes.set_ylabel(label("position", recording.motion, unit=unit), color=BLUE)
    beside = axes.twinx()
    for values, colour, name in (
        (recording.commanded, GREY, "commanded"),
        (recording.applied, ORANGE, "of the motor"),
    ):
        if values is not None:
            beside.plot(t, values[part], color=colour, drawstyle="steps-post", label=name)
    beside.set_ylabel(label("force", recording.motion, unit=force))
    lines = [*axes.get_lines(), *beside.get_lines()]
    axes.legend(
        lines,
        [str(line.get_label()) for line in lines],
        loc="lower right",
        bbox_to_anchor=(1, 1),
        ncols=3,
        fontsize=8,
    )


def _spectrum(axes: Axes, recording: Recording, seen: Shaking) -> None:
    """Amplitude against frequency, up to six times that of the vibration."""
    vibration = seen.vibration
    x = recording.position[vibration.rows]
    y = (x - np.polyval(np.polyfit(np.arange(x.size), x, 1), np.arange(x.size))) * np.hanning(x.size)
    size = 2 * np.abs(np.fft.rfft(y)) / np.hanning(x.size).sum()
    frequencies = np.fft.rfftfreq(x.size, recording.period)
    factor, unit = scale(size, "rad" if seen.rotary else "m")
    axes.semilogy(frequencies[1:], factor * size[1:] + 1e-12, color=BLUE)
    axes.axvline(vibration.frequency, color=RED, linewidth=0.8)
    axes.set_xlim(0, min(frequencies[-1], 6 * vibration.frequency))
    axes.set_ylim(bottom=factor * size.max() * 1e-4)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"amplitude [{unit}]")
    heading(axes, f"{vibration.frequency:.4g} Hz")


def _energy(axes: Axes, seen: Shaking) -> None:
    """A bar for each term of the energy of a cycle."""
    terms = {name: work for name, work in seen.supplied.items() if work}
    if seen.lost is not None:
        terms["friction"] = -seen.lost
    factor, unit = scale(terms.values(), "J")
    names = list(terms)[::-1]
    colours = [RED if terms[name] > 0 else GREY for name in names]
    axes.barh(names, [factor * terms[name] for name in names], color=colours)
    axes.axvline(0, color="black", linewidth=0.8)
    axes.set_xlabel(f"energy in a cycle [{unit}]")
    heading(axes, "into the motion (orange), out of it (grey)")
