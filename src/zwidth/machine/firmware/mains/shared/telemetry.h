/* What a law read and gave, sample by sample, over a serial line: at most 5.2 bytes a sample in full packets.
 *
 *   'z' 'W'   kind   n   sequence, uint16   n bytes   CRC-16          numbers little-endian
 *
 *   kind 1    n bytes of text, see TELEMETRY_ABOUT; one byte of flags before it; the sequence is 0
 *   kind 2    time of the first sample, uint32 [us]    position of the first sample, int32 [counts]
 *             status, uint8    samples dropped so far, uint16
 *             then for each sample, a period after the one before:
 *             position less that of the first, int16 [counts]    force, int16 [units of the text]
 *
 * The checksum is the CRC-16 of ITU-T V.41 (polynomial 0x1021, begun with ones) of all bytes before it.  The
 * status is that of the guard; bit 6 says that a force of the packet was cut, bit 7 that it is the first packet
 * since the machine was started.  A packet that finds no room is dropped, and its samples are counted.
 *
 * telemetry_sample is called by the sample, an interrupt or a loop; telemetry_next by whoever has time between
 * samples, on the same core.  Neither waits.  No heap.
 */
#ifndef ZWIDTH_TELEMETRY_H
#define ZWIDTH_TELEMETRY_H

#include <stdint.h>

#include "law.h"

/* Largest force that can be sent [N; N*m]; a larger one is sent as this. */
#ifndef TELEMETRY_FORCE_MOST
#ifdef LAW_FORCE_LIMIT
#define TELEMETRY_FORCE_MOST LAW_FORCE_LIMIT
#else
#define TELEMETRY_FORCE_MOST 32.767
#endif
#endif

/* Bytes of the ring, a power of two; up to 256 its indices are bytes, which an 8-bit machine reads at once. */
#ifndef TELEMETRY_RING
#define TELEMETRY_RING 256
#endif
#if TELEMETRY_RING & (TELEMETRY_RING - 1) || TELEMETRY_RING < 128
#error "TELEMETRY_RING must be a power of two, 128 or more"
#endif
#if TELEMETRY_RING <= 256
typedef uint8_t telemetry_index;
#else
typedef uint32_t telemetry_index;
#endif

/* Where the text lies: in the program memory, where that is another than the data's. */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define TELEMETRY_STORED PROGMEM
#define TELEMETRY_BYTE(text, i) pgm_read_byte(&(text)[i])
#else
#define TELEMETRY_STORED
#define TELEMETRY_BYTE(text, i) ((text)[i])
#endif

#define TELEMETRY_SPELLED(number) #number
#define TELEMETRY_TEXT(number) TELEMETRY_SPELLED(number)

/* Every number as law.h has it, to the last digit: nothing is printed at run time. */
#define TELEMETRY_ABOUT                                        \
  "zwidth telemetry 1\n"                                       \
  "period_s " TELEMETRY_TEXT(LAW_SAMPLE_PERIOD_S) "\n"         \
  "resolution " TELEMETRY_TEXT(LAW_RESOLUTION) "\n"            \
  "force_per_unit " TELEMETRY_TEXT(LAW_FORCE_PER_UNIT) "\n"    \
  "force_most " TELEMETRY_TEXT(TELEMETRY_FORCE_MOST) "\n"      \
  "certificate " LAW_CERTIFICATE_SHA256 "\n"

static const char telemetry_about[] TELEMETRY_STORED = TELEMETRY_ABOUT;
#define TELEMETRY_ABOUT_SIZE (sizeof telemetry_about - 1)

enum { telemetry_check_text_fits = 1 / (int)(sizeof TELEMETRY_ABOUT <= 255) };

enum {
  TELEMETRY_SAMPLES = 16, /* in a packet at most */
  TELEMETRY_HEAD = 6,
  TELEMETRY_FIXED = 11,
  TELEMETRY_LARGEST = 3 + TELEMETRY_FIXED + 4 * TELEMETRY_SAMPLES, /* in the ring: n, sequence, payload */
  TELEMETRY_EVERY = 64 /* packets of samples from one text to the next */
};

