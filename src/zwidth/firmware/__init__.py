"""A law on a machine of its own, without zwidth: what surrounds it there, and what it tells of itself."""
