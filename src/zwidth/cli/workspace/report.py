"""What `zwidth workspace` prints: the verdict, the numbers, what to change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from math import inf, isfinite
from typing import TYPE_CHECKING

from zwidth.cli.workspace.arm import arm_in_words, damping_in_words, wall_in_words
from zwidth.quantity.text import outward_decimal, shown, shown_at_least, shown_at_most

if TYPE_CHECKING:
    from zwidth.data.gains import BorneImpedance
    from zwidth.model.arms import Arm, ArmMotion, EncoderSteps
    from zwidth.passivity.workspace import NullSpace, PostureMap, Workspace


_FIRST = ("motion", "largest stiffness", "stiffness", "encoder steps")
_IN_SCOPE = ("region",)
_FEW = 3
"""What a short report has of the numbers; what it says in what is assumed; how many changes."""

_MAPPED = 2
"""Joints of a map of cells."""


def print_workspace(space: Workspace, in_full: bool = False, without: Sequence[str] = ()) -> None:
    """Print the verdict and what to change on standard output."""
    from zwidth.cli.page import blocks, claimed, grid, items, more_with_all, page, section, small_print
    from zwidth.passivity.wording import in_short

    with page() as out:
        out.print(claimed(space.outcome, space.claim))
        if in_full:
            every = list(_changes(space))
            blocks(out, [*_numbers(space), *(("left out", text) for text in without)])
            section(out, "what to change", [grid(every)] if every else [])
            section(out, "assumes", items(space.assumptions, "dim"))
            return
        first = [row for row in _numbers(space) if row[0] in _FIRST]
        told = any(advice.kind == "change" for advice in space.advice)  # the first, by the claim
        changes = islice(_changes(space), int(told), _FEW)  # each of them is a proof: no more than are shown
        do = [
            ("or" if told or place else "change", f"{name}: {text}")
            for place, (name, text) in enumerate(changes)
        ]
        arm = [row for row in _asked(space) if row[0] not in _IN_SCOPE]
        if len(getattr(space.arm, "joint_range", ())) > _MAPPED and hasattr(space.arm, "frame"):
            arm.append(("all joints", "--postures 20000 asks of all of them over their ranges"))
        arm += [("left out", text) for text in without]
        assumed = ("assumes", small_print(in_short(space.scope, space.outcome)))
        blocks(out, [*first, *do], [*arm, assumed])
        more_with_all(out, "margin, encoder, every change, assumptions in full")


def _numbers(space: Workspace) -> Iterator[tuple[str, str]]:
    yield from _asked(space)
    data, motion = space.data, space.motion
    kind, unit, where = ("margin", "N*s/m", "at the hand")
    if space.arm.turns:
        kind, unit, where = ("margin_in_joints", "N*m*s/rad", "in the worst direction of the joints")
    low, high = (shown(float(v), unit) for v in (data[kind].min(), data[kind].max()))
    yield "margin", f"{low} to {high} {where}"
    if space.largest_stiffness is None:
        factors = f"{outward_decimal(space.stiffness_factor, False):.4g} times at every point of the map"
        yield "stiffness", f"{factors}, {float(data['stiffness_factor'].max()):.4g} times at the best"
    else:
        best = shown_at_most(float(data["largest_stiffness"].max()), "N/m")
        everywhere = shown_at_most(space.largest_stiffness, "N/m")
        yield "largest stiffness", f"{everywhere} at every point of the map, {best} at the best"
    if motion is not None:
        yield "motion", _motion(motion, space.arm)
    if "resolution" in data:
        turned = ""
        if "rotational_resolution" in data:
            turned = f" and {shown(float(data['rotational_resolution'].max()), 'rad')}"
        yield "encoder step", f"up to {shown(float(data['resolution'].max()), 'm')}{turned} at the hand"
    if space.encoder_steps is not None:
        yield from _friction(space, space.encoder_steps)


def _asked(space: Workspace) -> Iterator[tuple[str, str]]:
    yield "arm", arm_in_words(space.arm, 1 / space.sample_period)
    yield "joint damping", damping_in_words(space.arm)
    yield "region", space.region
    yield "wall", wall_in_words(space.wall)
    if space.delay_samples:
        samples = f"{space.delay_samples} sample{'s' if space.delay_samples > 1 else ''}"
        yield "delay", f"{shown(space.delay_samples * space.sample_period, 's')}, {samples}"


def _motion(motion: ArmMotion, arm: Arm) -> str:
    middle = arm.at(motion.joints.mean(axis=0))
    gain, force = shown(-motion.energy, "J"), shown(motion.largest_force, "N")
    read = "" if motion.encoder == "ideal" else ", at the readings of the encoders"
    around = f"{len(motion.joints)} samples round {middle}"
    held = "" if motion.imposed_by == "end" else ", by hands that hold the links"
    return f"{around} take {gain} out, forces up to {force}{read}{held}"


def _friction(space: Workspace, steps: EncoderSteps) -> Iterator[tuple[str, str]]:
    """What the encoder steps ask of it, what there is, and up to which force that goes."""
    own = space.arm.coulomb_friction
    enough = ", ".join(shown(f, "N*m") for f in steps.friction)
    more = ", ".join(shown(f, "N*m") for f in steps.friction_per_force)
    has = f"it has {', '.join(shown(float(f), 'N*m') for f in own)}" if own else "it has none that is known"
    more = f"{more} more for each newton of the wall"
    joints = ", ".join(space.arm.joint_names)
    yield "Coulomb friction", f"{enough} in {joints}, and {more}, cover the steps; {has}"
    from zwidth.model.arms.encoders import in_words

    covered = f"covered up to {in_words(steps.covered)}" if steps.covered else "covered at no force"
    known = (
        "" if steps.refuted is None else f"; from {shown(steps.refuted, 'N')} on a motion takes energy out"
    )
    yield "encoder steps", covered + (known if own else "")


def _changes(space: Workspace) -> Iterator[tuple[str, str]]:
    if not any(space.added.to_all.enough):
        return
    if 0 < space.stiffness_factor < inf:
        yield "wall", _softer(space)
    from zwidth.passivity.workspace.verdict import told_additions

    enough, fails = space.added.least
    total, too_little = sum(enough), sum(fails)
    parts = told_additions(space.arm, enough)
    together = f", together {_enough(total)}" if ", " in parts else ""
    yield "least in all", f"more damping, {parts}{together}{_too_little(too_little)}"
    enough, fails = space.added.to_all
    yield "all joints", f"{_enough(enough[0])} more damping in each{_too_little(fails[0])}"
    for joint, (enough, fails) in enumerate(space.added.alone):
        if isfinite(enough[joint]):
            text = f"{_enough(enough[joint])} more damping{_too_little(fails[joint])}"
            yield f"{space.arm.joint_names[joint]} alone", text


def _softer(space: Workspace) -> str:
    """How stiff a wall is proved, and beyond what a point of the map fails."""
    fails, k, proved = space.stiffness_factor, space.largest_stiffness, space.proved_softer
    most = proved or fails
    if k is None:
        text = f"its stiffness times {outward_decimal(most, False):.4g}, and no more"
        beyond = f"{outward_decimal(fails, True):.4g} times"
    else:
        text = f"no stiffer than {shown_at_most(k * most / fails, 'N/m')}"
        beyond = shown_at_least(k, "N/m")
    return f"{text}; more than {beyond} fails" if proved else f"{text}, by the points of the map alone"


def _too_little(fails: float) -> str:
    """Below which less of it fails at some point of the map, where that is known."""
    return f"; less than {shown_at_most(fails, 'N*m*s/rad')} fails" if fails else ""


def _enough(damping: float) -> str:
    return shown_at_least(damping, "N*m*s/rad")


def print_postures(
    found: PostureMap,
    in_full: bool = False,
    without: Sequence[str] = (),
    better: BorneImpedance | None = None,
) -> None:
    """Print what is found of all postures, and what was written."""
    _print(found, in_full, without, [] if better is None else [("written", _written(better))])


def print_null_space(found: NullSpace, in_full: bool, without: Sequence[str]) -> None:
    """Print what is found of a wall and a null-space spring together."""
    spring = found.spring
    rest = found.question.arm.at(spring.rest, 3)
    told = (
        f"{shown(spring.stiffness, 'N*m/rad')}, {shown(spring.damping, 'N*m*s/rad')}, at rest at {rest}; "
        f"λ = {spring.regularization:g}; its torque is computed once a sample and held"
    )
    _print(found, in_full, without, [], ("null space", told))


def _print(
    found: PostureMap | NullSpace,
    in_full: bool,
    without: Sequence[str],
    last: Sequence[tuple[str, str]],
    *asked: tuple[str, str],
) -> None:
    """The verdict, the numbers, what was asked and what is assumed, on standard output."""
    from zwidth.cli.page import blocks, claimed, items, more_with_all, page, section, small_print
    from zwidth.passivity.wording import in_short

    question = found.question
    about = [
        ("arm", arm_in_words(question.arm, question.rate)),
        ("joint damping", damping_in_words(question.arm)),
        ("wall", wall_in_words(question.wall)),
        *asked,
        *(("left out", text) for text in without),
        *last,
    ]
    with page() as out:
        out.print(claimed(found.outcome, found.claim))
        if in_full:
            blocks(out, list(found.rows()), about)
            section(out, "assumes", items(found.assumptions, "dim"))
            return
        assumed = ("assumes", small_print(in_short(found.scope, found.outcome)))
        blocks(out, list(found.rows()), [*about, assumed])
        more_with_all(out, "assumptions in full")


def _written(better: BorneImpedance) -> str:
    k, zeta = (
        ", ".join(f"{float(v):g}" for v in row[: better.size]) for row in (better.stiffness, better.factors)
    )
    units = "N/m" if better.size == len(better.stiffness) // 2 else "N/m, N·m/rad"
    return (
        f"K = {k} {units}; ζ = {zeta}: the condition holds at all of {better.found.tried} postures with "
        f"{shown(better.share, '%', 6)} of the joints' damping; between them nothing is proved"
    )
