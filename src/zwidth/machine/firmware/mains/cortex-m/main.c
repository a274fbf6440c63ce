/* A law on a Cortex-M: sample k at every turn of SysTick, with no library of a vendor.
 *
 * What differs from one board to the next is behind five functions.  Here they are weak: position 0, no force,
 * no line, no watchdog.  Put yours in a file beside this one, and CPU_HZ on the compiler's command line.
 *
 * The force begins and ends as guard.h says; it ends for good as well where a sample takes longer than its
 * period, and at every fault of the processor.  Where SysTick itself stops nothing here notices: that is what
 * the watchdog of the chip is for, which must reset it, and whose reset must leave the motor without force.
 */
#include <stdint.h>

#include "law.h"

#include "guard.h"
#include "telemetry.h"

#ifndef CPU_HZ
#define CPU_HZ 25000000 /* of the mps2-an386 */
#endif

#define WEAK __attribute__((weak))

/* The position now [counts]; GUARD_NO_READING where there is none. */
WEAK int32_t position_counts(void) { return 0; }

/* The force of the law from now on: where it is positive the motor pushes the handle out of the wall. */
WEAK void apply_force(law_force force) { (void)force; }

/* Send a byte of telemetry; 0 where the line takes none just now.  It must not wait. */
WEAK int send_byte(uint8_t byte) {
  (void)byte;
  return 1;
}

/* Start the chip's watchdog, with a few periods of time; begin its time anew, at the end of every sample. */
WEAK void watchdog_start(void) {}
WEAK void watchdog_restart(void) {}

/* ARMv6-M, ARMv7-M, ARMv8-M: SysTick and interrupt control. */
#define SYST_CSR (*(volatile uint32_t *)0xE000E010u)
#define SYST_RVR (*(volatile uint32_t *)0xE000E014u)
#define SYST_CVR (*(volatile uint32_t *)0xE000E018u)
#define ICSR (*(volatile uint32_t *)0xE000ED04u)
#define PENDSTSET (1u << 26)

#define TICKS ((uint32_t)(CPU_HZ * LAW_SAMPLE_PERIOD_S + 0.5))
#define PERIOD_ERROR (TICKS / (CPU_HZ * LAW_SAMPLE_PERIOD_S) - 1.0)

GUARD_CHECK(systick_counts_this_period, TICKS >= 2 && TICKS <= 0x1000000);
GUARD_CHECK(the_period_is_met_within_1_in_10000, PERIOD_ERROR < 1e-4 && PERIOD_ERROR > -1e-4);

static guard guarded;
static telemetry told;
static uint32_t now;      /* [us] since the start, by the samples */
static uint32_t now_rest; /* [ns] */

static void count_time(void) {
  const uint32_t period = (uint32_t)(1e9 * LAW_SAMPLE_PERIOD_S + 0.5);
  now += period / 1000;
  now_rest += period % 1000;
  if (now_rest >= 1000) {
    now_rest -= 1000;
    now++;
  }
}

void SysTick_Handler(void);
void SysTick_Handler(void) {
  const law_force force = guard_step(&guarded, position_counts());
  apply_force(force);
  telemetry_sample(&told, now, guarded.counts, force, guard_status(&guarded));
  count_time();
  if (ICSR & PENDSTSET) { /* the next one is due already: no loop of this period any more */
    guard_end(&guarded, GUARD_LATE);
    apply_force(0);
  }
  watchdog_restart();
}

/* Every other exception: force 0, and nothing more. */
void fault(void);
void fault(void) {
  guard_end(&guarded, GUARD_FAILED);
  for (;;) {
    apply_force(0);
    watchdog_restart();
  }
}

int main(void) {
  int byte = -1;
  guard_init(&guarded);
  telemetry_init(&told);
  apply_force(0);
  SYST_CSR = 0;
  SYST_RVR = TICKS - 1;
  SYST_CVR = 0;
  watchdog_start();
  SYST_CSR = 7; /* the processor's clock, with its interrupt */
  for (;;) {
    if (byte < 0) {
      byte = telemetry_next(&told);
    }
    if (byte >= 0 && send_byte((uint8_t)byte)) {
      byte = -1;
    }
  }
}
