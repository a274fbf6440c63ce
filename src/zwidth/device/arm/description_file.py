"""A robot description as pinocchio's model of it; what pinocchio has against a file becomes one message."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any
from xml.etree import ElementTree

from zwidth.errors import InputError

_ENDINGS = {".urdf": "buildModelFromUrdf", ".xml": "buildModelFromMJCF", ".mjcf": "buildModelFromMJCF"}
_STANDARD_ERROR = 2


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
        raise InputError(f"there is no file {path}")
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
    try:
        ElementTree.parse(path)
    except (ElementTree.ParseError, OSError, ValueError) as error:
        raise InputError(f"{path.name} cannot be read: it is no XML, {error}") from None


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
