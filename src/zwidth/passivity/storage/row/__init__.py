"""Laws in a chain: their states in a table, and the available storage over it."""
