/* The wall in fixed point: counts and coefficients of 16 bits, products of 32, forces in 2^-20 N.  Both coefficients
   together stay below 2^16, so that the products stay below 2^31. */
#include <stdint.h>

#define LAW_SAMPLE_PERIOD_S 0.001
#define LAW_RATE_HZ 1000
#define LAW_RESOLUTION 2.24e-05
#define LAW_COUNTS_MIN (-32767)
#define LAW_COUNTS_MAX 32767
#define LAW_FORCE_PER_UNIT 9.5367431640625e-07
#define LAW_FORCE_LIMIT 16.5

#define LAW_NOW 8221   /* (K + B/T) Δ: 300 N/m, 0.05 N s/m */
#define LAW_BEFORE 1174 /* B Δ/T */

typedef int32_t law_force;

typedef struct {
    int16_t counts;
} law_state;

static inline int16_t law_nearest(int32_t counts) {
    return counts > 32767 ? 32767 : counts < -32767 ? -32767 : (int16_t)counts;
}

static inline void law_init(law_state *s, int32_t counts) { s->counts = law_nearest(counts); }

static inline law_force law_step(law_state *s, int32_t counts) {
    int16_t now = law_nearest(counts), before = s->counts;
    int32_t f;
    s->counts = now;
    if (now <= 0)
        return 0;
    f = (int32_t)LAW_NOW * now - (int32_t)LAW_BEFORE * before;
    if (f > 17301504)
        return 17301504;
    if (f < -17301504)
        return -17301504;
    return f;
}

static inline void law_reset(law_state *s) { (void)s; }