#define TELEMETRY_ROTARY 1 /* flags of the text: positions are in rad */
#define TELEMETRY_EXACT 2  /* forces are sent as the whole units of the law */

#define TELEMETRY_CUT 0x40   /* of the status: of any sample in the packet */
#define TELEMETRY_FIRST 0x80

typedef struct {
  /* of the samples */
  volatile uint8_t ring[TELEMETRY_RING];
  volatile telemetry_index head; /* where the next packet begins */
  uint32_t time, due;            /* of the first sample of the packet, and of the next one [us] */
  int32_t first;                 /* its position */
  uint16_t sequence, dropped;
  uint8_t samples, status, room, started;
  /* of whoever sends */
  volatile telemetry_index tail;
  uint16_t crc;
  uint16_t at, size; /* the byte of a packet that is sent next, and how many it has; 0: none */
  uint8_t kind, until_text;
} telemetry;

/* Whether forces are sent as the units of the law: they are whole, and none is too large for 16 bits. */
#define TELEMETRY_IS_EXACT ((law_force)0.5 == 0 && TELEMETRY_FORCE_MOST / LAW_FORCE_PER_UNIT <= 32767.0)

static inline int16_t telemetry_force(law_force f) {
  if ((law_force)0.5 == 0) { /* whole units: times a fraction of 2^32, to the nearest */
    const double scale = TELEMETRY_IS_EXACT ? 1.0 : 32767.0 * LAW_FORCE_PER_UNIT / TELEMETRY_FORCE_MOST;
    const int64_t most = (int64_t)(TELEMETRY_FORCE_MOST / LAW_FORCE_PER_UNIT);
    int64_t whole = (int64_t)f;
    whole = whole > most ? most : whole < -most ? -most : whole;
    return (int16_t)((whole * (int64_t)(scale * 4294967296.0) + 2147483648LL) >> 32);
  } else {
    const law_force share = f * (law_force)(32767.0 * LAW_FORCE_PER_UNIT / TELEMETRY_FORCE_MOST);
    if (!(share > -32767)) {
      return -32767;
    }
    return (int16_t)(share >= 32767 ? 32767 : (int32_t)(share + (share < 0 ? (law_force)-0.5 : (law_force)0.5)));
  }
}

static inline void telemetry_init(telemetry *t) {
  t->head = t->tail = 0;
  t->sequence = t->dropped = 0;
  t->samples = t->started = 0;
  t->time = t->due = 0;
  t->size = t->at = 0;
  t->until_text = 0;
}

static inline void telemetry_put(telemetry *t, uint8_t at, uint32_t value, uint8_t bytes) {
  for (; bytes > 0; bytes--, at++, value >>= 8) {
    t->ring[(telemetry_index)(t->head + at) & (TELEMETRY_RING - 1)] = (uint8_t)value;
  }
}

/* End the packet that is being filled: it may be sent from now on. */
static inline void telemetry_close(telemetry *t) {
  const uint8_t payload = (uint8_t)(TELEMETRY_FIXED + 4 * t->samples);
  if (t->samples == 0) {
    return;
  }
  if (t->room) {
    telemetry_put(t, 0, payload, 1);
    telemetry_put(t, 1, t->sequence++, 2);
    telemetry_put(t, 3, t->time, 4);
    telemetry_put(t, 7, (uint32_t)t->first, 4);
    telemetry_put(t, 11, t->status | (t->started ? 0 : TELEMETRY_FIRST), 1);
    telemetry_put(t, 12, t->dropped, 2);
    t->started = 1;
    t->head = (telemetry_index)(t->head + 3 + payload);
  } else {
    t->dropped = (uint16_t)(t->dropped + t->samples);
  }
  t->samples = 0;
}

