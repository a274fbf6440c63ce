"""What `zwidth` alone says: where to begin."""

from __future__ import annotations

WELCOME = """\
zwidth says which virtual walls your device can render without giving energy
to the hand: with a proof, or with the motion that takes energy out.

  zwidth tour                                   the story, in a minute
  zwidth check haptic-paddle --stiffness 300    a first proof
  zwidth new device                             the file of your own device
  zwidth examples .                             sample files, put here

zwidth --help lists all commands."""
