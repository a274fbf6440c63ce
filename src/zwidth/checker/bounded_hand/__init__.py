"""A hand of which a bound is known: of its activity, or of its speed."""
