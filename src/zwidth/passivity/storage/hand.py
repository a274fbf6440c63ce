"""The worst hand there is, against one loop: a storage function, or a motion that gains."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.document import save_json
from zwidth.passivity.outcome import TOLD, Answer, Outcome
from zwidth.passivity.scope import Contact, Hands, Law, Scope, scope_of
from zwidth.passivity.storage.board import Board, Domain
from zwidth.passivity.storage.coarse_proof import CELLS, has_cells, prove_on_cells
from zwidth.passivity.storage.domain import domain_for, losses_of, states_of, too_large
from zwidth.passivity.storage.gain import Gain, gain
from zwidth.passivity.storage.grids import grids
from zwidth.passivity.storage.hand_bounds import HandBounds, hand_bounds
from zwidth.passivity.storage.law import FiniteLaw, finite_law
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.play_relaxing import play_relaxing
from zwidth.passivity.storage.relaxing import RelaxingBoard
from zwidth.passivity.storage.row_game import RowGame, row_game
from zwidth.passivity.storage.slow_hands import slow_hands
from zwidth.passivity.storage.solve import Played, Tell, play
from zwidth.passivity.storage.storage import Storage
from zwidth.passivity.witness.witness import rounded_energy
from zwidth.passivity.wording import claim_of_passivity, lines
from zwidth.quantity.exact import RealLike
from zwidth.rendering.rendered import stages_of
from zwidth.showing import Html, bullets, element

if TYPE_CHECKING:
    import xarray as xr

STEPS = (8, 16, 32, 64)
"""Steps in which a count is cut, coarse to fine, when a proof is sought."""

FINE = (1024, 16384)
"""The same when a motion is sought; its knots lie near the edges."""

_QUICK = 100_000_000
"""Pairs of states and moves up to which a storage function is sought at once."""

_CHECKED_IN_A_SECOND, _SLOWER = 300_000_000, 10
"""Of such pairs, on a slow processor; and by how much laws that relax take longer."""

_MOST_CHECKED = 1_500_000_000
"""The same: what the checker takes on."""

_STEPS_PER_MOVE = 256
"""Steps in the longest move of a hand, at least, when a motion is sought."""

_MOST_STEPS = 2**20

_STEPS_OF_MANY = 4
"""Steps per count at least, where a cell is many counts: what a move costs is not to be rounded much."""


@dataclass(frozen=True)
class WorstHand(Answer):
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
        if self.outcome == "passive" and self.storage is None:
            raise InputError(
                "there is no available storage to give: a closed form proves this loop passive, and the game "
                "was not played; give a smaller penetration"
            )
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

    def _repr_html_(self) -> Html:
        word = element("b", self.outcome, style=f"color:{TOLD[self.outcome].colour}")
        return element("div", word, f" {self.claim}", bullets(self.assumptions))


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
        return self.bounds.hands(self.losses.part != 1)

    @property
    def bounds(self) -> HandBounds:
        """The same, exact."""
        return hand_bounds(self.law, self.losses, self.domain)

    @property
    def too_large(self) -> str | None:
        """Why no storage function is sought on this board, in words; None where one is."""
        return too_large(self.law, self.losses, self.domain)

    @property
    def is_large(self) -> bool:
        """True where a storage function takes its time."""
        return self._moves(STEPS[0]) > _QUICK or self.too_large is not None

    def checking_time(self, steps: int) -> float:
        """How long the checker may take over a storage function [s]."""
        return 0.02 + self._moves(steps) / _CHECKED_IN_A_SECOND

    def _moves(self, steps: int) -> int:
        """Pairs of states and moves on the board, by the generous rules."""
        moves = states_of(self.law, self.losses, self.domain) * (2 * self.domain.reach + 1) * (steps + 1) ** 2
        if self.law.relaxing is not None:
            return moves * max(1, steps // 8) * _SLOWER
        return moves if self.losses.part == 1 else moves * 2

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
        if self.too_large is not None or self._moves(steps) > _MOST_CHECKED:
            return None
        played = self._play(self.losses, self.domain, steps, "generous", deadline, tell, on)
        if played.value is None:
            return None
        return Storage(played, self.motion)

    def warm_up(self) -> None:
        """Play a few cells, so that what is compiled is compiled before any time is counted."""
        if self.losses.curve is not None:
            return
        enough = sum(map(abs, self.law.taps), Fraction(0)) * self.losses.period * 9 + 1
        easy = replace(self.losses, damping=self.losses.damping + enough, coulomb_friction=enough)
        for reach in (1, 30) if self.is_large else (1,):
            remembered = self.law.memory + self.losses.delay
            outside = 1 - (remembered + 1) * reach if self.law.surface != "none" else -2 * reach - 1
            few = Game(self.law, easy, Domain(min(outside, -2 * reach - 1), 2 * reach, reach), self.motion)
            if reach > 1:
                few.prove_on_cells(4)
                few.refute(4, time.monotonic() + 1)
                continue
            found = few.prove(1)
            if found is not None:
                found.certificate().verify()
            few.refute(4)

    @property
    def has_cells(self) -> bool:
        """True where a proof may be sought on cells of many counts."""
        return any(has_cells(self.law, self.losses, self.domain, cells) for cells in CELLS)

    def prove_on_cells(
        self, cells: int, deadline: float = float("inf"), tell: Tell | None = None
    ) -> Certificate | None:
        """A proof that the checker accepts, on cells of which the longest move has so many, or None."""
        return prove_on_cells(self.law, self.losses, self.domain, self.motion, cells, deadline, tell)

    def refute(
        self, steps: int, deadline: float = float("inf"), tell: Tell | None = None, on: str = "cpu"
    ) -> Gain | None:
        """A motion that gains, recomputed exactly, or None."""
        if self.domain.within.highest < 1:  # no reading inside lies within the bounds
            return None
        for every, domain in grids(self.law, self.losses, self.domain):
            if time.monotonic() >= deadline:
                break
            cells = replace(self.losses, resolution=self.losses.resolution * every)
            fine = max(self._fine_enough(steps) // every, _STEPS_OF_MANY) * every
            played = self._play(cells, domain, fine, "strict", deadline, tell, on, every)
            motion = gain(played, self.motion, self.bounds) if played.cycle else None
            if motion is not None:
                return motion
        return None

    def _fine_enough(self, steps: int) -> int:
        """Steps per count, more of them for a hand that goes less than a count in each part of a sample."""
        shortest = self.domain.speed * (min(self.losses.part, 1 - self.losses.part) or 1)
        while steps * shortest < _STEPS_PER_MOVE and steps < _MOST_STEPS:
            steps *= 2
        return steps

    def _play(
        self,
        losses: Losses,
        domain: Domain,
        steps: int,
        rules: Any,
        deadline: float,
        tell: Tell | None,
        on: str,
        every: int = 1,
    ) -> Played:
        if self.law.relaxing is not None:
            if on != "cpu":
                raise InputError("a law that relaxes is played on the processor: leave out on")
            levels = max(1, steps // 8) if rules == "generous" else 2
            board = RelaxingBoard(self.law, losses, domain, steps, rules, every, levels)
            return play_relaxing(board, deadline, tell)
        return play(Board(self.law, losses, domain, steps, rules, every), deadline, tell, on)


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
    if stages_of(given):
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
    if isinstance(game, Game):
        game.warm_up()
    deadline = time.monotonic() + patience(seconds)
    counted = force_limit or force_resolution or friction is not None
    slow = None if counted else slow_hands(device, law, game.bounds.speed)
    if game.is_large:
        slow = slow or _on_cells(game, deadline, progress)
        if slow is not None:
            return WorstHand("passive", said, device, law, slow, None, None)
    for steps, fine in zip(STEPS, (*FINE, None, None), strict=True):
        in_time = time.monotonic() + (deadline - time.monotonic()) / 2 - game.checking_time(steps)
        storage = game.prove(steps, in_time, progress, on)
        if storage is not None:
            certificate = storage.certificate()
            if certificate.verify():  # nothing is claimed that the checker does not accept
                return WorstHand("passive", said, device, law, certificate, None, storage)
        motion = None if fine is None else game.refute(fine, deadline, progress, on)
        if motion is not None:
            return WorstHand("active", said, device, law, None, motion, None)
        if time.monotonic() >= deadline:
            break
    if slow is not None:
        return WorstHand("passive", said, device, law, slow, None, None)
    if game.too_large is not None:
        raise InputError(game.too_large)
    return WorstHand("undecided", said, device, law, None, None, None)


def _on_cells(game: Game | RowGame, deadline: float, tell: Tell | None) -> Certificate | None:
    """The first proof on cells of many counts."""
    found = (game.prove_on_cells(cells, deadline, tell) for cells in CELLS)
    return next((certificate for certificate in found if certificate is not None), None)


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
