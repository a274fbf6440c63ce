"""What `zwidth.identify` returns: the numbers of a device, and how to see, print and keep them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.data.identification.device.numbers import IdentifiedNumbers
from zwidth.data.identification.device.table import report, source_name
from zwidth.lazy import above
from zwidth.showing import Part, Shown
from zwidth.writing import check_target, writing_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, repr=False)
class Identified(Shown, IdentifiedNumbers):
    __doc__ = IdentifiedNumbers.__doc__  # its arguments are the numbers

    def to_toml(self, confidence: float | None = 0.99, **others: Any) -> str:
        """The device as a specification that `zwidth check` reads; comments say where numbers come from.

        Parameters
        ----------
        confidence, others
            As for `device`.
        """
        from zwidth.data.identification.device.specification import to_toml

        given = {"name": f"identified from {source_name(self)}", **others}
        return to_toml(self, self.device(confidence, **given), confidence)

    def save(
        self,
        path: str | PathLike[str],
        confidence: float | None = 0.99,
        *,
        force: bool = False,
        **others: Any,
    ) -> None:
        """Save `to_toml`, whole or not at all.

        Parameters
        ----------
        path
            The file, my-device.toml.
        confidence, others
            As for `device`.
        force
            Replace a file that exists.

        Raises
        ------
        InputError
            If the file exists, or cannot be written.
        """
        text, target = self.to_toml(confidence, **others), Path(path)
        check_target(target, force)
        with writing_whole(target) as file:
            file.write(text.encode())

    def plot(self, path: str | PathLike[str] | None = None, *, force: bool = False) -> Figure:
        """Friction against speed, what is left over, data against model; saved where a path is given.

        Parameters
        ----------
        path
            Ends in .png, .svg or .pdf.
        force
            Replace a file that exists.
        """
        figure: Figure = above("plots").identification_figure(self)
        if path is not None:
            above("plots").save_figure(lambda: figure, Path(path), overwrite=force)
        return figure

    def to_dict(self, confidence: float = 0.99) -> dict[str, Any]:
        """Everything but the points, units in the keys, as `zwidth identify --json` prints it."""
        from zwidth.data.identification.device.document import to_dict

        return to_dict(self, confidence)

    def report(self) -> Iterable[Part]:
        """The table, what it rests on, and what was found besides."""
        return report(self)
