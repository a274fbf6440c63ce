"""An answer is neither true nor false; passive means the same of all."""

from __future__ import annotations

from functools import cache

import pytest

import zwidth as zw
from zwidth.passivity.result import Answer

PADDLE = zw.catalogue.device("haptic-paddle")


@cache
def answers() -> dict[str, Answer]:
    """Of each kind."""
    arm = zw.arms.built_in("two-link", damping=(1.0, 1.0))
    return {
        "passive": zw.check(PADDLE, zw.Wall(250)),
        "active": zw.check(PADDLE, zw.Wall(770)),
        "bounding": zw.check_bounding(PADDLE, zw.render(zw.Wall(2000), zw.rendering.ForceBounding())),
        "worst hand": zw.worst_hand(PADDLE, zw.Wall(250), penetration=0.001, speed=0.1),
        "arm": zw.workspace(arm, zw.Wall(1), rate=1000),
    }


@pytest.mark.parametrize("name", ["passive", "active", "bounding", "worst hand", "arm"])
def test_passive_is_the_outcome_and_nothing_else(name: str) -> None:
    """True of a proof alone."""
    answer = answers()[name]
    assert answer.passive is (answer.outcome == "passive")


def test_both_are_among_them() -> None:
    """A passive one and an active one."""
    assert answers()["passive"].passive
    assert not answers()["active"].passive


@pytest.mark.parametrize("name", ["passive", "active", "bounding", "worst hand", "arm"])
def test_no_answer_is_true_or_false(name: str) -> None:
    """`if verdict:` would take every answer for a proof; the message says what to ask."""
    with pytest.raises(zw.InputError, match=r"neither true nor false: ask \.passive"):
        bool(answers()[name])
