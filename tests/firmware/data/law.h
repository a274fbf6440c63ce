/* A damped wall as the emitter prints laws, written by hand: f = K x + B (x - x before)/T inside, never a pull. */
#ifndef LAW_H
#define LAW_H
#include <stdint.h>

#define LAW_SAMPLE_PERIOD_S 0.001
#define LAW_RATE_HZ 1000
#ifndef LAW_RESOLUTION
#define LAW_RESOLUTION 2.24e-05
#endif
#define LAW_COUNTS_MIN (-32767)
#define LAW_COUNTS_MAX 32767
#define LAW_FORCE_LIMIT 5.0
#ifndef LAW_ROTARY
#define LAW_ROTARY 0
#define LAW_DELAY_S 0.0
#endif
#define LAW_CERTIFICATE_SHA256 "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"

#ifndef LAW_KIND /* 1 double, 2 float, 3 whole units of a 4096th of a newton, 4 steps of a converter */
#define LAW_KIND 1
#endif

#if LAW_KIND == 1
typedef double law_force;
#define LAW_FORCE_PER_UNIT 1.0
#ifndef LAW_STIFFNESS
#define LAW_STIFFNESS 0.00672
#endif
#define LAW_DAMPING 0.0448
#elif LAW_KIND == 2
typedef float law_force;
#define LAW_FORCE_PER_UNIT 1.0
#define LAW_STIFFNESS 0.00672f
#define LAW_DAMPING 0.0448f
#elif LAW_KIND == 3
typedef int32_t law_force;
#define LAW_FORCE_PER_UNIT 0.000244140625
#define LAW_STIFFNESS 28
#define LAW_DAMPING 184
#else
typedef int32_t law_force;
#define LAW_FORCE_PER_UNIT 0.01
#define LAW_STIFFNESS 1
#define LAW_DAMPING 4
#endif

typedef struct {
  int32_t before;
} law_state;

static void law_init(law_state *s, int32_t counts) { s->before = counts; }

static law_force law_step(law_state *s, int32_t counts) {
  int32_t x = counts < LAW_COUNTS_MIN ? LAW_COUNTS_MIN : counts > LAW_COUNTS_MAX ? LAW_COUNTS_MAX : counts;
  law_force f = LAW_STIFFNESS * (law_force)x + LAW_DAMPING * (law_force)(x - s->before);
  s->before = x;
#ifdef LAW_NEVER_GATED
  return f;
#else
  return x > 0 && f > 0 ? f : 0;
#endif
}

static void law_reset(law_state *s) { law_init(s, s->before); }

#endif
