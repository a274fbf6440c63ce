"""A loop that a page can play, and all that the page shows of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.operator import LinearHand
from zwidth.model.pairs import Pair
from zwidth.passivity.result import Answer
from zwidth.passivity.scope import COLOUR
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import in_words, shown, unit_text


@dataclass(frozen=True, kw_only=True, eq=False)
class Played:
    """A loop that a page can play: made by `played` or `played_pair`.

    Parameters
    ----------
    name
        What the page calls it.
    loop
        (device, environment), or (pair,).
    hand
        Mass, stiffness and damping of the hand at the handle.
    start
        Where handle and hand begin [m; rad].
    follower
        What holds the follower of a pair where it begins.
    verdict
        On the loop.
    law
        The text of the law's module; "" for a pair.
    arms
        What the engine needs of each arm, SI.
    reach
        The page shows positions from −reach to reach [m; rad].
    do, notice
        What to do, and what to look for.
    """

    name: str
    loop: tuple[Device, Environment] | tuple[Pair]
    hand: LinearHand
    start: float
    follower: LinearHand
    verdict: Answer
    law: str
    arms: list[dict[str, Any]]
    reach: float
    do: str
    notice: str

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return self.loop[0].motion

    def facts(self) -> dict[str, Any]:
        """All that the page shows and runs, but the law, as plain data."""
        units = {name: GLOSSARY[name].unit_for(self.motion) for name in ("position", "velocity", "force")}
        return {
            "name": self.name,
            "motion": self.motion,
            "do": self.do,
            "notice": self.notice,
            "outcome": self.verdict.outcome,
            "colour": COLOUR[self.verdict.outcome],
            "claim": self.verdict.claim,
            "assumptions": list(self.verdict.small_print()),
            "numbers": list(self._numbers()),
            "keys": {name: unit_suffix(unit) for name, unit in units.items()},
            "force_unit": unit_text(units["force"]),
            "reach": self.reach,
            "often": self.loop[0].own_readings if isinstance(self.loop[0], Pair) else 1,
            "one_sided": len(self.loop) == 2 and self.loop[1].unilateral,
            "arms": self.arms,
        }

    def _numbers(self) -> Iterator[tuple[str, str, str]]:
        """Symbol, name and value of what the loop is made of."""
        if isinstance(self.loop[0], Pair):
            pair = self.loop[0]
            same = pair.leader == pair.follower
            yield "", "coupling", pair.describe()
            yield from _device_numbers(pair.leader, "" if same else " of the leader")
            if not same:
                yield from _device_numbers(pair.follower, " of the follower")
            yield from _hand_numbers("spring that holds the follower", self.follower, self.motion)
        else:
            device, environment = self.loop[0], self.loop[-1]
            assert isinstance(environment, Environment)
            yield "", "law", environment.describe(device.motion)
            yield from _device_numbers(device)
        yield from _hand_numbers("hand", self.hand, self.motion)


def _device_numbers(device: Device, whose: str = "") -> Iterator[tuple[str, str, str]]:
    for key, value in device.parameters().items():
        own = GLOSSARY[key]
        yield own.symbol, f"{in_words(key)}{whose}", shown(value, own.unit_for(device.motion))


def _hand_numbers(name: str, hand: LinearHand, motion: str) -> Iterator[tuple[str, str, str]]:
    """On one line; what is 0 is not there."""
    given = [
        (symbol, shown(value, GLOSSARY[key].unit_for(motion)))
        for symbol, (key, value) in zip(("m_h", "k", "c"), hand._asdict().items(), strict=True)
        if value
    ]
    if given:
        yield ", ".join(symbol for symbol, _ in given), name, ", ".join(text for _, text in given)
