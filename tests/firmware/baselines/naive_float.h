/* The wall as one first writes it, in floats: K x + B v inside, v = (x − x before)/T. */
#include <stdint.h>

#define LAW_SAMPLE_PERIOD_S 0.001
#define LAW_RATE_HZ 1000
#define LAW_RESOLUTION 2.24e-05
#define LAW_COUNTS_MIN (-32767)
#define LAW_COUNTS_MAX 32767
#define LAW_FORCE_PER_UNIT 1.0
#define LAW_FORCE_LIMIT 16.5

typedef float law_force;

typedef struct {
    float x;
} law_state;

static inline void law_init(law_state *s, int32_t counts) { s->x = (float)counts * 2.24e-05f; }

static inline law_force law_step(law_state *s, int32_t counts) {
    float x = (float)counts * 2.24e-05f;
    float v = (x - s->x) / 0.001f;
    float f = 300.0f * x + 0.05f * v;
    s->x = x;
    if (x <= 0.0f)
        f = 0.0f;
    if (f > 16.5f)
        f = 16.5f;
    if (f < -16.5f)
        f = -16.5f;
    return f;
}

static inline void law_reset(law_state *s) { (void)s; }
