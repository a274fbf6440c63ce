"""The worst hand there is, against one loop: a storage function, or a motion that gains."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.passivity.outcome import TOLD, Outcome
from zwidth.passivity.scope import Contact, Hands, Law, Scope, scope_of
from zwidth.passivity.witness import rounded_energy
from zwidth.passivity.wording import claim_of_passivity, lines
from zwidth.passivity.worst_hand.board import Board, Domain
from zwidth.passivity.worst_hand.domain import domain_for, losses_of
from zwidth.passivity.worst_hand.gain import Gain, gain
from zwidth.passivity.worst_hand.law import FiniteLaw, finite_law
from zwidth.passivity.worst_hand.losses import Losses
from zwidth.passivity.worst_hand.play_relaxing import play_relaxing
from zwidth.passivity.worst_hand.relaxing import RelaxingBoard
from zwidth.passivity.worst_hand.row_game import RowGame, row_game
from zwidth.passivity.worst_hand.solve import Played, play
from zwidth.passivity.worst_hand.storage import Storage
from zwidth.quantity.exact import RealLike
from zwidth.rendering.rendered import Rendered

if TYPE_CHECKING:
    import xarray as xr

STEPS = (8, 16, 32, 64)
"""Steps in which a count is cut, coarse to fine, when a proof is sought."""

FINE = (1024, 16384)
"""The same when a motion is sought; its knots lie near the edges."""


@dataclass(frozen=True)
class WorstHand:
    """What the worst hand can do to one loop, contact made and broken, the encoder as it is.

    Attributes
    ----------
    outcome
        "passive": a storage function proves that no motion within the domain gains.
        "active": a motion gains in every round.  "undecided": neither was found.
    scope
        What it is about: the hands, within which bounds; contact; what of the actuator is counted.
    device, environment
        The loop.
    certificate, witness
        The evidence; the one that does not apply is None.
    storage
        The storage function, to look at; None unless passive.
    """

    outcome: Outcome
    scope: Scope
    device: Device
    environment: Environment
    certificate: Certificate | None
    witness: Gain | None
    storage: Storage | None

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "passive":
            return claim_of_passivity(self.scope, False)
        if self.witness is not None:
            return f"A motion of the hand takes energy out of this loop: {self.witness.describe()}."
        return "Neither a proof nor a motion was found: finer steps, or more time, may decide."

    def available_storage(self) -> xr.DataArray:
        """V(x) for each reading before [J]: the most that a hand can take out from there.

        Raises
        ------
        InputError
            If the loop is not passive: a hand can take out without end.
        """
        if self.storage is None:
            raise InputError(
                f"there is no available storage: the loop is {self.outcome}, and what a hand can take out "
                "of an active loop has no bound"
            )
        return self.storage.to_xarray()

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the outcome covers and takes for granted, line by line."""
        return lines(self.scope, self.outcome)

    def to_dict(self, evidence: bool = True) -> dict[str, Any]:
        """Outcome, assumptions and evidence as plain data; the evidence may be left out, it can be large."""
        document: dict[str, Any] = {
            "format": "zwidth worst hand 1",
            "outcome": self.outcome,
            "claim": self.claim,
            "scope": self.scope.to_dict(),
            "assumptions": list(self.assumptions),
        }
        if not evidence:
            return document
        if self.certificate is not None:
            document["certificate"] = self.certificate.to_dict()
        if self.witness is not None:
            document["witness"] = rounded_energy(self.witness.to_dict())
        return document

    def save(self, path: str | Path) -> None:
        """Write the outcome with its evidence as JSON for `zwidth verify`."""
        save_json(path, self.to_dict())

    def __repr__(self) -> str:
        return f"<WorstHand {self.outcome}: {self.claim}>"

    def _repr_html_(self) -> str:
        assumed = "".join(f"<li>{a}</li>" for a in self.assumptions)
        colour = TOLD[self.outcome].colour
        return f"<div><b style='color:{colour}'>{self.outcome}</b> {self.claim}<ul>{assumed}</ul></div>"


