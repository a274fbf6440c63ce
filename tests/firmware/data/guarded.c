/* The guard around the law of the tests, for ctypes: forces as doubles in units of the law. */
#include "guard.h"

static guard g;

void begin(void) { guard_init(&g); }
double step(int32_t counts) { return (double)guard_step(&g, counts); }
void end(int reason) { guard_end(&g, (uint8_t)reason); }
int phase(void) { return g.phase; }
int reason(void) { return g.reason; }
int status(void) { return guard_status(&g); }
int cut(void) { return (int)g.cut; }
int jump(void) { return (int)GUARD_JUMP; }
double law(int32_t from, int32_t counts) {
  law_state s;
  law_init(&s, from);
  return (double)law_step(&s, counts);
}
