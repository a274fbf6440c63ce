"""Virtual coupling as a two-port, and loop transformations."""
