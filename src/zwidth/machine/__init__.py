"""On real things: the loop in real time, the law as a program of a microcontroller, two ends of a network."""
