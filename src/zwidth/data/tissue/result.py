"""What a fit says of a tissue: its parameters, how well they are known, and what to do with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import exp, inf, log, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.logs import Finding
from zwidth.data.tissue.findings import coarse, unlikely_units
from zwidth.data.tissue.model import Model, unit_of
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.native.compiled import Array
from zwidth.quantity.answered import answered, answers, data_of
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown, unit_text
from zwidth.showing import Lines, Part, Table

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.passivity import Verdict

LEVEL = 0.95

LARGEST_CONDITION = 1e6
"""Of the Jacobian; beyond, some mixture of the parameters leaves no trace in the data."""

LARGEST_SPREAD = 0.5
"""Relative standard deviation beyond which a parameter is said not to be known."""

_LARGEST_LOG = 700.0

_USUAL = 1.96
"""Standard deviations at 95 %."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class TissueFit(Documented):
    """A model fitted to a record, with the uncertainty of its parameters."""

    model: Model = answered("what was fitted, by its name", stands_as={"model": "name"})
    estimates: Array = answered(
        "logarithms of the parameters, then the offset itself where one was fitted", only_shown=True
    )
    covariance: Array = answered("of these", only_shown=True)
    residuals: Array = answered(
        "measured less predicted, of the samples that count [N; N·m, or m; rad]", only_shown=True
    )
    output: Array = answered("what was measured and predicted", only_shown=True)
    response: str = answered('"force" or "position"')
    condition: float = answered("of the Jacobian with respect to relative changes of the parameters")
    noise_order: int = answered(
        "of the autoregressive process that the residuals were taken for; 0 for white noise"
    )
    independent_samples: float = answered(
        "how many samples without memory would say as much", only_shown=True
    )
    motion: str = answered('"linear" or "rotary"', only_shown=True)
    further: int = answered(
        "how many other numbers were fitted, for what was found in the record", default=0, only_shown=True
    )
    findings: tuple[Finding, ...] = answered(
        "what was found in the record, and what was done about it", default=()
    )
    position: Array | None = answered(
        "as it was read [m; rad]; None where it is not known", default=None, only_shown=True
    )
    units_stated: bool = answered(
        "true where a file, or a person, says in which units it is", default=False, only_shown=True
    )
    time: Array | None = answered(
        "of the samples that count [s]; None where it is not known, and then there is no picture",
        default=None,
        only_shown=True,
    )
    bends: tuple[tuple[float, float], ...] = answered(
        "of each parameter how much further its interval goes below and above, in the logarithm, than the "
        "usual one: by t σ times 1 + c t; empty where none was asked for",
        default=(),
        only_shown=True,
    )

    @cached_property
    def values(self) -> Mapping[str, float]:
        """The parameters by name, SI; with the offset where one was fitted."""
        names = self.model.parameters
        found = {name: float(np.exp(v)) for name, v in zip(names, self.estimates, strict=False)}
        if self._has_offset:
            found["offset"] = float(self.estimates[-1])
        return found

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    @property
    def _has_offset(self) -> bool:
        return self.estimates.size > len(self.model.parameters)

    @cached_property
    def spreads(self) -> Mapping[str, float]:
        """Standard deviation of each parameter as a share of it; of the offset, itself."""
        deviations = np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        return {name: float(d) for name, d in zip(self.values, deviations, strict=True)}

    def interval(self, name: str, level: float = LEVEL) -> tuple[float, float]:
        """The confidence interval of one parameter, by Student's t of its logarithm, and its likelihood.

        Parameters
        ----------
        name
            Of the parameter.
        level
            How often such an interval holds the true value, > 0 and < 1.

        Raises
        ------
        InputError
            If there is no such parameter, or the level is not between 0 and 1.
        """
        from scipy.special import stdtrit

        if name not in self.values:
            raise InputError(f"there is no parameter {name!r}; there are {', '.join(self.values)}")
        if not 0.0 < level < 1.0:
            raise InputError(f"level is > 0 and < 1, such as 0.95; got {level!r}")
        place = list(self.values).index(name)
        middle = float(self.estimates[place])
        sure = float(stdtrit(self.degrees_of_freedom, 0.5 + level / 2))
        reach = sure * self.spreads[name]
        if name == "offset":
            return middle - reach, middle + reach
        below, above = self.bends[place] if self.bends else (0.0, 0.0)
        return _exp(middle - reach * _stretch(below, sure)), _exp(middle + reach * _stretch(above, sure))

    @property
    def degrees_of_freedom(self) -> float:
        """Independent samples less parameters, 1 at the least."""
        return max(self.independent_samples - self.estimates.size - self.further, 1.0)

    @property
    @answers()
    def r_squared(self) -> float:
        """1 − Σ e²/Σ (y − ȳ)²."""
        about = self.output - self.output.mean()
        total = float(about @ about)
        return 1.0 - float(self.residuals @ self.residuals) / total if total else 0.0

    @property
    @answers()
    def rms(self) -> float:
        """Of the residuals [N; N·m, or m; rad]."""
        return sqrt(float(np.mean(self.residuals**2)))

    @property
    @answers()
    def aic(self) -> float:
        """N ln(Σ e²/N) + 2 k, for k parameters; the residuals are taken as white here."""
        return self._deviance + 2 * (self.estimates.size + self.further)

    @property
    @answers()
    def bic(self) -> float:
        """N ln(Σ e²/N) + k ln N: the smaller, the better the model.

        The residuals are taken as white: noise with a memory makes it favour large models.
        """
        return self._deviance + log(self.residuals.size) * (self.estimates.size + self.further)

    @property
    def _deviance(self) -> float:
        mean = max(self.rms**2, float(np.finfo(float).tiny))
        return self.residuals.size * log(mean)

    @cached_property
    @answers()
    def remarks(self) -> tuple[str, ...]:
        """What a reader should know before trusting the numbers."""
        said = [
            f"{name} is not identifiable from this record: its standard deviation is "
            + (f"{shown(spread, '%', 3)} of it" if spread < 100 else "more than a hundred times it")
            for name, spread in self.spreads.items()
            if name != "offset" and spread > LARGEST_SPREAD
        ]
        if self.condition > LARGEST_CONDITION:
            said.append(
                f"the condition number is {self.condition:.1e}: a mixture of the parameters leaves no trace; "
                "take a model with fewer, or a motion that excites more"
            )
        if self.model.name == "hunt-crossley" and self["exponent"] < 1:
            said.append("an exponent below 1 is no Hunt–Crossley contact: stiffest where it begins")
        if self.position is not None and self.model.linear:
            if self.motion == "linear" and not self.units_stated:
                said.extend(unlikely_units(self._at_once, float(np.abs(self.position).max())))
            if self.response == "force":
                length = GLOSSARY["position"].unit_for(self.motion)
                said.extend(coarse(self.position, self._at_once, self.rms, length))
        return tuple(said)

    @property
    def _at_once(self) -> float:
        """The stiffness at once [N/m]."""
        return sum(value for name, value in self.values.items() if "stiffness" in name)

    @property
    def identifiable(self) -> bool:
        """True where nothing is remarked."""
        return not self.remarks

    def environment(
        self,
        discretization: Discretization = "backward",
        *,
        level: float | None = None,
        clamped: bool | None = None,
    ) -> Environment:
        """The tissue as a controller renders it, for `zwidth.check` and `zwidth.simulate`.

        Parameters
        ----------
        discretization
            Of a solid with branches; the others have none.
        level
            None: the estimates.  A level, such as 0.95: intervals that hold the true values all together
            at least so often (Bonferroni), so that what is proved of them is proved of the tissue so often.
        clamped
            True for a law that never pulls; None: as the environment has it by default.

        Raises
        ------
        InputError
            If intervals are asked for that are not finite, or of a Hunt–Crossley contact, which takes none.
        """
        names = self.model.parameters
        never_pulls = not self.model.linear if clamped is None else clamped
        if level is None:
            return self.model.environment([self[name] for name in names], discretization, never_pulls)
        if not self.model.linear:
            raise InputError("a Hunt–Crossley contact takes no intervals; leave level out")
        each = 1.0 - (1.0 - level) / len(names)
        ends = [self.interval(name, each) for name in names]
        if self.remarks:
            raise InputError(f"no interval is to be trusted here: {'; '.join(self.remarks)}")
        return self.model.environment([Interval(*pair) for pair in ends], discretization, never_pulls)

    def verdict(
        self, device: Device, discretization: Discretization = "backward", *, level: float | None = LEVEL
    ) -> Verdict:
        """Whether a device renders this tissue passively: `zwidth.check` for all that the data allow.

        Parameters
        ----------
        device
            What the hand holds.
        discretization, level
            As for `environment`.
        """
        from zwidth.passivity import check

        return check(device, self.environment(discretization, level=level))

    def to_dict(self) -> dict[str, Any]:
        """The numbers, for JSON."""
        parameters = {
            name: {"value": value, "unit": self._unit(name), "interval_95": list(self.interval(name))}
            for name, value in self.values.items()
        }
        said = [finding.text for finding in self.findings]
        return {**data_of(self), "parameters": parameters, "findings": said}

    def _unit(self, name: str) -> str:
        if name == "offset":
            return GLOSSARY[self.response].unit_for(self.motion)
        return unit_of(name, self.motion, self.values.get("exponent", 1.0) if name == "stiffness" else 1.0)

    def table(self) -> list[list[str]]:
        """Headings, then one line of text per parameter."""
        lines = [["parameter", "value", "95 % interval", "unit"]]
        for name, value in self.values.items():
            low, high = self.interval(name)
            lines.append([name, f"{value:.6g}", f"{low:.4g} … {high:.4g}", unit_text(self._unit(name))])
        return lines

    def figure(self) -> Any:
        """What `plot` returns: measured and fitted against the time, and what is left over.

        Raises
        ------
        InputError
            If the times are not known.
        """
        return above("plots").fit_figure(self)

    def _summary(self) -> str:
        noise = "white noise" if not self.noise_order else f"noise of order {self.noise_order}"
        return (
            f"{self.model.name}, {self.residuals.size} samples: r² = {self.r_squared:.6f}, residuals "
            f"{shown(self.rms, self._unit('offset'), 3)} RMS, {noise}, condition {self.condition:.3g}"
        )

    def report(self) -> Iterable[Part]:
        """The fit in a line, the parameters, and what is to be said of them."""
        yield self._summary()
        head, *rows = self.table()
        yield Table(heads=[head], rows=rows)
        if self.remarks:
            yield Lines(self.remarks, mark="!")
        if self.findings:
            yield Lines(self.findings)


def _stretch(bend: float, sure: float) -> float:
    """1 + c t; an end that comes nearer was found at 95 %, and comes no nearer beyond."""
    return 1.0 + bend * (sure if bend > 0 else min(sure, _USUAL))


def _exp(value: float) -> float:
    return inf if value > _LARGEST_LOG else exp(value)
