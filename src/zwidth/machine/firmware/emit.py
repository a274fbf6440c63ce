"""The main verb: a law that was proved, as text for the machine that will run it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from math import floor
from pathlib import Path
from re import fullmatch
from typing import Any

from zwidth.errors import InputError
from zwidth.machine.firmware.header import header
from zwidth.machine.firmware.javascript import module
from zwidth.machine.firmware.law import LawProgram, law_program
from zwidth.machine.firmware.machine import Machine, Number, machine
from zwidth.machine.firmware.targets import TARGETS, Target
from zwidth.machine.firmware.verdict import PROVED, Decide, Judged, about, claim, defines, digest, judged
from zwidth.machine.servo.proving import least_friction
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.check import check
from zwidth.passivity.result import Result
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Interval, RealLike, ends
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import quantity_unit, shown, to_json, told_quantity
from zwidth.quantity.units import parse, parse_number
from zwidth.showing import Headline
from zwidth.writing import check_target, writing_whole

MOST_COUNTS = 32767
"""Readings of a machine with narrow numbers, unless the travel is given."""

_OF_FRICTION = 0.1
"""A rounding beyond this part of the Coulomb friction is worth wider numbers."""

_WHOLE = 2**31 - 1


class NotEmitted(InputError):
    """A law is not emitted, since it is not proved passive in the target's numbers."""

    def __init__(self, judged: Judged, message: str) -> None:
        super().__init__(message)
        self.judged = judged


