"""Device, hand and tissue, identified from what was recorded."""
