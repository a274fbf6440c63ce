"""What people do with a trace: look, listen, save, load, compare; and what they wait for, with a bar."""

from zwidth.loop.simulated_device import SimulatedDevice
from zwidth.traces.accessor import TraceAccessor
from zwidth.traces.comparison import Comparison, compare_traces
from zwidth.traces.files import load_trace, save_trace
from zwidth.traces.run import available_storage, compare, identify, passive_limit, simulate, simulate_batch
from zwidth.traces.sound import save_sound

__all__ = [
    "Comparison",
    "SimulatedDevice",
    "TraceAccessor",
    "available_storage",
    "compare",
    "compare_traces",
    "identify",
    "load_trace",
    "passive_limit",
    "save_sound",
    "save_trace",
    "simulate",
    "simulate_batch",
]
