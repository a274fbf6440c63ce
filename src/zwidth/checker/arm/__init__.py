"""An arm of several joints in its region."""
