"""exp, expm1, log, log1p, tanh and powers that have the same bits on every machine.

Only sums, products, quotients and square roots of doubles, floor and comparisons: IEEE 754 says what each of
them is to the last bit, where a library's `exp` is its own.  What is simulated here is then what C99 and
JavaScript compute of the same source, as long as no product is contracted with a sum.

Each is the sum of two doubles before it is rounded, so that it errs by little more than half a unit in the
last place.
"""
