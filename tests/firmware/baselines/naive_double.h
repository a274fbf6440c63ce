/* The wall as one first writes it, in doubles: K x + B v inside, v = (x − x before)/T. */
#include <stdint.h>

#define LAW_SAMPLE_PERIOD_S 0.001
#define LAW_RATE_HZ 1000
#define LAW_RESOLUTION 2.24e-05
#define LAW_COUNTS_MIN (-32767)
#define LAW_COUNTS_MAX 32767
#define LAW_FORCE_PER_UNIT 1.0
#define LAW_FORCE_LIMIT 16.5

typedef double law_force;

typedef struct {
    double x;
} law_state;

static inline void law_init(law_state *s, int32_t counts) { s->x = (double)counts * 2.24e-05; }

static inline law_force law_step(law_state *s, int32_t counts) {
    double x = (double)counts * 2.24e-05;
    double v = (x - s->x) / 0.001;
    double f = 300.0 * x + 0.05 * v;
    s->x = x;
    if (x <= 0.0)
        f = 0.0;
    if (f > 16.5)
        f = 16.5;
    if (f < -16.5)
        f = -16.5;
    return f;
}

static inline void law_reset(law_state *s) { (void)s; }
