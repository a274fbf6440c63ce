"""What `zwidth workspace --postures` prints: the stiffest wall over all postures that were tried."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from zwidth.cli.workspace_arm import arm_in_words
from zwidth.cli.workspace_joints import damping_in_words
from zwidth.cli.workspace_wall import wall_in_words

if TYPE_CHECKING:
    from zwidth.data.gains import BorneImpedance
    from zwidth.passivity.workspace import PostureMap


def print_postures(
    found: PostureMap,
    in_full: bool = False,
    without: Sequence[str] = (),
    better: BorneImpedance | None = None,
) -> None:
    """Print the verdict, the numbers, what was written and what is assumed on standard output."""
    from zwidth.cli.page import blocks, headline, items, more_with_all, page, section, small_print
    from zwidth.passivity.scope import TOLD
    from zwidth.passivity.wording import in_short

    asked = found.question
    with page() as out:
        out.print(headline(found.outcome, TOLD[found.outcome].terminal, found.claim))
        about = [
            ("arm", arm_in_words(asked.arm, asked.rate)),
            ("joint damping", damping_in_words(asked.arm)),
            ("wall", wall_in_words(asked.wall)),
            *(("left out", text) for text in without),
        ]
        if better is not None:
            about.append(("written", _written(better)))
        if in_full:
            blocks(out, list(found.rows()), about)
            section(out, "assumes", items(found.assumptions, "dim"))
            return
        assumed = ("assumes", small_print(in_short(found.scope, found.outcome)))
        blocks(out, list(found.rows()), [*about, assumed])
        more_with_all(out, "assumptions in full")


def _written(better: BorneImpedance) -> str:
    """The impedance in a line, and what of it was changed."""
    k, zeta = (
        ", ".join(f"{float(v):g}" for v in row[: better.size]) for row in (better.stiffness, better.factors)
    )
    units = "N/m" if better.size == len(better.stiffness) // 2 else "N/m, N·m/rad"
    return (
        f"K = {k} {units}; ζ = {zeta}: the condition holds at all of {better.found.tried} postures with "
        f"{float(100 * better.share):g} % of the joints' damping; between them nothing is proved"
    )
