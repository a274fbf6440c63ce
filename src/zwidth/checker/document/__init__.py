"""A document as it was read: exact numbers, of ordinary size, and what reading and checking it may cost."""
