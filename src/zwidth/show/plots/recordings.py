"""A served loop against time: where the device was, what force it was given, how late the samples were."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.quantity.text import shown
from zwidth.show.plots.style import (
    BLACK,
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    RED,
    axis,
    heading,
    label,
    legend,
    new_figure,
    page_heading,
    with_unit,
)
from zwidth.show.plots.traces import ARMS, shade_wall, thinned, timed
from zwidth.showing import printable

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from zwidth.data.diagnosis.evidence import Evidence
    from zwidth.data.diagnosis.pairs.energy import PairEvidence
    from zwidth.data.diagnosis.pairs.recording import PairRecording
    from zwidth.data.diagnosis.recording import Recording
    from zwidth.data.diagnosis.vibration import Vibration

    Array = NDArray[np.float64]


_MOST_GAPS = 200
"""Samples without an answer that are marked one by one."""


@rc_context(LOOK)
def recording_figure(data: xr.Dataset) -> Figure:
    """Position, force and lateness, one above the other.

    Parameters
    ----------
    data
        Of a recording of two samples at least, `servo.recording.Recording.dataset`.
    """
    figure = new_figure(height=6.4)
    above, middle, below = figure.subplots(3, 1, sharex=True, height_ratios=(1.15, 1, 0.7))
    draw_read_position(above, data)
    draw_given_force(middle, data)
    draw_recorded_lateness(below, data)
    page_heading(figure, printable(str(data.attrs["title"])))
    below.set_xlabel(timed(data)[1])
    return figure


def draw_read_position(axes: Axes, data: xr.Dataset) -> None:
    """The position as it was read; grey lines where a sample had no good answer; the wall is shaded."""
    time = timed(data)[0]
    read = data["measured_position"].values
    factor, text = axis([float(np.abs(read).max())], "position", str(data.attrs["motion"]))
    axes.plot(*thinned(time, read * factor), color=BLUE, label="as it was read")
    shade_wall(axes)
    for n, at in enumerate(time[data["status"].values != 0][:_MOST_GAPS]):
        axes.axvline(at, color=RED, lw=1, ls=":", label=None if n else "no good answer")
    axes.set_ylabel(text)
    legend(axes)


def draw_given_force(axes: Axes, data: xr.Dataset) -> None:
    """What the law asked for and what was given, both positive out of the wall."""
    time = timed(data)[0]
    wished, given = data["wished_force"].values, data["commanded_force"].values
    largest = max(float(np.abs(wished).max()), float(np.abs(given).max()))
    factor, text = axis([largest], "force", str(data.attrs["motion"]))
    steps: Any = {"drawstyle": "steps-post"}
    axes.plot(
        *thinned(time, wished * factor), color=BLACK, ls="--", lw=1, label="asked for by the law", **steps
    )
    axes.plot(*thinned(time, given * factor), color=PURPLE, lw=1.2, label="given", **steps)
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_ylabel(text)
    legend(axes)


def draw_recorded_lateness(axes: Axes, data: xr.Dataset) -> None:
    """How late each sample was; red where samples were missed before it."""
    time = timed(data)[0]
    late, passed = data["late"].values, np.diff(data["sample"].values, prepend=data["sample"].values[0] - 1)
    factor, text = axis([float(np.abs(late).max())], "time", text="late by")
    axes.plot(*thinned(time, late * factor), color=BLUE, lw=0.8)
    missed = passed > 1
    axes.plot(
        time[missed], late[missed] * factor, color=RED, marker=".", ms=4, ls="", label="after missed ones"
    )
    axes.set_ylabel(text)
    if missed.any():
        legend(axes)


_LEAST = 1e-8
"""What is less late is drawn as so late [s]."""

_BINS = 20
"""For each power of ten."""


@rc_context(LOOK)
def plot_lateness(checkup: Any) -> Figure:
    """Histogram of the lateness, of ordinary and of real-time turns, against the sample period.

    Parameters
    ----------
    checkup
        A `zwidth.servo.Checkup`, what `zwidth.servo.doctor` gives.
    """
    figure = new_figure(height=3.8)
    draw_lateness(figure.add_subplot(), checkup)
    return figure


def draw_lateness(axes: Axes, checkup: Any) -> None:
    """The same on axes of your own."""
    period = float(checkup.sample_period)
    kinds = [(checkup.ordinary, GREY, "ordinary thread", "--")]
    if checkup.real_time is not None:
        kinds.append((checkup.real_time, BLUE, "real-time priority", "-"))
    most = max(2 * period, *(2 * lateness.worst for lateness, *_ in kinds))
    decades = np.log10(most / _LEAST)
    edges = np.geomspace(_LEAST, most, int(np.ceil(_BINS * decades)) + 1)
    for lateness, colour, name, line in kinds:
        late = np.maximum(lateness.late, _LEAST)
        axes.hist(late, list(edges), histtype="step", color=colour, ls=line, lw=1.4, label=name)
        axes.plot([lateness.quantile(0.999)], [1.0], "v", color=colour, ms=6, mew=0)
    axes.axvline(period, color=ORANGE, lw=1.4, ls="-.", label="sample period")
    axes.plot([], [], "v", color=BLACK, ms=6, mew=0, label="99.9 % are earlier")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(0.7, None)
    axes.set_xlabel(with_unit("late by", "s"))
    axes.set_ylabel("steps")
    legend(axes)


Drawn = TypeVar("Drawn", "Evidence", "PairEvidence")

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
    figure = new_figure(height=6.0)
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
    swing = recording.position[part] - recording.position[part].mean()
    factor, text = axis(swing, "position", recording.motion)
    axes.plot(t, factor * recording.position[part], color=BLUE, label="position, on the left")
    axes.set_xlabel("time t [s]")
    axes.set_ylabel(text)
    beside = axes.twinx()
    beside.spines["right"].set_visible(True)
    for values, colour, line, name in (
        (recording.commanded, BLACK, "--", "commanded force"),
        (recording.applied, ORANGE, "-", "force of the motor"),
    ):
        if values is not None:
            beside.plot(t, values[part], color=colour, ls=line, lw=1.3, drawstyle="steps-post", label=name)
    beside.set_ylabel(label("force", recording.motion))
    legend(axes, [*axes.get_lines(), *beside.get_lines()])


def _spectrum(axes: Axes, recording: Recording, seen: Evidence | PairEvidence) -> None:
    """Amplitude against frequency, up to six times that of the vibration."""
    vibration = seen.vibration
    x = recording.position[vibration.rows]
    y = (x - np.polyval(np.polyfit(np.arange(x.size), x, 1), np.arange(x.size))) * np.hanning(x.size)
    size = 2 * np.abs(np.fft.rfft(y)) / np.hanning(x.size).sum()
    frequencies = np.fft.rfftfreq(x.size, recording.period)
    factor, text = axis(size, "position", "rotary" if seen.rotary else "linear", "amplitude")
    axes.semilogy(frequencies[1:], factor * size[1:] + 1e-12, color=BLUE)
    at = f"it shakes at {shown(vibration.frequency, 'Hz')}"
    axes.axvline(vibration.frequency, color=RED, ls="--", lw=1.2, label=at)
    axes.set_xlim(0, min(frequencies[-1], 6 * vibration.frequency))
    axes.set_ylim(bottom=factor * size.max() * 1e-4)
    axes.set_xlabel(label("frequency"))
    axes.set_ylabel(text)
    legend(axes)


def _energy(axes: Axes, seen: Evidence | PairEvidence) -> None:
    """A bar for each term of the energy of a cycle."""
    terms = {name: work for name, work in seen.supplied.items() if work}
    if seen.lost is not None:
        terms["friction"] = -seen.lost
    factor, text = axis(terms.values(), "energy", text="energy in a cycle")
    names = list(terms)[::-1]
    colours = [RED if terms[name] > 0 else GREY for name in names]
    axes.barh(names, [factor * terms[name] for name in names], color=colours)
    axes.axvline(0, color=BLACK, lw=0.8)
    axes.set_xlabel(text)
    heading(axes, "right: into the motion, left: out of it")


def pair_figure(recording: PairRecording, seen: PairEvidence | None, claim: str) -> Figure:
    """Both arms over some cycles; the spectrum of the one that swings further beside the energy of a cycle.

    Raises
    ------
    InputError
        If nothing vibrates: there is nothing to draw.
    """
    further = recording.arms[0 if seen is None else seen.leading]
    return figure_of(further, seen, claim, lambda axes, seen: _pair_cycles(axes, recording, seen))


def _pair_cycles(axes: Axes, recording: PairRecording, seen: PairEvidence) -> None:
    part = last_cycles(seen.vibration, recording.leader.period)
    moved = [arm.position[part] for arm in recording.arms]
    swings = np.concatenate([x - x.mean() for x in moved])
    factor, text = axis(swings, "position", recording.leader.motion)
    for x, (name, (colour, line)) in zip(moved, ARMS.items(), strict=True):
        axes.plot(recording.leader.time[part], factor * x, color=colour, ls=line, label=name)
    axes.set_xlabel("time t [s]")
    axes.set_ylabel(text)
    legend(axes)
