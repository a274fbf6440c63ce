"""Recorded data: a file or arrays become runs of samples in SI units; what was odd is said."""

from zwidth.data.logs.log import Log
from zwidth.data.logs.read import read_log
from zwidth.data.logs.table import BLOCK_SIZE, Block, Finding

__all__ = ["BLOCK_SIZE", "Block", "Finding", "Log", "read_log"]
