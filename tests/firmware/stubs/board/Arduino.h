// A board whose registers are variables.
#pragma once
#include <stdint.h>

enum { PD5 = 5, PB0 = 0, ADSC = 6, ADEN = 7, ADPS2 = 2, ADPS0 = 0, REFS0 = 6 };
enum { COM0B1 = 5, WGM01 = 1, WGM00 = 0, CS00 = 0, WGM12 = 3, CS10 = 0, CS11 = 1, OCF1A = 1, OCF1B = 2, OCIE1A = 1 };
enum { U2X0 = 1, TXEN0 = 3, UCSZ01 = 2, UCSZ00 = 1, UDRE0 = 5, WDTO_15MS = 0 };

// A conversion is over at once.
struct Converter {
  uint8_t value;
  void operator=(int bits) { value = (uint8_t)bits; }
  void operator|=(int bits) { value |= (uint8_t)(bits & ~(1 << ADSC)); }
  operator int() const { return value; }
};

extern Converter ADCSRA;
extern uint8_t MCUSR, DDRD, DDRB, PORTD, PORTB, TIMSK0, TCCR0A, TCCR0B, OCR0B, UCSR0A, UCSR0B, UCSR0C, ADMUX;
extern uint8_t TCCR1A, TCCR1B, TIFR1, TIMSK1;
extern uint16_t ADC, UBRR0, OCR1A, OCR1B, TCNT1;
extern int UDR0;

#define TIMER1_COMPA_vect timer_fires
#define ISR(vector) extern "C" void vector()
extern "C" void timer_fires();

void cli();
void sei();
void wdt_enable(int);
void wdt_disable();
void wdt_reset();
void setup();
void loop();