@dataclass(frozen=True, eq=False, repr=False)
class Emitted(Result):
    """A law as text, with the verdict on it.

    Parameters
    ----------
    prefix
        What its files and names begin with.
    target
        One of `targets.TARGETS`.
    device, environment
        The loop.
    judged
        What is proved.
    files
        Text by file name.
    """

    _FORMAT = "zwidth emitted law 1"
    _BESIDES = (
        (
            "prefix, target, number",
            "what names begin with, the machine, and its numbers: `double`, `float` or `fixed`",
        ),
        ("outcome", "of the law in these numbers"),
        ("statement", "what the numbers do to the verdict, in a sentence or two"),
        (
            "error_N",
            "ε, by which the force is off at most: half a step of the converter and the rounding; "
            "null where no bound is known",
        ),
        ("rounding_N", "the rounding in it"),
        (
            "stiffness_cost_N_per_m",
            "by how much the largest passive stiffness is less; null where the environment has none",
        ),
        ("certificate_sha256", "of `PREFIX.certificate.json`; it stands in the header"),
        (
            "files",
            "SHA-256 by file name; the sketch is `PREFIX.ino` here, and called as its folder on the disk",
        ),
        ("verdict", "of the device with ε less Coulomb friction"),
    )

    prefix: str
    target: str
    device: Device
    environment: Environment
    judged: Judged
    files: dict[str, str]

    @property
    def machine(self) -> Machine:
        """The law in the target's numbers."""
        return self.judged.machine

    @property
    def verdict(self) -> Verdict:
        """On the law with the friction that the target's numbers leave."""
        return self.judged.verdict

    @property
    def certificate_sha256(self) -> str:
        """Of the certificate's file; it stands in the header."""
        return digest(self.files[f"{self.prefix}.certificate.json"])

    @property
    def text(self) -> str:
        """The header, or the module."""
        return next(
            text for file, text in self.files.items() if file in (f"{self.prefix}.h", f"{self.prefix}.mjs")
        )

    def __repr__(self) -> str:
        return f"<Emitted {self.describe()}>"

    def describe(self) -> str:
        """It in a sentence."""
        return (
            f"{self.environment.describe(self.device.motion)}, for {self.target} in {self.machine.number}: "
            f"{self.judged.outcome}; {self.judged.statement}"
        )

    @property
    def claim(self) -> str:
        """What is proved, or that nothing is."""
        return claim(self.judged)

    @property
    def numbers(self) -> list[tuple[str, str]]:
        """What the target's numbers are and cost, as (name, text)."""
        rows = [("numbers", _numbers(self.machine))]
        if self.machine.error is not None:
            off = told_quantity(self.machine.error, "force", self.device.motion, 4)
            rows.append(("force off by at most", off))
        cost = self.judged.cost(self.device, self.environment)
        if cost is not None:
            rows.append(("stiffness that it costs", told_quantity(cost, "stiffness", self.device.motion, 4)))
        return rows

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text)."""
        files = ((file, f"{len(text.encode())} bytes") for file, text in sorted(self.files.items()))
        return [*self.numbers, *files]

    def _headline(self) -> Headline:
        return Headline(self.judged.outcome, COLOUR[self.judged.outcome], self.claim)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the verdict takes for granted."""
        stated = (line for line in self.verdict.assumptions if not line.startswith("ideal actuator"))
        return (*stated, *self.beside)

    @property
    def beside(self) -> tuple[str, ...]:
        """What the machine must do that no verdict counts."""
        late = float(ends(self.device.delay)[1])
        low, high = self.machine.counts
        actuator = "force limit, current rise and filters are not counted"
        if self.judged.bounded:
            actuator = "current rise and filters are not counted; force limit and converter steps are"
        elif self.judged.counted and self.machine.law.step > 0:
            actuator += "; converter steps are"
        unit = "counts" if self.machine.law.resolution > 0 else self.device.unit("position")
        to = shown(high, unit, 10)
        uncounted = () if self.judged.counted else (self.judged.statement,)
        return (
            *uncounted,
            actuator,
            f"readings from {low * spoken(unit)[0]:.10g} to {to}; beyond them nothing is claimed",
            *self._beyond_points(),
            f"a force {shown(late, 's') + ' after' if late else 'at'} each reading, held to the next",
        )

    def _beyond_points(self) -> Iterator[str]:
        """What a spring given by points does at readings beyond its first and its last one."""
        points, motion = self.environment.met.points, self.device.motion
        count = self.machine.law.resolution or 1.0
        low, high = (end * count for end in self.machine.counts)
        if points and (low < points[0][0] or high > points[-1][0]):
            (first, below), (last, above) = (
                (told_quantity(x, "position", motion), told_quantity(f, "force", motion))
                for x, f in (points[0], points[-1])
            )
            yield f"beyond the points the force stays, {below} below {first}, {above} above {last}"

    def to_dict(self) -> dict[str, Any]:
        """It as plain data."""
        linear = self.device.motion == "linear"
        force, stiffness = ("N", "N_per_m") if linear else ("N_m", "N_m_per_rad")
        return {
            "format": self._FORMAT,
            "prefix": self.prefix,
            "target": self.target,
            "number": self.machine.number,
            "outcome": self.judged.outcome,
            "statement": self.judged.statement,
            f"error_{force}": self.machine.error,
            f"rounding_{force}": self.machine.rounding,
            f"stiffness_cost_{stiffness}": self.judged.cost(self.device, self.environment),
            "certificate_sha256": self.certificate_sha256,
            "files": {file: digest(text) for file, text in sorted(self.files.items())},
            "verdict": self.verdict.to_dict(),
        }

    def write(self, directory: str | Path, *, force: bool = False, how: str = "force=True") -> list[Path]:
        """Write every file; the places, in their order.

        Parameters
        ----------
        directory
            Made where it is not there.
        force
            True to replace files.
        how
            What a refusal says to give for that.

        Raises
        ------
        InputError
            If a file exists, and nothing is written then; or if one cannot be written.
        """
        folder = Path(directory)
        check_folder(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{folder} cannot be made: {error.strerror}") from None
        sketch = f"{self.prefix}.ino"  # Arduino wants it to be called as its folder
        named = {folder.resolve().name + ".ino" if f == sketch else f: text for f, text in self.files.items()}
        for name in named:
            check_target(folder / name, force, how)
        for name, text in sorted(named.items()):
            with writing_whole(folder / name) as file:
                file.write(text.encode())
        return [folder / name for name in sorted(named)]


def check_folder(folder: Path) -> None:
    """Refuse what is there and no directory; a link that leads nowhere is there."""
    if os.path.lexists(folder) and not folder.is_dir():
        raise InputError(f"{folder} exists and is no directory; name one")
    if folder.suffix in (".h", ".c", ".js", ".ino"):
        raise InputError(f"{folder} is a name of a file; give that of the directory in which all files go")


def emit(
    device: Device,
    environment: Environment | Any,
    *,
    target: str = "c99",
    number: str | None = None,
    travel: Interval | tuple[RealLike | str, RealLike | str] | str | None = None,
    force_unit: RealLike | str | None = None,
    prefix: str = "law",
    anyway: bool = False,
    decide: Decide = check,
) -> Emitted:
    """A law that was proved, as text for the machine that will run it.

    The text is made of the functions that the simulator and the servo run: the same operations in the same
    order, in double the same bits.  In float and in fixed point the error of the force is bounded, and the
    verdict is that of the loop with as much less Coulomb friction.

    Parameters
    ----------
    device
        The device; damping, Coulomb friction and delay may be intervals, which the verdict covers.
    environment
        What it renders, with the laws in its chain.
    target
        "c99": one header.  "javascript": one ES module.  "arduino", "cortex-m", "posix", "simplefoc",
        "moteus": the header with a main program.
    number
        "double", "float" or "fixed"; by default "fixed" for arduino, "float" for cortex-m and simplefoc, else
        "double".
    travel
        The lowest and the highest position [m; rad], such as "-50 .. 50 mm"; by default 32767 counts to each
        side where numbers are narrow.
    force_unit
        In fixed point, where the device's `force_resolution` is not known: the unit of the force [N; N·m].
    prefix
        What every name in the text begins with.
    anyway
        True to emit what is not proved passive, too; the text says so.
    decide
        In the place of `zwidth.check`.

    Raises
    ------
    InputError
        If the law cannot be emitted so.
    NotEmitted
        If it is not proved passive in the target's numbers.
    """
    kind = _target(target)
    _check_prefix(prefix, kind)
    law = as_environment(environment, device=device)
    chosen = _number(number, kind)
    certain = _certain(device, law)
    made = law_program(certain, law, single=chosen == "float")
    numbers = machine(
        made,
        chosen,
        _counts(certain, made, chosen, travel),
        _force_unit(certain, force_unit),
        float(certain.exact("coulomb_friction")) * _OF_FRICTION,
    )
    found = judged(device, law, numbers, decide)
    if not (found.proved or anyway):
        raise NotEmitted(found, _why_not(found))
    certificate = f"{to_json(found.verdict.saved())}\n"
    files = {f"{prefix}.certificate.json": certificate}
    head = about(prefix, device, law, found)
    constants = defines(device, law, made, numbers, certificate)
    if kind.language == "javascript":
        files[f"{prefix}.mjs"] = module(
            made, about=head, numbers=constants, cuts_readings=numbers.cuts_readings
        )
    else:
        files[f"{prefix}.h"] = header(numbers, name=prefix, about=head, numbers=constants)
        files |= kind.mains(prefix)
    return Emitted(prefix, target, device, law, found, files)


def _certain(device: Device, law: Environment) -> Device:
    """The device that the law is packed for; what the law does not depend on may be an interval."""
    if laws_of(law) and isinstance(device.delay, Interval):
        given = shown(device.delay, "s")
        raise InputError(
            f"the delay is the interval {given}, and laws in a chain reckon with one number of it"
        )
    return least_friction(device)


def _why_not(found: Judged) -> str:
    """Why a law is not emitted, and what to do."""
    number, verdict = found.machine.number, found.verdict
    if verdict.outcome in PROVED:
        said = f"this is not emitted: it is proved in real numbers, not in {number}. {found.statement}"
        other = "a device with more Coulomb friction or a finer converter"
        if number != "double":
            other = 'number="double" (on the command line --number double)'
        return f"{said} Take {other}, another law, or anyway=True (--anyway)"
    lost = found.counted and found.ideal.outcome in PROVED
    where = f", in {number}" if lost else ""
    said = f"this is not emitted, it is {verdict.outcome}{where}: {verdict.claim}"
    more = found.statement if lost else ""
    return f"{said} {more}Soften the wall, raise the rate, or give anyway=True (--anyway)"


def _target(target: str) -> Target:
    if target not in TARGETS:
        raise InputError(f"target is one of {', '.join(TARGETS)}, got {target!r}")
    return TARGETS[target]


def _check_prefix(prefix: str, target: Target) -> None:
    if not (isinstance(prefix, str) and fullmatch("[a-z][a-z0-9_]*", prefix)):
        raise InputError(
            f"prefix begins names in C: small letters, digits and _, such as law, got {prefix!r}"
        )
    if f"{prefix}.h" in target.mains(prefix):
        raise InputError(f"prefix is {prefix!r}, and {prefix}.h is a file of the main program: take another")


def _number(number: str | None, target: Target) -> Number:
    chosen = target.number if number is None else number
    if chosen not in target.numbers:
        raise InputError(
            f"number is {' or '.join(target.numbers)} for {target.name}, got {chosen!r}: {target.why_numbers}"
        )
    return chosen  # type: ignore[return-value]


def _counts(device: Device, law: LawProgram, number: Number, travel: object) -> tuple[float, float]:
    """The readings that are claimed of."""
    if travel is None:
        if law.resolution == 0.0:
            raise InputError(
                "the device has no encoder resolution, so its positions have no bound: give travel, the "
                "lowest and the highest position, or resolution"
            )
        most = _WHOLE if number == "double" else MOST_COUNTS
        return -most, most
    found = parse(travel, quantity_unit("position", device.motion), "travel")
    low, high = map(float, ends(found))
    if not low < high:
        raise InputError(f"travel goes from the lowest to the highest position, got {low:g} alone")
    if law.resolution == 0.0:
        return low, high
    counts = floor(low / law.resolution), -floor(-high / law.resolution)
    if max(map(abs, counts)) > _WHOLE:
        raise InputError(f"travel is {max(map(abs, counts))} counts long, more than 32 bits hold")
    return counts


def _force_unit(device: Device, given: RealLike | str | None) -> float | None:
    if given is None:
        return None
    value = float(parse_number(given, quantity_unit("force", device.motion), "force_unit"))
    if not value > 0.0:
        raise InputError(f"force_unit must be > 0, got {value:g}: it is what one step of the force is")
    return value


def _numbers(machine: Machine) -> str:
    if machine.fixed is None:
        return machine.number
    scale = machine.fixed.units.scale
    return f"fixed point, {scale.word} bits, force in 2^-{scale.fraction} of a step"
