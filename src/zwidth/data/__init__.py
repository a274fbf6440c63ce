"""From recordings: logs, what they tell of a device, a tissue, a finger, of what shakes; files of gains."""
