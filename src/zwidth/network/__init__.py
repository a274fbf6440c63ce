"""Scenes and devices in several processes: what carries their waves, and what is seen of it."""

from zwidth.network.channel import Channel
from zwidth.network.frame import Frame
from zwidth.network.lossy import Lossy
from zwidth.network.monitor import Link, LinkReport
from zwidth.network.open import open_channel
from zwidth.network.shared_memory import SharedMemory
from zwidth.network.udp import UDP
from zwidth.network.zenoh import Zenoh

__all__ = ["UDP", "Channel", "Frame", "Link", "LinkReport", "Lossy", "SharedMemory", "Zenoh", "open_channel"]
