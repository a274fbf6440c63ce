"""Arrays that are computed and kept piece by piece: what is stopped goes on, whoever computes."""
