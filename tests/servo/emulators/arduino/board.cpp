// The board that the sketch runs on, moved by the test.
#include "Arduino.h"

uint16_t TCNT1;
uint8_t TCCR0B, TIMSK0, TCCR1A, TCCR1B, ADCSRA;
Line Serial;

static int sensor, levels[32], widths[32], modes[32];

void pinMode(uint8_t pin, uint8_t mode) { modes[pin] = mode; }
void digitalWrite(uint8_t pin, uint8_t level) { levels[pin] = level; }
void analogWrite(uint8_t pin, int value) { widths[pin] = value; }
int analogRead(uint8_t pin) { return pin == A2 ? sensor : -1; }

void setup();
void loop();

extern "C" {
void board_begin() { setup(); }
void board_turn(int ticks) { TCNT1 += ticks; loop(); }
void board_sensor(int value) { sensor = value; }
int board_level(int pin) { return levels[pin]; }
int board_width(int pin) { return widths[pin]; }
int board_is_output(int pin) { return modes[pin] == OUTPUT; }
int board_baud() { return (int)Serial.baud; }
void board_hear(uint8_t byte) {
  if (Serial.first == Serial.last) Serial.first = Serial.last = 0;
  if (Serial.last < 256) Serial.in[Serial.last++] = byte;
}
int board_tell(uint8_t *into) {
  int count = Serial.filled;
  for (int i = 0; i < count; i++) into[i] = Serial.out[i];
  Serial.filled = 0;
  return count;
}
}
