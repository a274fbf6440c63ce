"""Storage functions on a grid of readings, every move one by one."""
