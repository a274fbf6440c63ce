"""What takes longer than a move may, as functions of a state for a process of its own.

What comes back is lists of numbers to draw, in SI.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.environment import Environment, Wall
from zwidth.model.operator import OPERATORS, ParametricOperator
from zwidth.model.operator.named import usual_kind
from zwidth.model.specification.load import pair_of
from zwidth.model.specification.read import Specification
from zwidth.model.specification.table import Table, quoted
from zwidth.passivity.check import check, check_by_closed_forms
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.value_iteration_fallback import has_gap
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.witness import Witness
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.spoken import answers_in
from zwidth.quantity.text import shown
from zwidth.show.explorer.state import State

if TYPE_CHECKING:
    from zwidth.show.plots.replay import Replay


LONGEST_TOUCH = 5.0
"""Of a touch that the page simulates [s]."""

MOST_SAMPLES = 100_000
"""Of such a touch."""

DURATION = 1.0
"""Of a touch where nothing else is said [s]."""

CELLS = 48
"""Of a region along each side."""


class Touch(NamedTuple):
    """A touch: times [s], positions [m; rad], forces [N; N·m], work of the hand [J]; whether of a wall."""

    times: list[float]
    positions: list[float]
    hand_forces: list[float]
    actuator_forces: list[float]
    works: list[float]
    operator: str
    extracted: float
    peak_force: float
    one_sided: bool


class Region(NamedTuple):
    """Walls: 3 passive, 2 passive while contact is kept, 1 quiet up to `speed`, 0 none of these."""

    stiffest: float
    most_damping: float
    kinds: list[list[int]]
    speed: float
    not_covered: str


class Row(NamedTuple):
    """One chain of laws: its name, outcome and claim, energy that the hand got out [J], largest force."""

    name: str
    outcome: str
    claim: str
    extracted: float | None
    peak_force: float | None
    message: str


def operator_of(state: State) -> ParametricOperator:
    """The hand that touches the loop; the usual one of its device where none is chosen."""
    values = dict(state.extras.get("operator", {}))
    values.pop("type", None)
    name = hand_kind_of(state)
    if name not in OPERATORS:
        raise InputError(f"there is no hand {quoted(name)}; {suggestion(name, OPERATORS)}")
    kind: type[ParametricOperator] = OPERATORS[name]
    Table("operator", values).check_keys(parameters_of(kind), f"the hand {quoted(name)}")
    return kind(**values)


def hand_kind_of(state: State) -> str:
    chosen = state.extras.get("operator", {}).get("type")
    return usual_kind(state.loop().device) if chosen is None else str(chosen)


def touched(state: State) -> Touch:
    loop = state.loop()
    return _touch(loop.device, loop.environment, operator_of(state))


def _touch(device: Any, environment: Environment, hand: ParametricOperator) -> Touch:
    from zwidth.loop.energy import ledger
    from zwidth.loop.simulate import simulated
    from zwidth.show.plots.traces import thinned

    period = float(device.motor_side.exact("sample_period"))
    duration = min(DURATION, LONGEST_TOUCH, MOST_SAMPLES * period)
    begins = _beginning(environment)
    met: Any = environment.met
    moved = met.replace(positions=[x.fraction - begins for x in met.positions]) if begins else met
    trace = simulated(device, environment.around(moved), hand, duration)
    times = trace["time"].values
    said, place = hand.describe(device.motion), shown(float(begins), device.unit("position"))

    def curve(name: str) -> list[float]:
        values = np.nan_to_num(trace[name].values, posinf=0.0, neginf=0.0)
        return list(np.interp(instants, times, values))

    instants = np.unique(
        np.concatenate([thinned(times, trace[name].values)[0] for name in ("position", "hand_work")])
    )
    force = float(np.nanmax(np.abs(trace["actuator_force"].values)))
    return Touch(
        instants.tolist(), [float(begins) + x for x in curve("position")],
        curve("hand_force"), curve("actuator_force"), curve("hand_work"),
        f"{said}; from {place} on, where the law begins" if begins else said,
        float(ledger(trace).extracted), force, environment.unilateral,
    )  # fmt: skip


def _beginning(environment: Environment) -> Fraction:
    """Where a spring that does nothing around 0, such as the lock of a wheel, begins; 0 of any other law."""
    points = environment.met.points
    begins = max(points[0][0].fraction, Fraction(0)) if points and points[0][1] == 0 else Fraction(0)
    for (low, before), (high, force) in pairwise(points):
        if before == force == 0 and low.fraction <= begins < high.fraction:
            begins = high.fraction
    return begins


def region_of(state: State) -> Region:
    """The walls around this one that the device can render."""
    from zwidth.study.maps.walls import z_width

    loop = state.loop()
    wall = loop.environment
    if not isinstance(wall, Wall):
        raise InputError(
            "the region is of walls with a spring and a damper; choose the wall as environment, without laws"
        )
    stiffest = 2.5 * max(middle(wall.stiffness), _LEAST)
    most = 2.5 * max(abs(middle(wall.damping)), 0.6 * float(loop.device.motor_side.exact("damping")), _LEAST)
    found = z_width(
        loop.device, (0, stiffest), (0, most), (CELLS, CELLS),
        velocity_filter=wall.velocity_filter, hands={}, workers=1, progress=lambda *_: None,
    )  # fmt: skip
    layers = [found[name].values for name in ("passive", "passive_sustained", "quiet")]
    kinds = np.where(layers[0], 3, np.where(layers[1], 2, np.where(layers[2], 1, 0)))
    speed = float(found["quiet"].attrs["speed"])
    return Region(stiffest, most, kinds.tolist(), speed, str(found.attrs["not_covered"]))


_LEAST = 1e-6


def middle(value: Exact | Interval) -> float:
    """A number, or the middle of an interval."""
    low, high = ends(value)
    return float(low + high) / 2


def moved(state: State) -> Replay:
    """The motion that takes energy out, sample by sample."""
    from zwidth.show.plots.replay import replay

    loop = state.loop()
    verdict = check(loop.device, loop.environment, progress=lambda _: None)
    found = verdict.witness
    if isinstance(found, Witness):
        return replay(found)
    if found is not None:
        raise InputError(
            f"a motion was found by iterating values, which is told in words alone: {found.describe()}"
        )
    if verdict.outcome == "active":
        raise InputError("the loop is active, and no motion that shows it is short enough to be written down")
    raise InputError(f"the loop is {verdict.outcome}: there is no motion that takes energy out of it to show")


def compared(state: State) -> list[Row]:
    """The environment alone, then behind one law after the other, under the same hand."""
    from zwidth.model.rendering import render

    loop, hand = state.loop(), operator_of(state)
    laws = getattr(loop.environment, "laws", ())
    met = loop.environment.environment if laws else loop.environment  # type: ignore[attr-defined]
    rows = []
    for count in range(len(laws) + 1):
        rendered = render(met, *laws[:count]) if count else met
        name = " + ".join(
            ["the environment", *(str(law["type"]).replace("-", " ") for law in state.laws[:count])]
        )
        rows.append(_row(name, loop.device, rendered, hand))
    return rows


def _row(name: str, device: Any, environment: Environment, hand: ParametricOperator) -> Row:
    outcome = claim = message = ""
    try:
        verdict = check(device, environment, progress=lambda _: None)
        outcome, claim = str(verdict.outcome), verdict.claim
    except InputError as error:
        message = str(error)
    try:
        touch = _touch(device, environment, hand)
    except InputError as error:
        return Row(name, outcome, claim, None, None, message or str(error))
    return Row(name, outcome, claim, touch.extracted, touch.peak_force, message)


COUPLING_KEYS = ("stiffness", "damping", "local_damping", "link_delay")
"""Of two arms, what the page has on sliders."""


def pair_tables(state: State) -> dict[str, Table]:
    """This device twice, joined as the page says."""
    values = dict(state.extras.get("coupling", {}))
    return {"device": Table("device", dict(state.device)), "coupling": Table("coupling", values)}


def linked(state: State) -> tuple[list[float], list[float]]:
    """Delays of the link [s], and the largest passive stiffness of two arms at each [N/m; N·m/rad]."""
    from zwidth.show.plots.pair import link_limits

    delays, stiffness = link_limits(pair_of(pair_tables(state)))
    return delays.tolist(), stiffness.tolist()


def advised(state: State) -> list[str]:
    """What to change of two arms, or how far each parameter may go."""
    verdict = check(pair_of(pair_tables(state)))
    return [one.text for one in verdict.advice if one.to is not None]


def answered(work: Callable[[State], Any], state: State) -> Any:
    """What some work finds of a state, in the angles in which its page answers."""
    with answers_in(*state.angles):
        return work(state)


def reported(state: State) -> str:
    """The report on the loop as one page of HTML."""
    from zwidth.show.report import html

    loop = state.loop()
    return html(check(loop.device, loop.environment, progress=lambda _: None))


def played_page(state: State) -> str:
    """A page on which a person plays the loop: the same law, at its rate."""
    from zwidth.show.explorer.play import play_page, played

    loop = state.loop()
    verdict = check(loop.device, loop.environment, progress=lambda _: None)
    return play_page([played(loop.device, loop.environment, verdict)])


# The verdict on a loop in two steps: what is known at once, and what takes a while.


LARGEST = 24
"""Order of H(z) and samples of delay together, up to which a verdict comes at once."""


class Judged(NamedTuple):
    """What is known of a loop at once.

    `verdict`: None where there is none at once.
    `final`: False where `judged_in_full` may say more.
    """

    loop: Specification
    verdict: Verdict | None
    final: bool


def judged_at_once(loop: Specification) -> Judged:
    """The verdict by closed forms, in milliseconds, where there is one."""
    device, law = loop.device, loop.environment
    if device.transmission is not None or not law.has_transfer_function or _is_large(loop):
        return Judged(loop, None, final=False)
    verdict = check_by_closed_forms(device, law)
    return Judged(loop, verdict, final=not has_gap(device, law, verdict))


def _is_large(loop: Specification) -> bool:
    device, law = loop.device, loop.environment
    if not (device.is_certain and law.is_certain):
        return True  # as many loops as there are corners
    found = linear_loop(device, law)
    return len(found.denominator) + found.whole_delay > LARGEST


def judged_in_full(state: State) -> Verdict:
    """What `zwidth.check` says, for a process of its own."""
    loop = state.loop()
    verdict = check(loop.device, loop.environment, progress=lambda _: None)
    if isinstance(verdict, LinearVerdict):
        _ = verdict.limit, verdict.max_stiffness, verdict.required_damping, verdict.advice
    if not isinstance(verdict, Verdict):
        raise InputError("the page shows loops of one device")
    return verdict
