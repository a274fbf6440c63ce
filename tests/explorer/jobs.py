"""What a process may be asked to do; it imports nothing that takes long."""

from __future__ import annotations

import os
import time

from zwidth.errors import InputError


def doubled(value: int) -> int:
    return 2 * value


def refused(value: int) -> int:
    raise InputError(f"{value} cannot be")


def failed(value: int) -> int:
    raise ZeroDivisionError(value)


def ended(value: int) -> int:
    os._exit(value)


def endless(value: int) -> int:
    time.sleep(3600)
    return value
