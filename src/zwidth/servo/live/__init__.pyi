from zwidth.servo.live.browser import open_page as open_page
from zwidth.servo.live.foxglove import serve_foxglove as serve_foxglove
from zwidth.servo.live.page import Page as Page
from zwidth.servo.live.rows import Rows as Rows
from zwidth.servo.live.terminal import watch_in_terminal as watch_in_terminal
