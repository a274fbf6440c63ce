/* A law on the ATmega328P.  What is outside is asked for counts by a write to GPIOR0, and answers in memory. */
#include <avr/io.h>
#include <stdint.h>

#include "law.h"

#define ALONE __attribute__((noinline, noclone))

enum { READY = 1, BEGIN = 2, END = 3 };
enum { STEP = 0, INIT = 1, RESET = 2, EMPTY = 3 };

static law_state state;
static volatile struct {
    int32_t counts;
    law_force force;
    uint8_t wanted, bytes, whole;
} exchange;
typedef char force_has_four_bytes[sizeof(law_force) == 4 ? 1 : -1];

static ALONE law_force step(int32_t counts) {
    __asm__ volatile("" ::: "memory");
    law_force force = law_step(&state, counts);
    __asm__ volatile("" ::: "memory");
    return force;
}

#ifdef __cplusplus
extern "C" /* the compiler of a sketch */
#endif
    law_force empty(int32_t counts);
__asm__("empty: ret\n");

/* One function for both, so that what surrounds the call costs the same. */
static ALONE law_force timed(law_force (*call)(int32_t), int32_t counts) {
    GPIOR0 = BEGIN;
    law_force force = call(counts);
    GPIOR0 = END;
    return force;
}

int main(void) {
    GPIOR1 = (uint8_t)(uintptr_t)&exchange;
    GPIOR2 = (uint8_t)((uintptr_t)&exchange >> 8);
    exchange.bytes = sizeof(law_force);
    exchange.whole = (law_force)0.5 == 0;
    for (;;) {
        GPIOR0 = READY;
        if (exchange.wanted == INIT)
            law_init(&state, exchange.counts);
        else if (exchange.wanted == RESET)
            law_reset(&state);
        else
            exchange.force = timed(exchange.wanted == EMPTY ? empty : step, exchange.counts);
    }
}
