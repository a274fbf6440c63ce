"""Device and hand between two samples, exactly, for a page or a bench that plays the device.

    M ẍ = F − f_a − b ẋ − f_c sgn ẋ + k (x_a − x) + c (ẋ_a − ẋ)        M = m + m_h

with the stops, the stiction, the turns and the energies of `loop.step`: the same operations, the same bits.
Motor and handle with a transmission between them move by the series of `loop.two_masses`.
"""

from __future__ import annotations

from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.loop import two_bodies, two_masses
from zwidth.loop.plant import (
    FORCE,
    GOAL,
    STATE_SIZE,
    WORK,
    Plant,
    first_zero,
    free_response,
    integral,
    product_integral,
    value,
)
from zwidth.loop.step import advance, book
from zwidth.loop.two_bodies import TwoMasses
from zwidth.loop.two_masses import advance_two
from zwidth.machine.firmware.javascript import KEYWORDS, JavaScript
from zwidth.machine.firmware.program import Cells, Program, Variable
from zwidth.machine.firmware.specialise import specialised
from zwidth.native.compiled import Array
from zwidth.quantity.elementary import exp, expm1, log, log1p

Hand = Literal["free", "anchored"]
"""A force alone; or a spring and a damper to an anchor that moves, as well."""

_APART = (exp, expm1, log, log1p, free_response, product_integral, book)
_OF_TWO = (*_APART, first_zero, integral, value, *two_masses.PARTS)

_PLACES = (
    ("POSITION", "m, or rad"),
    ("VELOCITY", "m/s"),
    ("DIRECTION", "sign of the velocity, 0 at rest"),
    ("FORCE", "N: of the actuator now"),
    ("GOAL", "N: where that goes to"),
    ("HAND_WORK", "J since the beginning: what the hand put in"),
    ("ACTUATOR_WORK", "J: what the actuator put in"),
    ("VISCOUS", "J: lost in damping"),
    ("COULOMB", "J: lost in dry friction"),
    ("SOURCE_WORK", "J: what muscles put in"),
    ("HAND_LOSS", "J: lost in the hand's damper"),
    ("STOPS", "how often it came to rest or turned round"),
    ("FAULT", "not 0 if the step gave up"),
)
_PLACES_OF_TWO = (
    ("MOTOR", "m, or rad: of the motor, POSITION is of the handle"),
    ("MOTOR_VELOCITY", "m/s"),
    ("MOTOR_DIRECTION", "sign of the velocity, 0 at rest"),
    ("MOTOR_VISCOUS", "J: of VISCOUS what was lost at the motor"),
    ("MOTOR_COULOMB", "J: of COULOMB what was lost at the motor"),
    ("INSIDE_LOSS", "J: lost in the transmission's damper"),
)


def one_period(
    state: Array,
    work: Array,
    plant: Plant,
    force: float,
    push: float,
    anchor: float,
    anchor_speed: float,
    period: float,
) -> None:
    """The command of this sample acts from now on, then the plant moves by a period T [s].

    `force` f of the law and `push` F of the hand [N; N·m]; `anchor` x_a at the beginning [m; rad], its speed
    ẋ_a [m/s; rad/s]; state and work as `loop.step.advance` has them.
    """
    state[GOAL] = force
    if plant.lag == 0.0 and plant.slew == 0.0:
        state[FORCE] = force
    advance(state, plant, push, anchor, anchor_speed, period, work)


def one_period_of_two(
    state: Array,
    work: Array,
    two: TwoMasses,
    force: float,
    push: float,
    anchor: float,
    anchor_speed: float,
    period: float,
) -> None:
    """As `one_period`, of motor and handle; state and work as `loop.two_masses.advance_two` has them."""
    state[GOAL] = force
    if two.motor.lag == 0.0 and two.motor.slew == 0.0:
        state[FORCE] = force
    advance_two(state, two, push, anchor, anchor_speed, period, -1, work)


