"""Laws in a row: their states in a table, and the available storage over it."""
