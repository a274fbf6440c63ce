/* A simulated device: a mass with viscous friction, swung through the wall by a weak spring of the hand's.
 *
 *     m dv/dt = -b v - k (x - x_0) - f       x_0 = 0, begun 10 mm outside at rest
 *
 * Semi-implicit Euler, a step a sample: it shows that the program runs, and is no proof of anything.
 */
#include "device.h"

#define MASS 0.1       /* [kg] */
#define FRICTION 0.15  /* [N*s/m] */
#define HAND 100.0     /* [N/m] */
#define BEGUN (-0.010) /* [m] */

static double position, velocity, force;

int device_open(const char *where) {
  (void)where;
  position = BEGUN;
  velocity = force = 0.0;
  return 0;
}

int32_t device_counts(void) {
  velocity += LAW_SAMPLE_PERIOD_S * (-force - FRICTION * velocity - HAND * position) / MASS;
  position += LAW_SAMPLE_PERIOD_S * velocity;
  const double counts = position / LAW_RESOLUTION;
  const int32_t whole = (int32_t)counts;
  return counts < whole ? whole - 1 : whole;
}

void device_force(law_force given) { force = LAW_FORCE_PER_UNIT * (double)given; }

void device_stop(void) { force = 0.0; }

void device_close(void) { force = 0.0; }
