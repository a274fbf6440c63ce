"""What the page on links shows, runs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from zwidth.links import Packet

PAGE = Path(__file__).parents[2] / "docs" / "links.md"


class Mail:
    """A socket that does not block."""

    def __init__(self, datagrams: list[bytes]) -> None:
        self.datagrams = datagrams

    def recv(self, _: int) -> bytes:
        """The next one."""
        if not self.datagrams:
            raise BlockingIOError
        return self.datagrams.pop(0)


def test_its_first_two_examples_run(capsys: pytest.CaptureFixture[str]) -> None:
    """Two ports over a link that loses every other packet; packets from a socket, broken ones left out."""
    names: dict[str, Any] = {}
    for block in re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[:2]:
        exec(block, names)
    assert re.fullmatch(r"-?\d\.\d\d N\n", capsys.readouterr().out)
    first, second = Packet(0, 0.0, 0.0, 0.0, 5), Packet(1, 1e-3, 1e-6, 2e-5, 5)
    broken = second.to_bytes()[:-1] + b"\0\0"
    mail = Mail([first.to_bytes(), broken, second.to_bytes()])
    assert names["arrived"](mail) == [first, second]
