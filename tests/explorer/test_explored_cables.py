"""A device with a transmission on the page: its address, its sliders, the region around its wall."""

from urllib.parse import parse_qsl

import numpy as np

import zwidth as zw
from zwidth.show.explorer.computing import judged_at_once, judged_in_full, region_of, touched
from zwidth.show.explorer.controls import device_controls
from zwidth.show.explorer.state import State, from_query

CABLE = zw.Transmission(stiffness=28657, handle_mass="0.03", handle_damping="0.09")
DEVICE = zw.Device(mass="30 g", damping="0.06", rate="1 kHz", transmission=CABLE, name="cable")
STATE = State.of(DEVICE, zw.Wall(125))


def test_the_address_holds_it():
    again = from_query(parse_qsl(STATE.query()))
    assert again.loop().device == STATE.loop().device
    assert again.loop().device.transmission == CABLE


def test_each_number_has_a_slider():
    paths = {one.path for one in device_controls(STATE, DEVICE)}
    assert {f"device.transmission.{key}" for key in ("stiffness", "damping", "handle_damping")} <= paths
    softer = STATE.changed("device.transmission.stiffness", "2.132 N/mm")
    assert judged_in_full(softer).outcome == "active"
    assert not [one for one in device_controls(STATE, DEVICE.motor_side) if "transmission" in one.path]


def test_what_is_shown_of_it():
    """The verdict by a process of its own, walls of both kinds, and a touch."""
    assert judged_at_once(STATE.loop()).verdict is None
    assert judged_in_full(STATE).outcome == "passive in contact"
    assert set(np.unique(region_of(STATE).kinds)) == {0, 2, 3}
    assert touched(STATE).peak_force > 0
