"""An attack on the verdicts by a referee that shares no code with what it judges.

loops      random loops of all kinds near their limits, for the package and for the referee
motions    motions of a hand, drawn and then improved, run through the loop as it is programmed
referee    energies in exact arithmetic, the linear criterion in complex balls
rows       the same for laws in a chain
judge      one verdict against the referee
ledger     which seeds were run, and what came out
"""
