"""What a test says of a tissue, and what a device may render of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from zwidth.data.tissue.experiment.choice import UNLIKELY, Slowest, Tried, label, leftover, slowest_of
from zwidth.data.tissue.experiment.history import History, Kind
from zwidth.data.tissue.findings import by_chance
from zwidth.data.tissue.result import TissueFit
from zwidth.errors import InputError
from zwidth.lazy import above
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.quantity.documented import Documented
from zwidth.quantity.text import shown
from zwidth.showing import Lines, Part, Table

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.passivity.bracket import Bracket


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class TissueTest(Documented):
    """A test of a tissue with every model fitted to it, the smallest AICc first.

    Attributes
    ----------
    source
        The file.
    test
        The history of the probe as it was fitted, with its `kind`.
    seen_as
        Which test the data look like.
    tried
        The fits as they were made, for those who want the residuals and derivatives.
    fits
        As results, in the same order.
    chosen
        The place of the one that is taken.
    as_good
        The places of others that this test does not tell from it.
    number
        Which trial of the file it is, from 1.
    trials
        The model that is taken, fitted to each trial of the file by itself, or why it was not; none where
        the file holds one.
    """

    _BESIDES = (
        ("kind, seen_as", "the test as it was fitted; as the data look"),
        ("samples, duration_s", "that were fitted"),
        ("model, not_told_apart", "the one that is taken; others that this test does not tell from it"),
        ("left_over_is_noise", "false where none of the models is the tissue to within the noise"),
        (
            "best",
            "the fit that is taken: `parameters`, each with `value`, `unit` and `interval_95`, and its own "
            "numbers",
        ),
        (
            "models",
            "of each that was fitted, `model`, `aicc_above` the smallest, `rms`, `noise_memory_s` (0: white)",
        ),
        ("doubts, findings", "what to know before trusting the numbers; what was odd in the file"),
        (
            "trial, trials",
            "the number of this one; of a file that holds several, the same model fitted to each by "
            "itself, as in `best`, or `not_fitted` with the reason",
        ),
        (
            "slowest_relaxation_time_s",
            "null, or of a test that is shorter: `fitted`, `at_least` and `at_most` (95 % each), null"
            " where there is no bound",
        ),
        (
            "check, largest_gain, check_of_intervals, ranges",
            "with a device: the verdict on the tissue; `proved_passive` and `proved_active`, times "
            "the tissue, of a `hand`, what more is proved while contact is kept, else null, and of a device "
            "with intervals by contact whether that is so for every value, else at their worst ends; the "
            "outcome for all that the 95 % intervals allow, null where it was not asked; of a device of the "
            "catalogue what holds over its stated ranges, as of `zwidth check`",
        ),
    )

    source: str
    test: History
    seen_as: Kind
    tried: tuple[Tried, ...]
    fits: tuple[TissueFit, ...]
    chosen: int
    as_good: tuple[int, ...]
    number: int = 1
    trials: tuple[TissueFit | str, ...] = ()

    @property
    def best(self) -> TissueFit:
        """The fit that is taken."""
        return self.fits[self.chosen]

    def __getitem__(self, name: str) -> TissueFit:
        for own, fit in zip(self.names, self.fits, strict=True):
            if name in (own, fit.model.name):
                return fit
        raise InputError(f"{name!r} was not fitted; {', '.join(self.names)} were")

    @property
    def criteria(self) -> tuple[float, ...]:
        """AICc of each above the smallest."""
        return tuple(each.criterion - self.tried[0].criterion for each in self.tried)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the models, in the same order."""
        return tuple(label(fit.model) for fit in self.fits)

    @property
    def rivals(self) -> tuple[str, ...]:
        """Names of models that this test does not tell from the one that is taken."""
        return tuple(self.names[k] for k in self.as_good)

    @property
    def is_noise(self) -> bool:
        """True where what the best model leaves over may be noise."""
        return leftover(self.tried[self.chosen].found) > UNLIKELY

    @property
    def doubts(self) -> tuple[str, ...]:
        """What a reader should know before trusting the numbers."""
        said = list(self.best.remarks)
        if self.slowest is not None:
            said.append(self._too_short(self.slowest))
        if self.best.model.name == "kelvin-voigt" and self.test.surface is not None:
            said.append(
                "a Kelvin–Voigt solid that is met from outside jumps at the touch, between two samples: its "
                "intervals are too narrow"
            )
        apart = self.apart()
        if apart:
            said.append(
                f"the trials differ in {', '.join(apart)} by more than their intervals: the tissue changed, "
                "or was not met at the same place; an interval is of one trial"
            )
        if not self.is_noise:
            said.append(
                "what is left over is not noise: none of these models is the tissue to within the "
                "noise, and the intervals are too narrow"
            )
        return tuple(said)

    @cached_property
    def slowest(self) -> Slowest | None:
        """What is known of the slowest relaxation time, where it is longer than the test; else None, as where
        the model leaves more than noise."""
        own = self.tried[self.chosen]
        if not self.is_noise:
            return None
        return slowest_of(own.task, own.found)

    def _too_short(self, slowest: Slowest) -> str:
        length, fitted = (shown(value, "s", 3) for value in (float(self.test.time[-1]), slowest.fitted))
        known = [
            f"at {which} {shown(value, 's', 3)}"
            for which, value in (("least", slowest.at_least), ("most", slowest.at_most))
            if value is not None
        ]
        known += ["without an upper bound"] * (slowest.at_most is None)
        return (
            f"the test ends after {length}, before the tissue has relaxed: by the likelihood that takes "
            f"{' and '.join(known)} (each 95 %; fitted {fitted}); the stiffness in the end is an "
            "extrapolation: hold for longer"
        )

    def apart(self) -> list[str]:
        """The parameters in which the trials differ by more than noise makes them: Σ (θ − θ̄)²/s², 0.1 %."""
        fits = [fit for fit in self.trials if not isinstance(fit, str)]
        found = []
        for k, name in enumerate(self.best.model.parameters if len(fits) > 1 else ()):
            at = np.array([fit.estimates[k] for fit in fits])
            weight = np.array([max(fit.covariance[k, k], 1e-300) for fit in fits]) ** -1.0
            mean = float(at @ weight / weight.sum())
            if by_chance(float((at - mean) ** 2 @ weight), len(fits) - 1) < UNLIKELY:
                found.append(name)
        return found

    def of_trials(self) -> list[list[str]]:
        """Headings, then one line of text for each trial, then the mean and what they spread by."""
        names = self.best.model.parameters
        fits = [fit for fit in self.trials if not isinstance(fit, str)]
        units = [row[-1] for row in self.parameters()[1:]]
        heads = (f"{name.replace('_', ' ')} [{unit}]" for name, unit in zip(names, units, strict=False))
        lines = [["trial", *heads]]
        for k, fit in enumerate(self.trials, 1):
            mark = " ←" if k == self.number else ""
            cells = ["not fitted"] if isinstance(fit, str) else [f"{fit[name]:.4g}" for name in names]
            lines.append([f"{k}{mark}", *cells, *[""] * (len(names) - len(cells))])
        if len(fits) > 1:
            table = np.array([[fit[name] for name in names] for fit in fits])
            spread = table.std(axis=0, ddof=1)
            both = zip(table.mean(axis=0), spread, strict=True)
            lines.append(["mean ± SD", *(f"{m:.4g} ± {s:.2g}" for m, s in both)])
        return lines

    def environment(
        self, discretization: Discretization = "backward", *, level: float | None = None
    ) -> Environment:
        """The best fit as a controller renders it; as `TissueFit.environment`.

        Parameters
        ----------
        discretization
            Of a solid with branches.
        level
            None: the estimates; else intervals that hold all of them at least so often.
        """
        return self.best.environment(discretization, level=level)

    def wall(
        self, device: Device, discretization: Discretization = "backward", contact: str = "made and broken"
    ) -> Bracket:
        """How many times the tissue the device may render: proved passive below, refuted above.

        All forces are multiplied by the gain; relaxation times stay.  It is `zwidth.limit` of the estimates:
        for every hand where a closed condition decides, else for the hands that `hand` of the bracket names.

        Parameters
        ----------
        device
            What the hand holds.
        discretization
            Of a solid with branches.
        contact
            "kept": of hands that stay inside alone.

        Raises
        ------
        InputError
            If nothing decides such a contact on this device.
        """
        from zwidth.passivity.bracket import passive_limit

        law = self.environment(discretization)
        closed = passive_limit(device, law, "gain", iterate=False, contact=contact)
        if closed.outcome != "undecided" or contact == "kept":
            return closed
        return passive_limit(device, law, "gain")

    def scaled(self, gain: float, discretization: Discretization = "backward") -> Environment:
        """The best fit with every force times a gain.

        Parameters
        ----------
        gain
            > 0, such as `wall(device).proved_passive`.
        discretization
            Of a solid with branches.
        """
        made = self.environment(discretization).scaled(Fraction(gain))
        assert made is not None
        return made

    def table(self) -> list[list[str]]:
        """Headings, then one line of text for each model."""
        lines = [["model", "numbers", "AICc above", "left over", "noise"]]
        for k, (fit, each) in enumerate(zip(self.fits, self.tried, strict=True)):
            unit = "m" if fit.response == "position" else "N"
            memory = each.found.noise.memory
            mark = " ←" if k == self.chosen else " =" if k in self.as_good else ""
            lines.append(
                [
                    label(fit.model) + mark,
                    str(each.found.numbers),
                    f"{self.criteria[k]:.1f}",
                    shown(fit.rms, unit, 3),
                    f"memory {shown(memory, 's', 2)}" if memory else "white",
                ]
            )
        return lines

    def parameters(self) -> list[list[str]]:
        """Headings, then one line of text for each parameter of the best fit."""
        return self.best.table()

    def claim(self) -> str:
        """The answer in a sentence."""
        name = self.names[self.chosen]
        if self.rivals:
            return f"{name}; not told apart from {', '.join(self.rivals)}"
        near = [value for k, value in enumerate(self.criteria) if k != self.chosen]
        own = self.criteria[self.chosen]
        if not near:
            return f"{name}, the only model that was fitted"
        return f"{name}; AICc {min(near) - own:+.3g} for the next"

    def spoken(self) -> str:
        """The tissue in a few words: how stiff at once and in the end, and how long it takes to relax."""
        fit = self.best
        if not fit.model.linear:
            return f"exponent {fit['exponent']:.3g}"
        parts = fit.model.elements([fit[name] for name in fit.model.parameters])
        if parts.dashpot:
            return f"{shown(parts.spring, 'N/m', 3)} beside {shown(parts.dashpot, 'N*s/m', 3)}"
        times = " and ".join(shown(eta / mu, "s", 3) for mu, eta in parts.branches)
        at_once, end = (shown(value, "N/m", 3) for value in (parts.instantaneous, parts.spring))
        return f"{at_once} at once, {end} in the end, relaxing in {times}"

    def report(self) -> Iterable[Part]:
        """The model, its numbers, and what is to be said of them."""
        yield f"{self.test.kind} test, {self.test.time.size} samples: {self.claim()}"
        head, *rows = self.parameters()
        yield Table(heads=[head], rows=rows)
        if self.trials:
            head, *rows = self.of_trials()
            yield Table(heads=[head], rows=rows)
        yield from self.remarked()
        head, *rows = self.table()
        yield Table(heads=[head], rows=rows)

    def remarked(self) -> Iterator[Part]:
        """Doubts, and what was odd in the file."""
        if self.doubts:
            yield Lines(self.doubts, mark="!")
        if self.best.findings:
            yield Lines(self.best.findings)

    def to_dict(self) -> dict[str, Any]:
        """The numbers, for JSON."""
        return {
            "kind": self.test.kind,
            "seen_as": self.seen_as,
            "samples": int(self.test.time.size),
            "duration_s": float(self.test.time[-1]),
            "model": self.names[self.chosen],
            "not_told_apart": list(self.rivals),
            "left_over_is_noise": self.is_noise,
            "best": self.best.to_dict(),
            "slowest_relaxation_time_s": None if self.slowest is None else self.slowest._asdict(),
            "trial": self.number,
            "trials": [{"not_fitted": fit} if isinstance(fit, str) else fit.to_dict() for fit in self.trials],
            "models": [
                {
                    "model": self.names[k],
                    "aicc_above": self.criteria[k],
                    "rms": fit.rms,
                    "noise_memory_s": self.tried[k].found.noise.memory,
                }
                for k, fit in enumerate(self.fits)
            ],
            "doubts": list(self.doubts),
            "findings": [finding.text for finding in self.best.findings],
        }

    def figure(self) -> Any:
        """What `plot` returns: the test, the best fit, and what is left over."""
        return above("plots").test_figure(self.test, self.best)
