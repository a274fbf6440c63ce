from zwidth.loop.simulated_device import SimulatedDevice as SimulatedDevice
from zwidth.loop.traces.accessor import TraceAccessor as TraceAccessor
from zwidth.loop.traces.comparison import Comparison as Comparison
from zwidth.loop.traces.comparison import compare_traces as compare_traces
from zwidth.loop.traces.files import load_trace as load_trace
from zwidth.loop.traces.files import save_sound as save_sound
from zwidth.loop.traces.files import save_trace as save_trace
