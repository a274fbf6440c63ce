"""Storage functions on a board of readings, every move one by one."""
