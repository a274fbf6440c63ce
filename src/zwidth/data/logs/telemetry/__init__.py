"""What a law on a machine of its own tells over a serial line: how its packets are read, whole or damaged."""
