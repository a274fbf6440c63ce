"""A hand that is known: what comes to rest, and what does not."""
