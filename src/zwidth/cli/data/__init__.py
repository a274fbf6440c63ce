"""Commands that read what was measured: a device, a tissue, why it shook, how to measure."""
