/* What stands between a proved law and a motor: where the force begins, and where it ends for good.
 *
 *   waiting   force 0; the law is at rest at every reading, and begins where its force there is small
 *   serving   the law's force, cut at LAW_FORCE_LIMIT and by nothing else
 *   ended     force 0, until the machine is started anew
 *
 * The force jumps once, as the law begins, by GUARD_START_FORCE at most.  Afterwards its change is not limited:
 * a force that may change only so much in a sample lags behind the law's, pushes less on the way in than on the
 * way out, and is another law than the one that was proved.  A cut at LAW_FORCE_LIMIT is another law as well;
 * such samples are counted.
 *
 * The force ends for good at a reading that no hand can have reached since the one before, where readings fail
 * to come, where the law gives no finite number, where a sample comes too late, and when somebody asks.  What
 * ended does not begin again: the hand has moved on meanwhile.
 */
#ifndef ZWIDTH_GUARD_H
#define ZWIDTH_GUARD_H

#include <stdint.h>

#include "law.h"

#ifdef __FAST_MATH__
#error "compile without -ffast-math: the law that was proved has the operations of IEEE 754, in its order"
#endif
#ifndef LAW_ROTARY
#error "law.h must say whether positions are in m or in rad: #define LAW_ROTARY 0, or 1"
#endif

/* ---- what a person may set, before this file is included or on the compiler's command line ---- */

/* Force up to which the law may begin [N; N*m]: a hundredth of the largest, 0 where none is known. */
#ifndef GUARD_START_FORCE
#ifdef LAW_FORCE_LIMIT
#define GUARD_START_FORCE (0.01 * LAW_FORCE_LIMIT)
#else
#define GUARD_START_FORCE 0.0
#endif
#endif

/* Faster than that no hand moves the device [m/s; rad/s]. */
#ifndef GUARD_SPEED
#if LAW_ROTARY
#define GUARD_SPEED 300.0
#else
#define GUARD_SPEED 10.0
#endif
#endif

/* So many samples in a row may have no reading; the force is held meanwhile. */
#ifndef GUARD_MISSING
#define GUARD_MISSING 1
#endif

/* ---- checks that cost nothing at run time ---- */

#define GUARD_CHECK(name, holds) enum { guard_check_##name = 1 / (int)((holds) ? 1 : 0) }

GUARD_CHECK(the_law_reads_counts, LAW_RESOLUTION > 0.0);
GUARD_CHECK(rate_and_period_agree, LAW_RATE_HZ * LAW_SAMPLE_PERIOD_S > 0.999999 &&
                                       LAW_RATE_HZ * LAW_SAMPLE_PERIOD_S < 1.000001);
GUARD_CHECK(a_jump_is_a_count_at_least, GUARD_SPEED * LAW_SAMPLE_PERIOD_S / LAW_RESOLUTION >= 1.0);
GUARD_CHECK(a_jump_fits, GUARD_SPEED * LAW_SAMPLE_PERIOD_S / LAW_RESOLUTION < 16777216.0);
#ifdef LAW_FORCE_LIMIT
GUARD_CHECK(the_limit_fits, LAW_FORCE_LIMIT / LAW_FORCE_PER_UNIT < 2147483647.0);
#endif

#ifdef __cplusplus
template <class number> struct guard_is_double { enum { value = 0 }; };
template <> struct guard_is_double<double> { enum { value = 1 }; };
static_assert(!guard_is_double<law_force>::value || sizeof(double) == 8,
              "double has 32 bits on this chip: emit the law in float, or in fixed point");
#endif

/* Farther than that no hand moves the device in a period [counts]. */
#define GUARD_JUMP ((uint32_t)(GUARD_SPEED * LAW_SAMPLE_PERIOD_S / LAW_RESOLUTION))

/* In the place of a reading: there was none. */
#define GUARD_NO_READING INT32_MIN

enum { GUARD_WAITING, GUARD_SERVING, GUARD_ENDED };

