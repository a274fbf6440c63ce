from zwidth.machine.servo.live.browser import open_page as open_page
from zwidth.machine.servo.live.foxglove import serve_foxglove as serve_foxglove
from zwidth.machine.servo.live.page import Page as Page
from zwidth.machine.servo.live.rows import Rows as Rows
from zwidth.machine.servo.live.terminal import watch_in_terminal as watch_in_terminal
