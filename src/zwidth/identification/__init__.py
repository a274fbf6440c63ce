"""From measurements to models: what stood behind a record of positions and forces."""
