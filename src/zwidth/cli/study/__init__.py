"""Commands on many loops: maps, sweeps, laws beside each other."""
