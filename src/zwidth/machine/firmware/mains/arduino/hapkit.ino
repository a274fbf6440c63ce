// A law on a Hapkit's own board, without a computer: sensor, law and motor in one interrupt.
//
// For an ATmega328P at 16 MHz: motor on pins 5 (pulse width) and 8 (direction), magneto-resistive sensor on A2.
// The position is in counts of the sensor, 0 where the handle stands when the board is switched on.  Telemetry
// goes out over the serial line, see telemetry.h; nothing is listened to.
//
// The force begins and ends as guard.h says.  The watchdog of the chip starts the board anew where no sample was
// finished for 16 ms; the force is then 0 until the reset button is pressed.

#include <Arduino.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <stdint.h>

#include "law.h"

#include "guard.h"
#include "telemetry.h"

// ---- what may differ from one Hapkit to the next --------------------------------------------------------

#define SENSE 1                      // -1 where the counts of the sensor fall while the handle goes into the wall
#define FORWARD 1                    // of the direction pin, where the motor drives towards greater counts
#define SPAN 980                     // counts of the sensor from one jump of its sawtooth to the next
#define SECTOR_RADIUS 0.075          // [m], at the cable
#define HANDLE_RADIUS 0.070          // [m], from the axis of the sector to the hand
#define PULLEY_RADIUS 0.004191       // [m], of the motor
#define TORQUE 0.03                  // [N*m] of the motor, standing still, at full pulse width
#define BAUD 115200L

// ---- what is the same for all ---------------------------------------------------------------------------

#define PWM_BIT PD5        // pin 5, on timer 0
#define DIRECTION_BIT PB0  // pin 8
#define SENSOR_INPUT 2     // A2
#define LEAP 64            // counts that the handle cannot go between two readings of the sensor

// The force at the handle at full pulse width.
#define FULL_FORCE (TORQUE * SECTOR_RADIUS / (HANDLE_RADIUS * PULLEY_RADIUS))

static_assert(!LAW_ROTARY, "the position of this sketch is a length at the handle");
#ifdef LAW_FORCE_LIMIT
static_assert(LAW_FORCE_LIMIT <= FULL_FORCE, "the law may ask for more than this motor has");
#endif

// The period in ticks of timer 1, by the least division of the clock with which it fits.
constexpr double CLOCKS = F_CPU * LAW_SAMPLE_PERIOD_S;
constexpr int DIVISION = CLOCKS <= 65536.0 ? 1 : CLOCKS <= 8 * 65536.0 ? 8 : 64;
constexpr uint32_t TICKS = (uint32_t)(CLOCKS / DIVISION + 0.5);
constexpr double PERIOD_ERROR = TICKS * (double)DIVISION / CLOCKS - 1.0;
static_assert(TICKS >= 1 && TICKS <= 65536, "timer 1 cannot count this period");

// From the tick to the force; 0 where the law was proved for none, and then it is not looked at.
#ifdef LAW_DELAY_S
static_assert(LAW_DELAY_S < LAW_SAMPLE_PERIOD_S, "this sketch gives the force within the period: emit for such a delay");
constexpr uint16_t DELAY_TICKS = (uint16_t)(LAW_DELAY_S * F_CPU / DIVISION);
#else
constexpr uint16_t DELAY_TICKS = 0;
#endif
static_assert(PERIOD_ERROR < 1e-4 && PERIOD_ERROR > -1e-4, "timer 1 misses the period by more than 1 in 10 000");
static_assert(LAW_SAMPLE_PERIOD_S <= 0.0075, "the watchdog of 16 ms needs two samples in its time");

// Bits per second: eight clocks a sample of a bit.
constexpr uint16_t BAUD_DIVISOR = (F_CPU / 8 + BAUD / 2) / BAUD - 1;
constexpr double BAUD_ERROR = F_CPU / (8.0 * (BAUD_DIVISOR + 1) * BAUD) - 1.0;
static_assert(BAUD_ERROR < 0.025 && BAUD_ERROR > -0.025, "the clock does not meet this rate within 2.5 %");

// A law in floats is turned into whole units of a 65536th of a newton first.
constexpr bool WHOLE = (law_force)0.5 == 0;
constexpr double UNITS_PER_NEWTON = WHOLE ? 1.0 / LAW_FORCE_PER_UNIT : 65536.0;
constexpr uint32_t FULL_UNITS = (uint32_t)(FULL_FORCE * UNITS_PER_NEWTON);
constexpr uint64_t SQUARE_PER_UNIT = (uint64_t)(255.0 * 255.0 * 4294967296.0 / (FULL_FORCE * UNITS_PER_NEWTON));
static_assert(FULL_FORCE * UNITS_PER_NEWTON < 2147483648.0, "units of the force are too small for 32 bits");

const uint32_t SERVING = 0x5E41A66D;  // in `mark` while a force may act
uint32_t mark __attribute__((section(".noinit")));  // outlives a start by the watchdog

guard guarded;
telemetry told;
uint32_t now;        // [us] since the start, by the samples
uint16_t now_rest;   // [ns]
int last_reading;
int32_t sensor_counts;
bool leapt;

int read_sensor() {
  ADCSRA |= 1 << ADSC;
  while (ADCSRA & (1 << ADSC)) {
  }
  return ADC;
}

