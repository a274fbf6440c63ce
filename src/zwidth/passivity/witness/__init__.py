"""Motions that take energy out: unstable modes, sinusoids, edges of counts, touches."""
