"""What people do with a trace: look, listen, save, load, compare."""

from zwidth.traces.accessor import TraceAccessor
from zwidth.traces.comparison import Comparison, compare_traces
from zwidth.traces.files import load_trace, save_trace
from zwidth.traces.run import simulate, simulate_batch
from zwidth.traces.sound import save_sound

__all__ = [
    "Comparison",
    "TraceAccessor",
    "compare_traces",
    "load_trace",
    "save_sound",
    "save_trace",
    "simulate",
    "simulate_batch",
]
