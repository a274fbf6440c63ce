/* A law as a shared library of this machine. */
#include <stdint.h>

#include "law.h"

static law_state state;

int whole(void);
int size(void);
void init(int32_t counts);
void reset(void);
void run(const int32_t *counts, law_force *forces, long n);

int whole(void) { return (law_force)0.5 == 0; }

int size(void) { return (int)sizeof(law_force); }

void init(int32_t counts) { law_init(&state, counts); }

void reset(void) { law_reset(&state); }

void run(const int32_t *counts, law_force *forces, long n) {
    for (long k = 0; k < n; k++)
        forces[k] = law_step(&state, counts[k]);
}

#ifdef SEPARATE
#include <stdio.h>

/* As a process of its own: counts come in, the first is where the law begins. */
int main(void) {
    int32_t counts;
    volatile law_force force;
    if (fread(&counts, sizeof counts, 1, stdin) == 1)
        init(counts);
    while (fread(&counts, sizeof counts, 1, stdin) == 1) {
        force = law_step(&state, counts);
        (void)force;
    }
    reset();
    return 0;
}
#endif
