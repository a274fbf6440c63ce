"""What is kept of an answer: words as small numbers, sets of words as bits, and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Column(NamedTuple):
    """One entry of every answer.

    Parameters
    ----------
    meaning
        In a few words.
    unit
        Of a number; "" of words, and of what is true or false.
    words
        Those that it may be; () of a number.  A word is kept as its place among them, from 1 on: 0 is none.
    several
        Whether several of the words may hold at once: each is then a bit.
    """

    meaning: str
    unit: str = ""
    words: tuple[str, ...] = ()
    several: bool = False

    @property
    def kind(self) -> str:
        """The type of what is kept."""
        if not self.words:
            return "float64" if self.unit else "bool"
        return "uint16" if self.several else "uint8"

    def kept(self, value: Any) -> float | int:
        """What is kept of a value: of a number, a word, or several words."""
        if not self.words:
            return float("nan") if value is None and self.unit else float(value or 0)
        if self.several:
            return sum(1 << self.words.index(word) for word in value)
        return self.words.index(value) + 1 if value else 0

    def shown(self, kept: NDArray[Any]) -> NDArray[Any]:
        """Numbers as they are, and words again."""
        if not self.words:
            return kept
        if not self.several:
            return np.asarray(np.array(["", *self.words])[kept])
        found = {
            code: "; ".join(word for bit, word in enumerate(self.words) if code >> bit & 1)
            for code in np.unique(kept).tolist()
        }
        shown = np.full(kept.shape, "", dtype=f"<U{max(1, *map(len, found.values()))}")
        for code, text in found.items():
            shown[kept == code] = text
        return shown

    def told(self) -> dict[str, str]:
        """What is said of the numbers or words beside them."""
        return {"long_name": self.meaning} | ({} if self.words or not self.unit else {"units": self.unit})

    def about(self) -> dict[str, Any]:
        """The same of what is kept, words in the way of the CF conventions."""
        told: dict[str, Any] = self.told()
        if not self.words:
            return told
        told["flag_meanings"] = " ".join(word.replace(" ", "_") for word in self.words)
        if self.several:
            return told | {"flag_masks": [1 << bit for bit in range(len(self.words))]}
        return told | {"flag_values": list(range(1, len(self.words) + 1))}


Columns = Mapping[str, Column]

REFUSED = "refused"

OF_EVERY_SWEEP: Columns = {REFUSED: Column("True of a loop that cannot be: its numbers exclude one another")}
"""What is kept beside the answers."""