/* One sample: when it was taken [us], what was read and given, the guard's status. */
static inline void telemetry_sample(telemetry *t, uint32_t time, int32_t counts, law_force force, uint8_t status) {
  const uint32_t period = (uint32_t)(1e6 * LAW_SAMPLE_PERIOD_S + 0.5);
  const uint32_t off = time - t->due + period / 2; /* half a period where it is as late as the one before */
  const int32_t way = (int32_t)((uint32_t)counts - (uint32_t)t->first);
  if (t->samples == TELEMETRY_SAMPLES || off >= period || way > 32767 || way < -32768 ||
      (t->status | TELEMETRY_CUT) != (status | TELEMETRY_CUT)) {
    telemetry_close(t);
  }
  if (t->samples == 0) {
    const telemetry_index held = (telemetry_index)(t->head - t->tail) & (TELEMETRY_RING - 1);
    t->room = TELEMETRY_RING - 1 - held >= TELEMETRY_LARGEST;
    t->time = time;
    t->first = counts;
    t->status = status;
  }
  if (t->room) {
    const uint8_t at = (uint8_t)(3 + TELEMETRY_FIXED + 4 * t->samples);
    telemetry_put(t, at, (uint32_t)counts - (uint32_t)t->first, 2);
    telemetry_put(t, (uint8_t)(at + 2), (uint16_t)telemetry_force(force), 2);
  }
  t->status |= status;
  t->samples++;
  t->due = time + period;
}

static inline uint8_t telemetry_text(uint16_t i) {
  const uint8_t exact = TELEMETRY_IS_EXACT ? TELEMETRY_EXACT : 0;
  return i == 0 ? (uint8_t)(exact | (LAW_ROTARY ? TELEMETRY_ROTARY : 0))
                : (uint8_t)TELEMETRY_BYTE(telemetry_about, i - 1);
}

/* Begin to send what is due: a text, or the packet that has waited longest. */
static inline int telemetry_begin(telemetry *t) {
  if (t->until_text == 0) {
    t->until_text = TELEMETRY_EVERY;
    t->kind = 1;
    t->size = (uint16_t)(TELEMETRY_HEAD + 1 + TELEMETRY_ABOUT_SIZE + 2);
  } else if (t->tail != t->head) {
    t->until_text--;
    t->kind = 2;
    t->size = (uint16_t)(TELEMETRY_HEAD + t->ring[t->tail & (TELEMETRY_RING - 1)] + 2);
  } else {
    return 0;
  }
  t->at = 0;
  t->crc = 0xFFFF;
  return 1;
}

static inline uint8_t telemetry_from_ring(telemetry *t, uint16_t i) {
  return t->ring[(telemetry_index)(t->tail + i) & (TELEMETRY_RING - 1)];
}

/* A byte of the packet, before its checksum. */
static inline uint8_t telemetry_byte(telemetry *t) {
  switch (t->at) {
    case 0: return 'z';
    case 1: return 'W';
    case 2: return t->kind;
    case 3: return (uint8_t)(t->size - TELEMETRY_HEAD - 2);
  }
  if (t->kind == 2) {
    return telemetry_from_ring(t, (uint16_t)(t->at - 3));
  }
  return t->at < TELEMETRY_HEAD ? 0 : telemetry_text((uint16_t)(t->at - TELEMETRY_HEAD));
}

static inline uint16_t telemetry_crc(uint16_t rest, uint8_t byte) {
  rest ^= (uint16_t)((uint16_t)byte << 8);
  for (uint8_t bit = 0; bit < 8; bit++) {
    rest = (uint16_t)(rest & 0x8000 ? (uint16_t)(rest << 1) ^ 0x1021 : rest << 1);
  }
  return rest;
}

/* The next byte to send; -1 where there is none. */
static inline int telemetry_next(telemetry *t) {
  uint8_t byte;
  if (t->size == 0 && !telemetry_begin(t)) {
    return -1;
  }
  if (t->at < t->size - 2) {
    byte = telemetry_byte(t);
    t->crc = telemetry_crc(t->crc, byte);
  } else {
    byte = (uint8_t)(t->at == t->size - 2 ? t->crc : t->crc >> 8);
  }
  if (++t->at == t->size) {
    if (t->kind == 2) {
      t->tail = (telemetry_index)(t->tail + t->size - TELEMETRY_HEAD - 2 + 3);
    }
    t->size = 0;
  }
  return byte;
}

#endif
