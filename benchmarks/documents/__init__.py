"""A fuzzer of proof documents: a grammar that writes them, and judges that share no code with the checker."""
