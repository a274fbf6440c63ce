"""A loop as text: device, environment and laws in TOML tables, read and written."""
