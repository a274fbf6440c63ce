"""Makes `from stepped_loop import radius` work."""
