#!/usr/bin/env bash
# arm-none-eabi-gcc (Debian's gcc-arm-none-eabi, 12.2.rel1): the force's bits on a Cortex-M4F depend on gnu99 or c99.
#
# float law(x, v, k, b) is k*x + b*v. Seen in the code that is made, at -O2:
#   -std=gnu99 (and no -std)              vmul, vfma: one rounding less
#   -std=c99                              vmul, vmul, vadd
#   -std=gnu99 -ffp-contract=off          vmul, vmul, vadd
# Where it bites: what is sent to the motor is not what the same C gave on a PC (x86-64 has no such
# instruction by default), so a comparison bit by bit fails; and k*x - b*v need not be 0 where the two
# products are equal, since only one of them is rounded.
# Instead: -ffp-contract=off where bits count, or fmaf() written out where it is wanted; the dialect alone is
# a poor switch.
set -euo pipefail
command -v arm-none-eabi-gcc >/dev/null || { echo "arm-none-eabi-gcc is not there: install gcc-arm-none-eabi" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
arm-none-eabi-gcc -dumpversion
echo 'float law(float x, float v, float k, float b) { return k * x + b * v; }' >law.c
made() {
  arm-none-eabi-gcc "$@" -O2 -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -S -o - law.c |
    grep -oE 'v(mul|add|fma|mla)\.f32' | tr '\n' ' '
}
seen() {
  local want=$1 got
  shift
  got=$(made "$@")
  echo "${*:-no -std}: $got"
  test "$got" = "$want"
}
seen 'vmul.f32 vfma.f32 '
seen 'vmul.f32 vfma.f32 ' -std=gnu99
seen 'vmul.f32 vmul.f32 vadd.f32 ' -std=c99
seen 'vmul.f32 vmul.f32 vadd.f32 ' -std=gnu99 -ffp-contract=off
echo "as described"
