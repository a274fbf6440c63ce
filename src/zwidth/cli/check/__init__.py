"""Commands on one loop: its verdict, how far a number may go, several devices, saved proofs."""
