"""A robot description as pinocchio's model of it; what pinocchio has against a file becomes one message."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any
from xml.parsers.expat import ExpatError, ParserCreate

from zwidth.errors import InputError
from zwidth.missing import did_you_mean

_ENDINGS = {".urdf": "buildModelFromUrdf", ".xml": "buildModelFromMJCF", ".mjcf": "buildModelFromMJCF"}
_STANDARD_ERROR = 2
_LARGEST = 2**25
"""[bytes] Largest description that is read."""

_DEEPEST, _MOST_PARTS = 200, 2000
_PARTS = ("link", "body", "joint", "freejoint")


def read_model(path: Path) -> Any:
    """The `pinocchio.Model` of a .urdf, .xml or .mjcf file.

    Raises
    ------
    InputError
        If it is none of these, cannot be read, or nothing in it moves.
    """
    build = _ENDINGS.get(path.suffix.lower())
    if build is None:
        raise InputError(f"an arm is described in a .urdf, .xml or .mjcf file, got {path.name!r}")
    if not path.is_file():
        raise InputError(f"there is no file {path}{did_you_mean(path)}")
    try:
        import pinocchio as pin
    except ImportError:
        raise InputError("reading robot descriptions needs pinocchio: pip install 'zwidth[arms]'") from None
    _check_xml(path)
    said: list[str] = []
    try:
        with _hearing(said):
            model = getattr(pin, build)(str(path))
    except (ValueError, RuntimeError) as error:
        raise InputError(f"{path.name} cannot be read: {_reason(str(error), said)}") from None
    if model.nv == 0:
        raise InputError(f"{path.name} has no joint that moves")
    return model


def _check_xml(path: Path) -> None:
    """Refuse what is no XML, and what other parsers would be led astray by."""
    watch, parser = _Watch(), ParserCreate()
    parser.StartDoctypeDeclHandler = watch.doctype
    parser.StartElementHandler, parser.EndElementHandler = watch.begin, watch.end
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"it is larger than {_LARGEST} bytes, and no description of an arm is")
        with open(path, "rb") as file:
            parser.ParseFile(file)
    except InputError as error:
        raise InputError(f"{path.name} cannot be read: {error}") from None
    except (ExpatError, OSError, ValueError) as error:
        raise InputError(f"{path.name} cannot be read: it is no XML, {error}") from None


class _Watch:
    """Refuses, while a description is parsed, what would make it grow, lead elsewhere, or end the process."""

    def __init__(self) -> None:
        self._depth = self._parts = 0

    def doctype(self, *_: object) -> None:
        """Entities can name other files, and a few lines of them stand for gigabytes."""
        raise InputError("it has a DOCTYPE, which no robot description needs; take it out")

    def begin(self, name: str, _: object) -> None:
        """Parsers go deeper by themselves with each level, and with each joint."""
        self._depth += 1
        self._parts += name in _PARTS
        if name == "include":
            raise InputError("it includes another file; put all into one")
        if self._depth > _DEEPEST or self._parts > _MOST_PARTS:
            raise InputError(
                f"it has more than {_DEEPEST} levels, or {_MOST_PARTS} bodies and joints; no arm has so many"
            )

    def end(self, _: str) -> None:
        self._depth -= 1


@contextmanager
def _hearing(said: list[str]) -> Iterator[None]:
    """Take down what libraries in C++ print to standard error; if all goes well it is printed after all."""
    sys.stderr.flush()
    own = os.dup(_STANDARD_ERROR)
    with TemporaryFile() as heard:
        os.dup2(heard.fileno(), _STANDARD_ERROR)
        try:
            yield
        except BaseException:
            heard.seek(0)
            said.append(heard.read().decode(errors="replace"))
            raise
        else:
            heard.seek(0)
            os.write(own, heard.read())
        finally:
            os.dup2(own, _STANDARD_ERROR)
            os.close(own)


def _reason(error: str, said: list[str]) -> str:
    """The words for a user: not in which line of which C++ file."""
    first = next((line for line in "".join(said).splitlines() if line.strip()), "")
    text = error.partition("message:")[2] or first.removeprefix("Error:") or error
    return " ".join(text.split())[:200]
