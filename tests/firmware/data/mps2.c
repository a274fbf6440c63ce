/* The hooks of the Cortex-M program on the mps2-an386 that QEMU emulates: a handle that swings, its first UART.
 *
 * After SAMPLES samples the emulator ends, once the line is empty; with FAULTY a fault comes in the sample of
 * that number, or LONG turns of a loop; the status is 7 where a force acted before and 0 is applied in that sample.
 */
#include <stdint.h>

#include "law.h"

#define UART ((volatile uint32_t *)0x40004000u) /* CMSDK: data, state, control, interrupt, divisor */

static uint32_t samples, applied;

static void end(uint32_t status) {
  static volatile uint32_t words[2];
  words[0] = 0x20026; /* semihosting: ended by itself */
  words[1] = status;
  register uint32_t what __asm("r0") = 0x20;
  register volatile uint32_t *of __asm("r1") = words;
  __asm volatile("bkpt 0xAB" : : "r"(what), "r"(of) : "memory");
}

int32_t position_counts(void) {
  const int32_t phase = (int32_t)(samples++ % 800);
#ifdef FAULTY
  if (samples == FAULTY) {
#ifdef LONG
    for (volatile uint32_t k = 0; k < LONG; k++) {
    }
#else
    __asm volatile("udf #0");
#endif
  }
#endif
  return phase < 200 ? -phase : phase < 600 ? phase - 400 : 800 - phase; /* 0, -200, 200, 0 */
}

void apply_force(law_force force) {
#ifdef FAULTY
  if (samples == FAULTY - 1) {
    applied = force != 0;
  } else if (samples == FAULTY && force == 0) {
    end(applied ? 7 : 8);
  }
#else
  (void)force;
  (void)applied;
#endif
}

int send_byte(uint8_t byte) {
  UART[2] = 1;
  UART[4] = 16;
  if (UART[1] & 1) {
    return 0;
  }
  UART[0] = byte;
  return 1;
}

void watchdog_restart(void) {
  if (samples > SAMPLES + 50) {
    end(0);
  }
}
