"""Several models fitted to one record, beside each other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from zwidth.data.tissue.result import TissueFit
from zwidth.showing import Part, Shown, Table


@dataclass(frozen=True, eq=False, repr=False)
class TissueComparison(Shown):
    """Several models fitted to one record, that of the smallest BIC first.

    Parameters
    ----------
    fits
        In the order of their BIC.
    """

    fits: tuple[TissueFit, ...]

    @property
    def best(self) -> TissueFit:
        """The fit of the smallest BIC."""
        return self.fits[0]

    def __getitem__(self, name: str) -> TissueFit:
        return {fit.model.name: fit for fit in self.fits}[name]

    def table(self) -> list[list[str]]:
        """Headings, then one line of text per model; AIC and BIC above the smallest."""
        aic, bic = (min(getattr(fit, key) for fit in self.fits) for key in ("aic", "bic"))
        lines = [["model", "parameters", "r²", "RMS", "AIC above", "BIC above", "identifiable"]]
        for fit in self.fits:
            numbers = f"{fit.r_squared:.6f}", f"{fit.rms:.3g}", f"{fit.aic - aic:.1f}", f"{fit.bic - bic:.1f}"
            known = "yes" if fit.identifiable else "no"
            lines.append([fit.model.name, str(fit.estimates.size), *numbers, known])
        return lines

    def report(self) -> Iterable[Part]:
        """The table."""
        head, *rows = self.table()
        yield Table(heads=[head], rows=rows)
