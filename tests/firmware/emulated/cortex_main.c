/* A law on a Cortex-M4: counts from the file "counts", forces to "forces", instructions of each step to "cost".

   SysTick runs on virtual time, of which every instruction takes 1024 ns (-icount shift=10): 25.6 of its ticks at
   25 MHz, so that the whole number of instructions is known.  It starts at its highest before each step. */
#include <stdint.h>

#include "law.h"

#define ALONE __attribute__((noinline, noclone))
#define SYSTICK ((volatile uint32_t *)0xE000E010) /* control, reload, current */
#define CPACR (*(volatile uint32_t *)0xE000ED88)
#define MOST 0xFFFFFFu
#define SOME 256

enum { OPEN = 1, WRITE = 5, READ = 6, EXIT = 0x18 };
enum { READING = 1, WRITING = 5, WELL = 0x20026 };

static int32_t host(int32_t what, const void *with) {
    register int32_t r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uintptr_t opened(const char *name, uintptr_t length, uintptr_t mode) {
    uintptr_t with[3] = {(uintptr_t)name, mode, length};
    return (uintptr_t)host(OPEN, with);
}

static uintptr_t moved(int32_t what, uintptr_t file, const void *at, uintptr_t bytes) {
    uintptr_t with[3] = {file, (uintptr_t)at, bytes};
    return bytes - (uintptr_t)host(what, with); /* the answer is how many are left */
}

static law_state state;
static int32_t counts[SOME];
static union {
    law_force given[SOME];
    uint32_t room[2 * SOME]; /* the same for every law */
} forces;
static uint32_t cost[SOME];

static ALONE law_force step(int32_t now) {
    __asm__ volatile("" ::: "memory");
    law_force force = law_step(&state, now);
    __asm__ volatile("" ::: "memory");
    return force;
}

law_force empty(int32_t now);
__asm__(".thumb_func\nempty: bx lr\n");

/* One function for both, so that what surrounds the call costs the same. */
static ALONE uint32_t timed(law_force (*call)(int32_t), int32_t now, law_force *force) {
    SYSTICK[2] = 0;
    uint32_t begun = SYSTICK[2];
    *force = call(now);
    return begun - SYSTICK[2];
}

int main(void) {
    uint32_t told[2] = {sizeof(law_force), (law_force)0.5 == 0};
    uintptr_t in = opened("counts", 6, READING), out = opened("forces", 6, WRITING), by = opened("cost", 4, WRITING);
    SYSTICK[1] = MOST;
    SYSTICK[0] = 5; /* on, at the clock of the processor, without interrupts */
    moved(WRITE, by, told, sizeof told);
    law_force none;
    cost[0] = timed(empty, 0, &none);
    cost[0] = timed(empty, 0, &none);
    moved(WRITE, by, cost, sizeof *cost);
    uintptr_t n, first = 1;
    while ((n = moved(READ, in, counts, sizeof counts) / sizeof *counts) > 0) {
        for (uintptr_t k = 0; k < n; k++) {
            if (first) { /* the first number is where the law begins */
                law_init(&state, counts[k]);
                first = 0;
                cost[k] = 0;
                forces.given[k] = 0;
            } else
                cost[k] = timed(step, counts[k], forces.given + k);
        }
        moved(WRITE, out, forces.given, n * sizeof *forces.given);
        moved(WRITE, by, cost, n * sizeof *cost);
    }
    law_reset(&state);
    host(EXIT, (const void *)WELL);
    return 0;
}

static void started(void) {
    CPACR |= 0xFu << 20; /* the floating-point unit */
    __asm__ volatile("dsb\n isb");
    main();
}

extern const char stack_top;
__attribute__((section(".vectors"), used)) static const struct {
    const char *stack;
    void (*begin)(void);
} vectors = {&stack_top, started};
