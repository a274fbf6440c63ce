"""What `zwidth workspace --postures` prints: the stiffest wall over all postures that were tried."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from zwidth.cli.workspace_arm import arm_in_words
from zwidth.cli.workspace_joints import damping_in_words
from zwidth.cli.workspace_wall import wall_in_words

if TYPE_CHECKING:
    from zwidth.passivity.workspace import PostureMap


def print_postures(found: PostureMap, in_full: bool = False, without: Sequence[str] = ()) -> None:
    """Print the verdict, the numbers and what is assumed on standard output."""
    from zwidth.cli.page import blocks, headline, items, more_with_all, page, section, small_print
    from zwidth.passivity.in_short import in_short
    from zwidth.passivity.outcome import TOLD

    asked = found.question
    with page() as out:
        out.print(headline(found.outcome, TOLD[found.outcome].terminal, found.claim))
        about = [
            ("arm", arm_in_words(asked.arm, asked.rate)),
            ("joint damping", damping_in_words(asked.arm)),
            ("wall", wall_in_words(asked.wall)),
            *(("left out", text) for text in without),
        ]
        if in_full:
            blocks(out, list(found.rows()), about)
            section(out, "assumes", items(found.assumptions, "dim"))
            return
        assumed = ("assumes", small_print(in_short(found.scope, found.outcome)))
        blocks(out, list(found.rows()), [*about, assumed])
        more_with_all(out, "assumptions in full")
