// The board, moved by the test.
#include "Arduino.h"

#include "guard.h"

Converter ADCSRA;
uint8_t MCUSR, DDRD, DDRB, PORTD, PORTB, TIMSK0, TCCR0A, TCCR0B, OCR0B, UCSR0A, UCSR0B, UCSR0C, ADMUX;
uint8_t TCCR1A, TCCR1B, TIFR1, TIMSK1;
uint16_t ADC, UBRR0, OCR1A, OCR1B, TCNT1;
int UDR0;

static int watchdog;

void cli() {}
void sei() {}
void wdt_enable(int) { watchdog = 1; }
void wdt_disable() { watchdog = 0; }
void wdt_reset() {}

extern guard guarded;
extern uint32_t mark;

extern "C" {
void board_begin() {
  setup();
  TIFR1 = 0;
}
void board_mark() { mark = 0x5E41A66D; }
int board_marked() { return mark != 0; }
void board_sense(int reading) { ADC = (uint16_t)reading; }
void board_sample(int late) {
  TIFR1 = late ? 1 << OCF1A : 0;
  timer_fires();
}
int board_width() { return TCCR0A & (1 << COM0B1) ? OCR0B : 0; }
int board_level() { return PORTB >> PB0 & 1; }
int board_phase() { return guarded.phase; }
int board_reason() { return guarded.reason; }
int board_counts() { return guarded.counts; }
int board_period() { return OCR1A; }
int board_baud_divisor() { return UBRR0; }
int board_watchdog() { return watchdog; }
int board_idle() {
  UDR0 = -1;
  UCSR0A = 1 << UDRE0;
  loop();
  return UDR0;
}
}
