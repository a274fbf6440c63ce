"""Recorded data: a file or arrays become runs of samples in SI units; what was odd is said."""

from zwidth.identification.logs.block import BLOCK_SIZE, Block, Finding
from zwidth.identification.logs.log import Log
from zwidth.identification.logs.read import read_log

__all__ = ["BLOCK_SIZE", "Block", "Finding", "Log", "read_log"]
