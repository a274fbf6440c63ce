"""Step functions in C: what a name means, a function written out, all of them built, and called."""