enum {
  GUARD_RUNNING,
  GUARD_ASKED,    /* somebody asked */
  GUARD_JUMPED,   /* a reading that no hand can have reached */
  GUARD_SILENT,   /* readings failed to come */
  GUARD_NO_FORCE, /* the law gave no finite number */
  GUARD_LATE,     /* a sample came, or took, too long */
  GUARD_WATCHDOG, /* the machine hung, and was started anew by its watchdog */
  GUARD_FAILED    /* the machine or the device failed otherwise */
};

/* In the status of a sample, see guard_status. */
#define GUARD_CUT 0x40

typedef struct {
  law_state law;
  law_force force;  /* given last */
  int32_t counts;   /* read last */
  uint32_t cut;     /* samples whose force was cut at its limit */
  uint8_t phase;
  uint8_t reason;
  uint8_t missing;  /* samples in a row without a reading */
  uint8_t seen;     /* whether there was a reading */
  uint8_t limited;  /* whether the force given last was cut */
} guard;

static inline void guard_init(guard *g) {
  law_init(&g->law, 0);
  g->force = 0;
  g->counts = 0;
  g->cut = 0;
  g->phase = GUARD_WAITING;
  g->reason = GUARD_RUNNING;
  g->missing = g->seen = g->limited = 0;
}

/* End the force for good; the first reason stays. */
static inline void guard_end(guard *g, uint8_t reason) {
  if (g->phase != GUARD_ENDED) {
    g->phase = GUARD_ENDED;
    g->reason = reason;
    law_reset(&g->law);
  }
  g->force = 0;
  g->limited = 0;
}

/* Phase in bits 0 and 1, reason in bits 2 to 5, GUARD_CUT. */
static inline uint8_t guard_status(const guard *g) {
  return (uint8_t)(g->phase | g->reason << 2 | (g->limited ? GUARD_CUT : 0));
}

static inline int guard_is_finite(law_force f) { return f - f == 0; }

static inline int guard_is_small(law_force f) {
  const law_force most = (law_force)(GUARD_START_FORCE / LAW_FORCE_PER_UNIT);
  return f >= -most && f <= most;
}

static inline int guard_may_begin(int32_t counts) {
#ifdef LAW_BEGINS_MIN
  return counts >= LAW_BEGINS_MIN && counts <= LAW_BEGINS_MAX;
#else
  (void)counts;
  return 1;
#endif
}

static inline law_force guard_cut(guard *g, law_force f) {
  g->limited = 0;
#ifdef LAW_FORCE_LIMIT
  const law_force most = (law_force)(LAW_FORCE_LIMIT / LAW_FORCE_PER_UNIT);
  if (f > most || f < -most) {
    g->limited = 1;
    g->cut++;
    return f > 0 ? most : -most;
  }
#endif
  return f;
}

static inline int guard_jumped(const guard *g, int32_t counts) {
  const uint32_t way = counts > g->counts ? (uint32_t)counts - (uint32_t)g->counts
                                          : (uint32_t)g->counts - (uint32_t)counts;
  return g->seen && way > GUARD_JUMP * (1u + g->missing);
}

/* One sample: the force to give now, as law_step has it; counts may be GUARD_NO_READING. */
static inline law_force guard_step(guard *g, int32_t counts) {
  law_force f;
  if (g->phase == GUARD_ENDED) {
    return 0;
  }
  if (counts == GUARD_NO_READING) {
    if (++g->missing > GUARD_MISSING) {
      guard_end(g, GUARD_SILENT);
    }
    return g->force;
  }
  if (guard_jumped(g, counts)) {
    guard_end(g, GUARD_JUMPED);
    return 0;
  }
  g->counts = counts;
  g->seen = 1;
  g->missing = 0;
  if (g->phase == GUARD_WAITING) {
    law_init(&g->law, counts);
  }
  f = law_step(&g->law, counts);
  if (!guard_is_finite(f)) {
    guard_end(g, GUARD_NO_FORCE);
    return 0;
  }
  if (g->phase == GUARD_WAITING) {
    if (!guard_is_small(f) || !guard_may_begin(counts)) {
      return 0;
    }
    g->phase = GUARD_SERVING;
  }
  g->force = guard_cut(g, f);
  return g->force;
}

#endif
