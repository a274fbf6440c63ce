"""Contact made and broken: proofs for walls with a memory, and motions that touch and leave."""
