"""Commands of real time: to render on a device, to emit a law, to look at the machine and its recordings."""
