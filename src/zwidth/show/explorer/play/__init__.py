"""A handle, a wall and a hand on a page: the emitted law, played at its true rate, seen and heard."""

from zwidth.show.explorer.play.loop import Played, play_page, played, played_pair
from zwidth.show.explorer.play.presets import presets

__all__ = ["Played", "play_page", "played", "played_pair", "presets"]
