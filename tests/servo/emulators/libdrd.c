/* Force Dimension's library, as far as it is called here: a device that is moved by the test. */
#include <math.h>
#include <stdbool.h>

static double path[1 << 15][3], forces[1 << 15][3];
static int steps, asked, given, opened = -1, watchdog = -1, guard = -1, fault, at, enablings;
static bool expert, enabled, simulator, has_watchdog = true, present = true;

enum { NONE, CLOSED, GARBAGE, LATE, FORCE_REFUSED };

void fd_begin(int with_device, int with_watchdog) {
  steps = asked = given = enablings = fault = at = 0;
  opened = watchdog = guard = -1;
  expert = enabled = simulator = false;
  has_watchdog = with_watchdog;
  present = with_device;
}
void fd_move(int step, double x, double y, double z) {
  path[step][0] = x, path[step][1] = y, path[step][2] = z;
  if (step >= steps) steps = step + 1;
}
void fd_fail(int what, int from) { fault = what, at = from; }
int fd_given(void) { return given; }
int fd_asked(void) { return asked; }
double fd_force(int k, int axis) { return forces[k][axis]; }
int fd_state(int what) {
  const int state[] = {opened, watchdog, guard, enabled, simulator, enablings};
  return state[what];
}

static int now(int what) { return fault == what && asked >= at; }

void dhdGetSDKVersion(int *a, int *b, int *c, int *d) { *a = 3, *b = 16, *c = 0, *d = 0; }
void dhdEnableSimulator(bool on) { simulator = on; }
int dhdOpen(void) { return opened = present ? 0 : -1; }
int dhdOpenID(signed char index) { return opened = present ? index : -1; }
int dhdClose(signed char id) { (void)id; opened = -1; return 0; }
const char *dhdErrorGetLastStr(void) { return present ? "no error" : "no device found"; }
int dhdErrorGetLast(void) { return 0; }
const char *dhdGetSystemName(signed char id) { (void)id; return "omega.3"; }
int dhdEnableExpertMode(void) { expert = true; return 0; }
int dhdDisableExpertMode(void) { expert = false; return 0; }
int dhdSetTimeGuard(int period, signed char id) { (void)id; if (!expert) return -1; guard = period; return 0; }
int dhdSetWatchdog(unsigned char duration, signed char id) {
  (void)id;
  if (!expert || !has_watchdog) return -1;
  watchdog = duration;
  return 0;
}
int dhdEnableForce(bool on, signed char id) { (void)id; enabled = on; enablings += on; return 0; }
int dhdGetPosition(double *x, double *y, double *z, signed char id) {
  if (id != opened || now(CLOSED)) return -1;
  int late = now(LATE);
  int step = asked < steps ? asked : steps - 1;
  asked++;
  *x = path[step][0], *y = path[step][1], *z = path[step][2];
  if (fault == GARBAGE && asked > at) *z = NAN;
  return late;
}
int dhdSetForce(double x, double y, double z, signed char id) {
  if (id != opened || now(CLOSED) || now(FORCE_REFUSED)) return -1;
  if (given < 1 << 15) forces[given][0] = x, forces[given][1] = y, forces[given][2] = z, given++;
  return fabs(x) + fabs(y) + fabs(z) > 10 ? 2 : 0;
}
