"""What can be said as plain data, saved, and drawn."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, ClassVar

from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.quantity.answered import data_of
from zwidth.quantity.text import save_json, to_json
from zwidth.showing import Picture, Shown


class Pictured(Shown):
    """Something that can be drawn, where there is a picture of it."""

    _PICTURE: ClassVar[str] = ""
    """What draws it, among the plots above."""

    def plot(self, path: str | Path | None = None) -> Any:
        """Its picture, a matplotlib figure that belongs to no window; saved where a path is given.

        Parameters
        ----------
        path
            Ends in .png, .svg or .pdf.

        Raises
        ------
        InputError
            If there is nothing to draw, or the file cannot be written.
        """
        figure = self.figure()
        if path is not None:
            above("plots").save_figure(lambda: figure, path, overwrite=True)
        return figure

    def figure(self) -> Any:
        """What `plot` returns."""
        if not self._PICTURE:
            raise InputError(f"there is no picture of this {type(self).__name__}")
        return getattr(above("plots"), self._PICTURE)(self)


class Documented(Pictured):
    """Something that is plain data too: it can be saved, and drawn where there is a picture of it."""

    _FORMAT: ClassVar[str] = ""
    """Under which its document is known; "" for a part of another one."""

    def to_dict(self) -> dict[str, Any]:
        """It as plain data, a unit in every key of a physical quantity."""
        return {**({"format": self._FORMAT} if self._FORMAT else {}), **data_of(self)}

    def to_json(self) -> str:
        """`to_dict` as JSON text, every exact number digit for digit."""
        return to_json(self.to_dict())

    def saved(self) -> dict[str, Any]:
        """What `save` writes."""
        return self.to_dict()

    def save(self, path: str | Path) -> None:
        """Write it as JSON, with its evidence for `zwidth verify`.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        save_json(path, self.saved())

    def pictures(self) -> Iterable[Picture]:
        """Its picture for a notebook, small; none where there is nothing to draw."""
        if not self._PICTURE:
            return ()
        try:
            figure = self.figure()
        except InputError:
            return ()
        data = above("plots").encoded(figure, "png", dpi=_SMALL)
        return (Picture(data, "png", self.says()),)

    def says(self) -> str:
        """What its picture shows, for those who cannot see it."""
        return type(self).__name__


_SMALL = 80
"""Dots in an inch of a picture in a notebook."""
