"""What is told of one document: what was wrong, the rows of what holds, and the numbers of a motion."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

from . import TINY, Case, plain
from .rotary import CASES as TURNING
from .whole import part, put_in_place, spring


def what_a_check_stops_at_is_told() -> str:
    """Nothing is accepted where memory or the checker's own wits end, or where there is no object."""
    one = part("one")

    def stopped(error: Exception) -> Any:
        def check(_: Any) -> Any:
            raise error

        kind = part("kinds").KINDS["spring"]._replace(check=check)
        with put_in_place("one", KINDS={"spring": kind}):
            return one.verify(spring(4))

    for error, said in (
        (MemoryError(), "the document is too large to be checked"),
        (TypeError("x" * 300), f"{one.STOPPED}: TypeError: {'x' * 200}"),
        (RecursionError("deep"), f"{one.STOPPED}: RecursionError: deep"),
    ):
        found = stopped(error)
        if found != one.Verified(False, said):
            return f"{error}: {found}"
    for told in ([], "spring", None, 4, {}, {"format": "zwidth verdict 1", "certificate": spring(4)}):
        if one.verify(told) != one.Verified(False, one.NO_KIND):
            return f"{told!r} is no object with a kind"
    return ""


def rows_of_what_holds() -> str:
    """In the units of the device; none of what is refused, whatever was read."""
    verify = part("one").verify
    turning = next(c for c in TURNING if not c.refusal and not callable(c.document))
    for document, unit in ((spring(4), "N·s/m"), (plain(turning.document), "N·m·s/rad")):
        units = {row.unit for row in verify(document).rows}
        if unit not in units:
            return f"{units} without {unit}"
    kind = part("kinds").KINDS["spring"]._replace(check=lambda _: part("kinds").Found("", False))
    with put_in_place("one", KINDS={"spring": kind}):
        return f"{found}" if (found := verify(spring(4))).rows or found.valid else ""


def a_motion_says_its_own_numbers() -> str:
    """Its energy to a part in 10⁹, its sample period exactly, if it says one; whatever T is."""
    kinds = part("kinds")
    for energy, period in ((Fraction(2), Fraction(10**12)), (Fraction(10**12), Fraction(2))):
        loop = SimpleNamespace(sample_period=period)
        for said, told, right in (
            (energy * (1 + TINY), None, ""),
            (energy * (1 - TINY), period, ""),
            (energy * (1 + 2 * TINY), None, "the energy is"),
            (energy * (1 - 2 * TINY), period, "the energy is"),
            (energy, period * (1 + TINY**2), "T is"),
            (energy, period * (1 - TINY**2), "T is"),
        ):
            read = SimpleNamespace(loop=loop, energy=said, sample_period=told)
            found = kinds._as_told(read, kinds.Found("", True, energy))
            if found.valid is bool(right) or right not in found.reason:
                return f"{said}, {told} of {energy}, {period}: {found}"
    return ""


def steps_of_either_arm_are_covered() -> str:
    """An encoder on one of two arms is one of the pair."""
    scope = part("scope")
    for leader, follower in ((0, 0), (1, 0), (0, 1)):
        arms = {n: SimpleNamespace(resolution=x) for n, x in (("leader", leader), ("follower", follower))}
        found = scope.of_a_pair("passive")(SimpleNamespace(loop=SimpleNamespace(**arms))).encoder
        if found != ("counted" if leader or follower else "ideal"):
            return f"{leader}, {follower}: {found}"
    hands = ("known", "beside a known one", "bounded", "every", "activity")
    return "" if hands == scope._FEWEST_FIRST else "the hands in another order"


CHECKS = [
    steps_of_either_arm_are_covered,
    what_a_check_stops_at_is_told,
    rows_of_what_holds,
    a_motion_says_its_own_numbers,
]
CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]
