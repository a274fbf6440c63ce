/* The sender of telemetry, for ctypes. */
#include "telemetry.h"

static telemetry t;

void begin(void) { telemetry_init(&t); }
void sample(uint32_t time, int32_t counts, double force, int status) {
  telemetry_sample(&t, time, counts, (law_force)force, (uint8_t)status);
}
void close_packet(void) { telemetry_close(&t); }
void continue_from(int sequence) { t.sequence = (uint16_t)sequence; }
int next(void) { return telemetry_next(&t); }