// The sensor's reading jumps by SPAN where a pole of the magnet passes: counts go on.  A reading within a jump
// is none; the next one decides.
int32_t position_counts() {
  int reading = read_sensor();
  int change = reading - last_reading;
  if (change > SPAN / 2) {
    change -= SPAN;
  } else if (change < -SPAN / 2) {
    change += SPAN;
  }
  leapt = !leapt && (change > LEAP || change < -LEAP);
  if (leapt) {
    return GUARD_NO_READING;
  }
  last_reading = reading;
  sensor_counts += change;
  return SENSE * sensor_counts;
}

// The whole number nearest to the root of a number below 65281.
uint8_t root(uint16_t square) {
  uint16_t found = 0;
  for (uint16_t bit = 128; bit != 0; bit >>= 1) {
    uint16_t larger = found + bit;
    if ((uint32_t)larger * larger <= square) {
      found = larger;
    }
  }
  return square - found * found > found && found < 255 ? found + 1 : found;
}

// The motor's torque goes with the square of the pulse width, as the Hapkit's course has measured it.
uint8_t pulse_width(law_force force) {
  law_force size = force < 0 ? -force : force;
  uint32_t units = WHOLE ? (uint32_t)size : (uint32_t)(size * (law_force)(LAW_FORCE_PER_UNIT * UNITS_PER_NEWTON));
  if (units >= FULL_UNITS) {
    return 255;
  }
  return root((uint16_t)((units * SQUARE_PER_UNIT) >> 32));
}

// Positive out of the wall: towards smaller counts.
void apply_force(law_force force) {
  uint8_t width = pulse_width(force);
  bool towards_greater = (force < 0) == (SENSE > 0);
  if (width == 0) {
    TCCR0A &= ~(1 << COM0B1);  // at width 0 the timer would still give a pulse of one clock
    PORTD &= ~(1 << PWM_BIT);
    return;
  }
  if (towards_greater == (FORWARD != 0)) {
    PORTB |= 1 << DIRECTION_BIT;
  } else {
    PORTB &= ~(1 << DIRECTION_BIT);
  }
  OCR0B = width;
  TCCR0A |= 1 << COM0B1;
}

void count_time() {
  constexpr uint32_t PERIOD_NS = (uint32_t)(1e9 * LAW_SAMPLE_PERIOD_S + 0.5);
  now += PERIOD_NS / 1000;
  now_rest += PERIOD_NS % 1000;
  if (now_rest >= 1000) {
    now_rest -= 1000;
    now++;
  }
}

ISR(TIMER1_COMPA_vect) {
  if (guarded.phase == GUARD_SERVING && (TIFR1 & (1 << OCF1B))) {  // see below; a period or more may be missed
    guard_end(&guarded, GUARD_LATE);
  }
  law_force force = guard_step(&guarded, position_counts());
  apply_force(force);
  if (DELAY_TICKS > 0 && TCNT1 > DELAY_TICKS) {  // later than the proof counts
    guard_end(&guarded, GUARD_LATE);
    apply_force(0);
  }
  mark = guarded.phase == GUARD_SERVING ? SERVING : 0;
  telemetry_sample(&told, now, guarded.counts, force, guard_status(&guarded));
  count_time();
  if (TIFR1 & (1 << OCF1A)) {  // the next one is due already: no loop of this period any more
    guard_end(&guarded, GUARD_LATE);
    apply_force(0);
  }
  OCR1B = (uint16_t)(TCNT1 - 1);  // its flag comes a turn later: by then the next sample must have begun
  TIFR1 = 1 << OCF1B;
  wdt_reset();
}

void setup() {
  cli();
  MCUSR = 0;
  wdt_disable();
  DDRD |= 1 << PWM_BIT;
  DDRB |= 1 << DIRECTION_BIT;
  guard_init(&guarded);
  telemetry_init(&told);
  if (mark == SERVING) {
    guard_end(&guarded, GUARD_WATCHDOG);  // the next start begins anew
  }
  mark = 0;

  TIMSK0 = 0;                             // the core's clock of 1 ms would come in between
  TCCR0A = (1 << WGM01) | (1 << WGM00);   // pulses at 62.5 kHz: not heard
  TCCR0B = 1 << CS00;

  UCSR0A = 1 << U2X0;
  UBRR0 = BAUD_DIVISOR;
  UCSR0B = 1 << TXEN0;
  UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);

  ADMUX = (1 << REFS0) | SENSOR_INPUT;
  ADCSRA = (1 << ADEN) | (1 << ADPS2) | (1 << ADPS0);  // a reading of the sensor in 26 us
  read_sensor();                                       // the first one after switching on is not good
  last_reading = read_sensor();

  TCCR1A = 0;
  TCCR1B = (1 << WGM12) | (DIVISION == 1 ? 1 << CS10 : DIVISION == 8 ? 1 << CS11 : (1 << CS11) | (1 << CS10));
  OCR1A = (uint16_t)(TICKS - 1);
  TCNT1 = 0;
  TIFR1 = 1 << OCF1A;
  TIMSK1 = 1 << OCIE1A;
  wdt_enable(WDTO_15MS);
  sei();
}

void loop() {
  if (UCSR0A & (1 << UDRE0)) {
    int byte = telemetry_next(&told);
    if (byte >= 0) {
      UDR0 = (uint8_t)byte;
    }
  }
}
