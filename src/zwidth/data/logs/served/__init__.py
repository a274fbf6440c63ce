"""Recordings of a served loop: what they hold, and how they are read, whole or cut off."""
