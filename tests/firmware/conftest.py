"""The Hapkit's chip and its surroundings, compiled once."""

from __future__ import annotations

from pathlib import Path

import pytest
from firmware.emulated.required import require, tool
from firmware.tools import DATA, WARNINGS, run


@pytest.fixture(scope="session")
def chip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require("avr")
    program = tmp_path_factory.mktemp("chip") / "chip"
    run(tool("cc"), "-std=gnu99", *WARNINGS, "-O2", DATA / "chip.c", "-o", program, "-lsimavr", "-lm")
    return program
