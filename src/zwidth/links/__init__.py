"""Ports between a device and a link that delays, loses and reorders packets."""

from zwidth.links.held_waves import HeldWaves
from zwidth.links.naive_waves import NaiveWaves
from zwidth.links.packet import Packet
from zwidth.links.port import Port
from zwidth.links.position_hold import PositionHold
from zwidth.links.time_domain import TimeDomain
from zwidth.links.two_layer import TwoLayer
from zwidth.links.wave_port import WavePort

__all__ = ["HeldWaves", "NaiveWaves", "Packet", "Port", "PositionHold", "TimeDomain", "TwoLayer", "WavePort"]
