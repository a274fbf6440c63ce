#!/usr/bin/env bash
# avr-gcc (Debian's gcc-avr, 5.4.0): double is float, and there is no option to change it.
#
# Seen, by assertions that the compiler itself decides:
#   sizeof(double), sizeof(long double)   4, 4
#   16777217.0 == 16777216.0              true: whole numbers end at 2^24
#   1.0 + 5e-8 == 1.0                     true: 7 digits
#   -mdouble=64                           refused as unknown (it came with GCC 10)
# and nothing is said, with -Wall -Wextra.
# Where it bites: micros() / 1e6 has steps of 1 µs only in the first 16 s; after half an hour they are 0.12
# ms, an eighth of a 1 kHz period. A law that was tried in double on a PC is another one here: energy counters
# stop growing at 2^24 of their smallest step.
# Instead: keep time and position as integers and convert differences; try the law in float on the PC.
set -euo pipefail
command -v avr-gcc >/dev/null || { echo "avr-gcc is not there: install the package gcc-avr" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
avr-gcc -dumpversion
cat >double.c <<'C'
_Static_assert(sizeof(double) == 4 && sizeof(long double) == 4, "double is wider");
_Static_assert(16777217.0 == 16777216.0, "2^24 + 1 is a number");
_Static_assert(1.0 + 5e-8 == 1.0, "more than 24 bits");
_Static_assert((1800000001.0 / 1e6) == (1800000050.0 / 1e6), "half an hour is known to 1 us");
C
said=$(avr-gcc -mmcu=atmega328p -std=gnu11 -Wall -Wextra -c double.c -o double.o 2>&1) || { echo "$said"; exit 1; }
test -z "$said" || { echo "the compiler says: $said"; exit 1; }
echo "double has 4 bytes, 2^24 + 1 is no number, nothing is said"
if avr-gcc -mmcu=atmega328p -mdouble=64 -c double.c -o double.o 2>option.txt; then
  echo "-mdouble=64 is taken"
  exit 1
fi
grep -F 'mdouble=64' option.txt
echo "as described"
