#!/usr/bin/env bash
# newlib-nano (Debian's libnewlib-arm-none-eabi, 3.3.0): a force is printed as nothing.
#
# printf("time_ms=%ld,force=%.3f,velocity=%g,state=%d\n", 12L, 1.5, 0.25, 7) on a Cortex-M in QEMU. Seen:
#   newlib                                        time_ms=12,force=1.500,velocity=0.25,state=7
#   --specs=nano.specs                            time_ms=12,force=,velocity=,state=7
#   --specs=nano.specs -u _printf_float           as newlib
# Neither compiler nor linker says a word, with -Wall -Wextra.
# Where it bites: nano.specs is what projects for small chips are made with. Lines of a serial log still have
# all commas, so they are read as a table with an empty column; "missing" is then filled up or dropped by what
# reads it.
# Instead: -u _printf_float (some kB), or send integers (force in mN, velocity in µm/s).
set -euo pipefail
for tool in arm-none-eabi-gcc qemu-system-arm; do
  command -v "$tool" >/dev/null ||
    { echo "$tool is not there: install gcc-arm-none-eabi, libnewlib-arm-none-eabi, qemu-system-arm" >&2; exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
arm-none-eabi-gcc -dumpversion
qemu-system-arm --version | head -n 1
cat >log.c <<'C'
#include <stdint.h>
#include <stdio.h>

extern void _start(void);
__attribute__((section(".vectors"), used)) static const uintptr_t vectors[2] = {0x00200000u, (uintptr_t)_start};

int main(void) {
  printf("time_ms=%ld,force=%.3f,velocity=%g,state=%d\n", 12L, 1.5, 0.25, 7);
  return 0;
}
C
printed() {
  local said
  said=$(arm-none-eabi-gcc -Wall -Wextra -O2 -mcpu=cortex-m4 -mthumb "$@" --specs=rdimon.specs \
    -Wl,--section-start=.vectors=0 log.c -o log.elf 2>&1)
  test -z "$said" || { echo "said: $said" >&2; return 1; }
  timeout 60 qemu-system-arm -M mps2-an386 -nographic -semihosting-config enable=on,target=native -kernel log.elf </dev/null
}
seen() {
  local want=$1 got
  shift
  got=$(printed "$@")
  echo "${*:-newlib}: $got"
  test "$got" = "$want"
}
seen 'time_ms=12,force=1.500,velocity=0.25,state=7'
seen 'time_ms=12,force=,velocity=,state=7' --specs=nano.specs
seen 'time_ms=12,force=1.500,velocity=0.25,state=7' --specs=nano.specs -u _printf_float
echo "as described"
