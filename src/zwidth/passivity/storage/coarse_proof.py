"""A proof on cells of many counts, as data."""

from __future__ import annotations

import base64
import zlib

from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.storage.board import Domain
from zwidth.passivity.storage.coarse_board import CoarseBoard, coarse_board
from zwidth.passivity.storage.law import FiniteLaw
from zwidth.passivity.storage.losses import Losses
from zwidth.passivity.storage.solve import Tell, play
from zwidth.passivity.storage.storage import loop_document
from zwidth.quantity.text import exact_text

CELLS = (16, 32, 64, 128)
"""Cells in the longest move, coarse to fine."""

MOST_STATES = 400_000


def prove_on_cells(
    law: FiniteLaw,
    losses: Losses,
    domain: Domain,
    motion: str,
    cells: int,
    deadline: float,
    tell: Tell | None,
) -> Certificate | None:
    """A storage function that the checker accepts, or None."""
    board = coarse_board(law, losses, domain, cells)
    if board is None or not has_cells(law, losses, domain, cells):
        return None
    value = play(board, deadline, tell).value
    if value is None:
        return None
    packed = zlib.compress(value.astype("<i8").tobytes(), 6)
    certificate = Certificate((_document(board, losses, motion, packed),))
    return certificate if certificate.verify() else None


def has_cells(law: FiniteLaw, losses: Losses, domain: Domain, cells: int) -> bool:
    """True for a law that can be proved on such cells, of which there are not too many."""
    board = coarse_board(law, losses, domain, cells)
    return board is not None and len(board.places) * board.histories <= MOST_STATES


def _document(board: CoarseBoard, losses: Losses, motion: str, packed: bytes) -> dict[str, object]:
    domain = board.domain
    return {
        "format": FORMAT,
        "kind": "coarse storage",
        "loop": loop_document(losses, motion),
        "law": board.law.document(motion),
        "domain": {
            "lowest_cell": domain.lowest,
            "highest_cell": domain.highest - board.sheets,
            "counts_per_cell": exact_text(board.losses.resolution / losses.resolution),
            "largest_move_cells": int(domain.speed),
            "remembered": board.memory,
        },
        "force_unit": exact_text(board.force_unit),
        "storage": base64.b64encode(packed).decode("ascii"),
    }
