"""A test whose tool is missing says which; where every target is wanted it fails."""

from __future__ import annotations

import pytest
from firmware.emulated import required


def test_a_missing_tool_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(required.TOOLS, "toaster", {"no-such-compiler": None})
    monkeypatch.setitem(required.TOOLS, "nothing", {})
    monkeypatch.delenv("ZWIDTH_EVERY_TARGET", raising=False)
    required.require("nothing")
    with pytest.raises(pytest.skip.Exception, match="no-such-compiler"):
        required.require("nothing", "toaster")
    monkeypatch.setenv("ZWIDTH_EVERY_TARGET", "1")
    with pytest.raises(pytest.fail.Exception, match="no-such-compiler"):
        required.require("toaster")


def test_a_missing_header_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    required.require("host")
    monkeypatch.setitem(required.TOOLS, "bare", {"gcc": "no/such/header.h"})
    assert required.missing("bare") == ("no/such/header.h of gcc",)
