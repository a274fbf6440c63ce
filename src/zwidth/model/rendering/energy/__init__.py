"""Laws that count energy or let through what has been paid for."""