@dataclass(frozen=True)
class Game:
    """One loop and one domain, to be played with either set of rules."""

    law: FiniteLaw
    losses: Losses
    domain: Domain
    motion: str

    @property
    def hands(self) -> Hands:
        """The hands that a proof covers."""
        domain, resolution = self.domain, self.losses.resolution
        inside = float((domain.highest + 1) * resolution)
        outside = None
        if self.law.surface == "none":
            outside = inside
        elif self.law.relaxing is not None and self.law.surface == "position":
            outside = float(-domain.lowest * resolution)
        return Hands(
            speed=float(domain.speed * resolution / self.losses.period),
            in_each_part=self.losses.part != 1,
            inside=inside,
            outside=outside,
            resolution=float(resolution),
        )

    @property
    def contact(self) -> Contact:
        """What is covered of contact."""
        return "both sides" if self.law.surface == "none" else "made and broken"

    @property
    def actuator(self) -> tuple[bool, bool]:
        """Whether force limit and converter steps are counted in."""
        return self.law.force_limit is not None, self.law.force_step is not None

    @property
    def inexact(self) -> tuple[Law, ...]:
        """What of the law is not exact."""
        if self.law.power is None or self.law.power[1].denominator == 1:
            return ()
        return ("rounded power",)

    def prove(
        self, steps: int, deadline: float = float("inf"), tell: Tell | None = None, on: str = "cpu"
    ) -> Storage | None:
        """A storage function on so many steps per count that the checker accepts, or None."""
        played = self._play(steps, "generous", deadline, tell, on)
        if played.value is None:
            return None
        return Storage(played, self.motion)

    def refute(
        self, steps: int, deadline: float = float("inf"), tell: Tell | None = None, on: str = "cpu"
    ) -> Gain | None:
        """A motion that gains, recomputed exactly, or None."""
        if self.domain.within.highest < 1:  # no reading inside lies within the bounds
            return None
        played = self._play(steps, "strict", deadline, tell, on)
        return gain(played, self.motion) if played.cycle else None

    def _play(self, steps: int, rules: Any, deadline: float, tell: Tell | None, on: str) -> Played:
        domain = self.domain.within if rules == "strict" else self.domain
        if self.law.relaxing is not None:
            if on != "cpu":
                raise InputError("a law that relaxes is played on the processor: leave out on")
            levels = max(1, steps // 8) if rules == "generous" else 2
            board = RelaxingBoard(self.law, self.losses, domain, steps, rules, levels)
            return play_relaxing(board, deadline, tell)
        return play(Board(self.law, self.losses, domain, steps, rules), deadline, tell, on)


Tell = Callable[[int], None]


def game_of(
    device: Device,
    environment: Environment | Any,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
) -> Game | RowGame:
    """The game of a loop; arguments as for `worst_hand`."""
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, got {type(device).__name__}")
    if friction is not None and not isinstance(friction, FrictionCurve):
        raise InputError(f"friction is a FrictionCurve, got {type(friction).__name__}")
    given = as_environment(environment)
    if isinstance(given, Rendered):
        return row_game(device, given, penetration, speed, force_limit, force_resolution, friction)
    law = finite_law(device, given, force_limit=force_limit, force_resolution=force_resolution)
    losses = losses_of(device, friction)
    return Game(law, losses, domain_for(law, losses, penetration, speed), device.motion)


def worst_hand(
    device: Device,
    environment: Environment | Any,
    *,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    seconds: float = 60.0,
    progress: Callable[[int], None] | None = None,
    on: str = "cpu",
) -> WorstHand:
    """Play the game of the worst hand against one loop.

    State: position, and what the law remembers.  Move: Δx in one sample.  Reward:

        −f Δx − f_c |Δx| − (b/T) Δx²

    The loop is passive exactly if no cycle of moves gains.  Then the most that can
    be taken out from each state, V, is finite, and V(s) ≥ reward + V(s') for every
    move is the proof.

    Parameters
    ----------
    device
        Without intervals, with an encoder (Δ > 0); for a law that relaxes, a delay of whole samples.
    environment
        A law that remembers a few readings: walls with or without damping, windows,
        finite filters, springs given by points, Hunt–Crossley contacts; clamped or not.
    penetration
        Deepest position of the hand [m; rad]; None: some 256 counts for a spring, 64
        for a damped wall, fewer the more the law remembers.
    speed
        Largest mean speed of the hand over one sample [m/s; rad/s]; None likewise.
    force_limit, force_resolution
        True to count in the device's force limit, the steps of its converter.
    friction
        Friction measured at several speeds, in place of the device's b and f_c.  A proof uses
        all models below the curve at once; a motion pays what the curve says.
    seconds
        Time after which the answer is "undecided".
    progress
        Told the number of states that still improve, round by round.
    on
        "cpu", or "gpu" for a graphics card with CUDA (install the extra `gpu`): the same V to the bit.

    Raises
    ------
    InputError
        If the law remembers for ever, the encoder is ideal, or the board is too large;
        or if `on` is neither, or there is no card.
    """
    game = game_of(device, environment, penetration, speed, force_limit, force_resolution, friction)
    law = as_environment(environment)
    said = game_scope(device, law, game)
    deadline = time.monotonic() + patience(seconds)
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        storage = game.prove(steps, deadline, progress, on)
        if storage is not None:
            certificate = storage.certificate()
            if certificate.verify():  # nothing is claimed that the checker does not accept
                return WorstHand("passive", said, device, law, certificate, None, storage)
        motion = None if fine is None else game.refute(fine, deadline, progress, on)
        if motion is not None:
            return WorstHand("active", said, device, law, None, motion, None)
        if time.monotonic() >= deadline:
            break
    return WorstHand("undecided", said, device, law, None, None, None)


def patience(seconds: float) -> float:
    """The time that a search may take [s].

    Raises
    ------
    InputError
        If it is not a number ≥ 0.
    """
    if not isinstance(seconds, int | float) or not seconds >= 0:
        raise InputError(f"seconds must be a number ≥ 0, got {seconds!r}: it is the time that may pass")
    return float(seconds)


def game_scope(device: Device, environment: Environment, game: Game | RowGame) -> Scope:
    """What a proof of a game is about."""
    losses, (limited, stepped) = game.losses, game.actuator
    curved = losses.curve is not None
    return scope_of(device, environment).replace(
        hands=game.hands,
        contact=game.contact,
        damping=None if curved else float(losses.damping),
        coulomb_friction=None if curved else float(losses.coulomb_friction),
        friction=losses.curve,
        force_limit=limited,
        force_steps=stepped,
        law=game.inexact,
    )
