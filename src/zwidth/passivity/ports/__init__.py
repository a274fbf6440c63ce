"""Passivity of ports, of one axis and of several: certificates, motions, indices."""
