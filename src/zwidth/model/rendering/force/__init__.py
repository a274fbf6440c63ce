"""Laws of the force alone: its size, its rate, its steps, pulses and dampers."""
