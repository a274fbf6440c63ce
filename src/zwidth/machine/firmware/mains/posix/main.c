/* A law on a computer with POSIX clocks: sample k at t_0 + k T, whatever the samples before it took.
 *
 *     main [-d DEVICE] [-t TELEMETRY] [-n SAMPLES] [-p PRIORITY]
 *
 * The memory is locked and the priority is real-time where the system admits it; where not, it is said.  A
 * deadline that was missed is left out and counted.  The force ends for good as guard.h says, where no sample
 * was taken for LONGEST_GAP, and at SIGINT and SIGTERM.  A second thread ends it where the loop hangs.
 *
 * Exit status: 0 where it was asked to end or all samples were taken, 1 where the force ended by itself,
 * 2 where it could not begin, 3 where the loop hung.
 */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "law.h"

#define TELEMETRY_RING 65536
#include "guard.h"
#include "telemetry.h"

#include "device.h"

#ifndef LONGEST_GAP
#define LONGEST_GAP 50000000 /* [ns] between two samples */
#endif
#ifndef TIMEOUT
#define TIMEOUT 100000000 /* [ns] without a sample, after which the second thread ends the force */
#endif

enum { SECOND = 1000000000, PERIOD = (int64_t)(1e9 * LAW_SAMPLE_PERIOD_S + 0.5), CHUNK = 512, STACK = 262144 };

static volatile sig_atomic_t asked;
static volatile sig_atomic_t beats; /* samples that were begun, as far as this type counts */
static volatile sig_atomic_t over;

static guard guarded;
static telemetry told;

static void ask(int signal) {
  (void)signal;
  asked = 1;
}

static int64_t now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * SECOND + t.tv_nsec;
}

static void sleep_until(int64_t due) {
  const struct timespec t = {(time_t)(due / SECOND), (long)(due % SECOND)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR && !asked) {
  }
}

/* The second thread: the force ends where no sample was begun for a while. */
static void *watch(void *nothing) {
  sig_atomic_t seen = beats - 1;
  (void)nothing;
  while (!over) {
    const sig_atomic_t found = beats;
    if (found == seen) {
      static const char text[] = "the loop hung: force 0\n";
      device_stop();
      if (write(STDERR_FILENO, text, sizeof text - 1) >= 0) {
        fsync(STDERR_FILENO);
      }
      _exit(3);
    }
    seen = found;
    sleep_until(now() + TIMEOUT);
  }
  return NULL;
}

/* Lock the memory and ask for a priority; what is refused is said. */
static void become_punctual(int priority) {
  const struct sched_param wanted = {.sched_priority = priority};
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    fprintf(stderr, "the memory is not locked: pages may have to be fetched (ulimit -l, or CAP_IPC_LOCK)\n");
  }
  if (priority > 0 && pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) != 0) {
    fprintf(stderr, "no real-time priority: samples may be late (ulimit -r, or CAP_SYS_NICE)\n");
  }
}

/* Start the second thread, above the loop where that has a priority: it must run where the loop never sleeps. */
static int start_watch(pthread_t *watcher, int priority) {
  pthread_attr_t small; /* the usual stack of 8 MiB would have to be locked whole: more than a user may (ulimit -l) */
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, STACK);
  const int refused = pthread_create(watcher, &small, watch, NULL);
  pthread_attr_destroy(&small);
  if (refused != 0) {
    return -1;
  }
  if (priority > 0) {
    const struct sched_param above = {.sched_priority = priority + 1};
    pthread_setschedparam(*watcher, SCHED_FIFO, &above); /* refused where the loop was refused as well */
  }
  return 0;
}

/* What is ready goes out while there is time; a line that takes nothing is not waited for. */
static void send_ready(int out) {
  static uint8_t waiting[CHUNK];
  static size_t held;
  int byte;
  while (held < CHUNK && (byte = telemetry_next(&told)) >= 0) {
    waiting[held++] = (uint8_t)byte;
  }
  if (out >= 0 && held > 0) {
    const ssize_t sent = write(out, waiting, held);
    if (sent > 0) {
      held -= (size_t)sent;
      for (size_t i = 0; i < held; i++) {
        waiting[i] = waiting[i + (size_t)sent];
      }
    }
  }
}

static int run(int out, int64_t samples) {
  int64_t taken = 0, missed = 0, late = 0, most = 0;
  const int64_t start = now();
  int64_t due = start, before = start;
  while (!asked && guarded.phase != GUARD_ENDED && (samples == 0 || taken < samples)) {
    due += PERIOD;
    sleep_until(due);
    const int64_t at = now();
    const int64_t over_due = at - due;
    if (at - before > LONGEST_GAP) {
      guard_end(&guarded, GUARD_LATE);
    }
    before = at;
    beats++;
    const int32_t counts = device_counts();
    const law_force force = guard_step(&guarded, counts);
    device_force(force);
    telemetry_sample(&told, (uint32_t)((at - start) / 1000), guarded.counts, force, guard_status(&guarded));
    send_ready(out);
    taken++;
    most = over_due > most ? over_due : most;
    late += over_due > PERIOD / 2;
    const int64_t skipped = (now() - due) / PERIOD;
    missed += skipped;
    due += skipped * PERIOD;
  }
  if (asked) {
    guard_end(&guarded, GUARD_ASKED);
  }
  telemetry_close(&told);
  for (int i = 0; i <= TELEMETRY_RING / CHUNK; i++) {
    send_ready(out);
  }
  fprintf(stderr,
          "%" PRId64 " samples, %" PRId64 " later than half a period, the latest by %" PRId64 " us, %" PRId64
          " deadlines missed, %" PRIu32 " forces cut, reason %d\n",
          taken, late, most / 1000, missed, guarded.cut, guarded.reason);
  return guarded.reason > GUARD_ASKED;
}

int main(int count, char **words) {
  const char *device = NULL, *file = NULL;
  int64_t samples = 0;
  int option, priority = 80, out = -1;
  while ((option = getopt(count, words, "d:t:n:p:")) != -1) {
    switch (option) {
      case 'd': device = optarg; break;
      case 't': file = optarg; break;
      case 'n': samples = strtoll(optarg, NULL, 10); break;
      case 'p': priority = atoi(optarg); break;
      default: return 2;
    }
  }
  if (file != NULL && (out = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_NOCTTY, 0666)) < 0) {
    perror(file);
    return 2;
  }
  const struct sigaction asking = {.sa_handler = ask};
  sigaction(SIGINT, &asking, NULL);
  sigaction(SIGTERM, &asking, NULL);
  signal(SIGPIPE, SIG_IGN);
  if (device_open(device) != 0) {
    fprintf(stderr, "the device cannot be used\n");
    return 2;
  }
  if (atexit(device_close) != 0) { /* however the program ends by itself */
    device_close();
    return 2;
  }
  guard_init(&guarded);
  telemetry_init(&told);
  become_punctual(priority);
  pthread_t watcher;
  if (start_watch(&watcher, priority) != 0) {
    fprintf(stderr, "the second thread does not start\n");
    return 2;
  }
  const int status = run(out, samples);
  device_close();
  over = 1;
  return status;
}
