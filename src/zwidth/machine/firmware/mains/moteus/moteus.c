/* A motor on an mjbots moteus controller, in the place of mass.c: lines of an fdcanusb adapter over a serial port.
 *
 *     can send ADDRESS DATA        to the adapter, which says OK
 *     rcv ADDRESS DATA flags       from it
 *
 * Each sample asks for mode, position and fault and waits for the answer, then sends a torque, for which no
 * answer is asked: the feed-forward of the position mode with all scales of its loop 0.  The torque is good for
 * WATCHDOG ms only: where nothing more comes, the controller ends it.  Answers go to sources that change from
 * one question to the next, so that an old one is known.
 *
 * Sources: mjbots, moteus documentation, "CAN protocol" and "Register reference"; fdcanusb, README.
 */
#define _DEFAULT_SOURCE

#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "law.h"

#include "guard.h"

#include "device.h"

#define SERVO 1         /* id.id of the controller */
#define SENSE 1         /* -1 where the motor turns backwards while the handle goes into the wall */
#define WATCHDOG 20     /* [ms] */

/* So long the answer to a question is waited for [ms]; a later one is none. */
#ifndef ANSWER_MS
#define ANSWER_MS (LAW_SAMPLE_PERIOD_S > 0.002 ? (int)(500 * LAW_SAMPLE_PERIOD_S) : 1)
#endif

GUARD_CHECK(the_position_is_an_angle, LAW_ROTARY);
GUARD_CHECK(the_watchdog_has_time, WATCHDOG > 2000 * LAW_SAMPLE_PERIOD_S);

enum { STOPPED = 0, OPERATING = 10, FIRST_SOURCE = 112, SOURCES = 16 };

static int port = -1;
static unsigned asked;
static char line[256];
static size_t held;
static double turns_before, around; /* the position begins anew after 65536 turns */
static int seen;

static void send_line(unsigned address, const uint8_t *data, size_t count) {
  static const char digits[] = "0123456789abcdef";
  char text[160];
  size_t at = (size_t)snprintf(text, sizeof text, "can send %04x ", address);
  for (size_t i = 0; i < count; i++) {
    text[at++] = digits[data[i] >> 4];
    text[at++] = digits[data[i] & 15];
  }
  text[at++] = '\n';
  if (write(port, text, at) != (ssize_t)at) { /* the answer to the next question will be missing */
    tcflush(port, TCOFLUSH);
  }
}

static void send_torque(float torque) {
  uint8_t data[] = {0x01, 0x00, OPERATING, 0x02, 0x20, 0x80, 0x00, /* mode; position: none, velocity 0 */
                    0x0D, 0x22, 0, 0, 0, 0,                        /* torque */
                    0x02, 0x23, 0x00, 0x00,                        /* scales of stiffness and damping */
                    0x05, 0x27, WATCHDOG & 0xFF, WATCHDOG >> 8,    /* for so long */
                    0x01, 0x2B, 0x00};                             /* scale of the integral part */
  memcpy(data + 9, &torque, 4);                                    /* IEEE 754, the low byte first */
  send_line(SERVO, data, sizeof data);
}

static void send_stop(void) {
  const uint8_t data[] = {0x01, 0x00, STOPPED};
  send_line(SERVO, data, sizeof data);
}

/* The bytes that a word of hexadecimal digits spells. */
static size_t spelled(const char *word, uint8_t *data, size_t most) {
  size_t count = 0;
  unsigned byte;
  while (count < most && sscanf(word + 2 * count, "%2x", &byte) == 1 && word[2 * count + 1] > ' ') {
    data[count++] = (uint8_t)byte;
  }
  return count;
}

/* The position [turns] of an answer to our last question; NAN of any other line, or where it gives no torque. */
static double answered(const char *text) {
  uint8_t data[64];
  unsigned address;
  int start = 0;
  float turns;
  if (sscanf(text, "rcv %x %n", &address, &start) != 1 || start == 0 ||
      address != (unsigned)(SERVO << 8 | (FIRST_SOURCE + asked % SOURCES))) {
    return (double)NAN;
  }
  /* int8 of register 0; float of register 1; int8 of register 0x0f: as they were asked for */
  if (spelled(text + start, data, sizeof data) < 12 || data[0] != 0x21 || data[1] != 0x00 || data[3] != 0x2D ||
      data[4] != 0x01 || data[9] != 0x21 || data[10] != 0x0F || data[2] != OPERATING) {
    return (double)NAN;
  }
  memcpy(&turns, data + 5, 4);
  return (double)turns;
}

/* The next line that comes within a time [ms]; NULL where none does. */
static const char *next_line(int wait) {
  static char whole[256];
  for (;;) {
    const char *end = memchr(line, '\n', held);
    if (end != NULL) {
      const size_t size = (size_t)(end - line);
      memcpy(whole, line, size);
      whole[size] = '\0';
      held -= size + 1;
      memmove(line, end + 1, held);
      return whole;
    }
    struct pollfd ready = {port, POLLIN, 0};
    if (held == sizeof line) {
      held = 0;
    }
    if (poll(&ready, 1, wait) <= 0) {
      return NULL;
    }
    const ssize_t came = read(port, line + held, sizeof line - held);
    if (came <= 0) {
      return NULL;
    }
    held += (size_t)came;
  }
}

static int64_t milliseconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

static double ask_position(int wait) {
  const uint8_t data[] = {0x11, 0x00, 0x1D, 0x01, 0x11, 0x0F};
  const int64_t until = milliseconds() + wait;
  asked++;
  send_line(0x8000 | (FIRST_SOURCE + asked % SOURCES) << 8 | SERVO, data, sizeof data);
  for (;;) {
    const int64_t left = until - milliseconds();
    const char *text = next_line(left > 0 ? (int)left : 0);
    if (text == NULL) {
      return (double)NAN;
    }
    const double turns = answered(text);
    if (!isnan(turns)) {
      return turns;
    }
  }
}

int device_open(const char *where) {
  struct termios mode;
  port = open(where == NULL ? "/dev/fdcanusb" : where, O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (port < 0 || tcgetattr(port, &mode) != 0) {
    return -1;
  }
  cfmakeraw(&mode);
  if (tcsetattr(port, TCSANOW, &mode) != 0) {
    return -1;
  }
  send_stop(); /* its faults are forgotten */
  for (int tries = 0; tries < 50; tries++) {
    send_torque(0.0f);
    if (!isnan(ask_position(20))) {
      return 0;
    }
  }
  return -1;
}

int32_t device_counts(void) {
  double turns = ask_position(ANSWER_MS);
  if (isnan(turns)) {
    return GUARD_NO_READING;
  }
  if (seen && turns + around - turns_before > 32768.0) {
    around -= 65536.0;
  } else if (seen && turns + around - turns_before < -32768.0) {
    around += 65536.0;
  }
  turns_before = turns + around;
  seen = 1;
  const double counts = floor(SENSE * turns_before * (6.283185307179586 / LAW_RESOLUTION) + 0.5);
  return fabs(counts) < 2147483647.0 ? (int32_t)counts : GUARD_NO_READING;
}

void device_force(law_force force) { send_torque((float)(-SENSE * LAW_FORCE_PER_UNIT * (double)force)); }

void device_stop(void) {
  send_torque(0.0f);
  send_stop();
}

void device_close(void) {
  if (port >= 0) {
    device_stop();
    tcdrain(port);
    close(port);
    port = -1;
  }
}
