from zwidth.environment import VirtualBody as VirtualBody
from zwidth.loop.admittance import simulate_admittance as simulate_admittance
from zwidth.loop.timing import Timing as Timing
from zwidth.traces import simulate_batch as simulate_batch
