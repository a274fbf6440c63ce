// What the sketch asks of a board, in the place of Arduino's own header: the test is the board.
#pragma once
#include <stddef.h>
#include <stdint.h>

#define HIGH 1
#define LOW 0
#define OUTPUT 1
const uint8_t A2 = 16;

extern uint16_t TCNT1;
extern uint8_t TCCR0B, TIMSK0, TCCR1A, TCCR1B, ADCSRA;

void pinMode(uint8_t pin, uint8_t mode);
void digitalWrite(uint8_t pin, uint8_t level);
void analogWrite(uint8_t pin, int value);
int analogRead(uint8_t pin);

struct Line {
  long baud;
  uint8_t in[256], out[256];
  int first, last, filled;
  void begin(long rate) { baud = rate; }
  int available() { return last - first; }
  int read() { return first < last ? in[first++] : -1; }
  size_t write(const uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count && filled < 256; i++) out[filled++] = bytes[i];
    return count;
  }
};
extern Line Serial;
