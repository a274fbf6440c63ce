/* The wall as one first writes it in Q16.16: products of 64 bits, a division by the period. */
#include <stdint.h>

#define LAW_SAMPLE_PERIOD_S 0.001
#define LAW_RATE_HZ 1000
#define LAW_RESOLUTION 2.24e-05
#define LAW_COUNTS_MIN (-32767)
#define LAW_COUNTS_MAX 32767
#define LAW_FORCE_PER_UNIT 1.52587890625e-05
#define LAW_FORCE_LIMIT 16.5

typedef int32_t law_force;

typedef struct {
    int32_t x;
} law_state;

static inline int32_t law_product(int32_t a, int32_t b) { return (int32_t)(((int64_t)a * b) >> 16); }

/* mm: a metre in Q16.16 has too few steps */
static inline int32_t law_position(int32_t counts) { return law_product(counts * 64, 1503239); }

static inline void law_init(law_state *s, int32_t counts) { s->x = law_position(counts); }

static inline law_force law_step(law_state *s, int32_t counts) {
    int32_t x = law_position(counts);
    int32_t v = x - s->x;                                     /* mm a sample: m/s */
    int32_t f = law_product(19661, x) + law_product(3277, v); /* 0.3 N/mm, 0.05 N s/m */
    s->x = x;
    if (x <= 0)
        f = 0;
    if (f > 1081344)
        f = 1081344;
    if (f < -1081344)
        f = -1081344;
    return f;
}

static inline void law_reset(law_state *s) { (void)s; }
