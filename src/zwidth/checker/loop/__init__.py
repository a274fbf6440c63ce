"""One loop: its criterion, its closed forms, and motions that stay inside."""
