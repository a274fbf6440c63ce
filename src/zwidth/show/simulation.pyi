from zwidth.loop.admittance import simulate_admittance as simulate_admittance
from zwidth.loop.pair.simulate import simulate_pair as simulate_pair
from zwidth.loop.simulated_device import SimulatedDevice as SimulatedDevice
from zwidth.loop.timing import Timing as Timing
from zwidth.model.device import amplifier as amplifiers
from zwidth.model.environment import VirtualBody as VirtualBody
from zwidth.show.with_bar import simulate_batch as simulate_batch
