"""The loop, closed in time: sampling, hold, delay and the exact motion between force changes."""