def given_plant(*, amplified: bool) -> Plant:
    """A plant whose numbers are given at every call; without those of an amplifier where there is none."""
    numbers = Plant(*(Variable("real", name) for name in Plant._fields))  # type: ignore[arg-type]
    return numbers if amplified else numbers._replace(lag=0.0, slew=0.0)


def given_two() -> TwoMasses:
    """Motor and handle whose numbers are given at every call, without an amplifier; a hand that pushes."""
    motor = given_plant(amplified=False)._replace(hand_mass=0.0, stiffness=0.0, hand_damping=0.0)
    own: dict[str, Any] = {
        f: Variable("real", f"handle_{f}") for f in ("mass", "damping", "coulomb", "stiction")
    }
    spring: Any = Variable("real", "spring")
    damper: Any = Variable("real", "damper")
    return TwoMasses(motor, given_plant(amplified=False)._replace(**own), spring, damper, 0.0, 0.0)


def plant_program(plant: Plant | TwoMasses | None, period: float | None, hand: Hand) -> Program:
    """The program of one period.

    Some numbers of the plant may be a `given_plant`'s, or `given_two`'s; without it, or without a period
    T > 0 [s], they are given at every call, the period last.
    """
    if period is not None and not period > 0.0:
        raise InputError(f"the plant is moved from sample to sample: a period is > 0 s, got {period!r}")
    held = plant.handle if isinstance(plant, TwoMasses) else plant
    if hand == "free" and held is not None and (held.stiffness != 0.0 or held.hand_damping != 0.0):
        raise InputError("this hand has a spring or a damper: they need an anchor, take hand='anchored'")
    anchor = (
        [Variable("real", "anchor"), Variable("real", "anchor_speed")] if hand == "anchored" else [0.0, 0.0]
    )
    length = Variable("real", "period") if period is None else float(period)
    given = Variable("real", "force"), Variable("real", "push"), *anchor, length
    if isinstance(plant, TwoMasses):
        both = Cells("state", two_bodies.STATE_OF_TWO), Cells("work", two_bodies.SERIES_OF_TWO)
        return specialised(one_period_of_two, (*both, plant, *given), _OF_TWO)
    numbers = plant or given_plant(amplified=True)
    if plant is None and hand == "free":
        numbers = numbers._replace(stiffness=0.0, hand_damping=0.0)
    cells = Cells("state", STATE_SIZE), Cells("work", WORK)
    return specialised(one_period, (*cells, numbers, *given), _APART)


def laid_out(program: Program) -> tuple[int, int, list[tuple[int, str, str]], list[str]]:
    """How long state and work are, what is where in the state, and what of it stands where a touch begins."""
    state, work = (cells.size for cells in program.cells)
    of_two = () if state == STATE_SIZE else enumerate(_PLACES_OF_TWO, STATE_SIZE)
    places = [(k, place, meaning) for k, (place, meaning) in (*enumerate(_PLACES), *of_two)]
    return state, work, places, [place for _, place, _ in places if place in ("POSITION", "MOTOR")]


def plant_module(program: Program) -> str:
    """The ES module of such a program: `init`, `step`, and where in `state` everything is."""
    js = JavaScript(program, KEYWORDS)
    state, work, places, begin = laid_out(program)
    body = js.lines()
    functions = js.function_lines()
    lines = [
        *(f"export const {place} = {k}; // {meaning}" for k, place, meaning in places),
        "",
        *js.table_lines(),
        *js.helper_lines(),
        "",
        *functions,
        "/* At rest at this position, no force, no energy counted. */",
        "export function init(position) {",
        f"    const s = {{ state: new Float64Array({state}), work: new Float64Array({work}) }};",
        *(f"    s.state[{place}] = position;" for place in begin),
        "    return s;",
        "}",
        "",
        "/* One period under the law's force, which opposes penetration, and the hand's push. */",
        f"export function step(s{''.join(f', {v.hint}' for v in program.parameters)}) {{",
        *body,
        "}",
    ]
    return "\n".join(lines) + "\n"
