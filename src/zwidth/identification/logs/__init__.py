"""Recorded data: a file or arrays become runs of samples in SI units; what was odd is said."""

from zwidth.identification.logs.arrays import log_of
from zwidth.identification.logs.join import join_logs
from zwidth.identification.logs.log import BLOCK_SIZE, Block, Finding, Log
from zwidth.identification.logs.read import read_log

__all__ = ["BLOCK_SIZE", "Block", "Finding", "Log", "join_logs", "log_of", "read_log"]
