/* A device as main.c uses it: five functions, in mass.c for a simulated one. */
#ifndef ZWIDTH_DEVICE_H
#define ZWIDTH_DEVICE_H

#include <stdint.h>

#include "law.h"

/* Make it ready, at force 0; 0 where that succeeded.  `where` is a port, an address, or NULL. */
int device_open(const char *where);

/* The position now [counts]; GUARD_NO_READING where there is none.  It must not wait for longer than a period. */
int32_t device_counts(void);

/* The force of the law from now on: where it is positive the motor pushes the handle out of the wall. */
void device_force(law_force force);

/* Force 0 at once; may be called from another thread, while one of the functions above hangs. */
void device_stop(void);

/* Force 0, and nothing more is asked. */
void device_close(void);

#endif
