// A Hapkit that is served by zwidth: it tells where its handle is, and gives the force that it is told.
//
// For a board with an ATmega328P at 16 MHz: motor on pins 5 (pulse width) and 8 (direction), magneto-resistive
// sensor on A2.  The frames, little-endian, CRC-16 of ITU-T V.41 begun with ones; kind 1 start, 2 ask, 3 force:
//
//   to the board    A5  kind  number  force, int16 [mN]          CRC-16          7 bytes
//   from the board  5A  number  state  position, int32 [counts]  CRC-16          9 bytes
//
// A force that is not 0 is cut where no right frame has come for 20 ms, and stays 0 until the host starts anew.

#include <Arduino.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// ---- what may differ from one Hapkit to the next --------------------------------------------------------

const long BAUD = 1000000;           // 16 MHz / 16: exact, and so are 500000 and 250000
const uint8_t FORWARD = HIGH;        // of the direction pin, where the motor drives towards greater counts
const int SPAN = 980;                // counts of the sensor from one jump of its sawtooth to the next
const float SECTOR_RADIUS = 0.075f;  // [m], at the cable
const float HANDLE_RADIUS = 0.070f;  // [m], from the axis of the sector to the hand
const float PULLEY_RADIUS = 0.004191f;  // [m], of the motor
const float TORQUE = 0.03f;          // [N·m] of the motor, standing still, at full pulse width

// ---- what is the same for all ---------------------------------------------------------------------------

const uint8_t PWM_PIN = 5, DIRECTION_PIN = 8, SENSOR_PIN = A2;
const uint8_t TO_BOARD = 0xA5, FROM_BOARD = 0x5A;
const uint8_t START = 1, ASK = 2, FORCE = 3;
const uint8_t CUT = 1;             // the bit of the state that tells that the force was cut
const uint16_t SILENCE = 5000;     // 20 ms in ticks of timer 1, 4 us each
const int LEAP = 64;               // counts that the handle cannot go between two readings of the sensor

uint8_t frame[7];
uint8_t held = 0;
bool cut = true;
bool pushing = false;
uint16_t heard = 0;
int last_reading = 0;
bool leapt = false;
int32_t counts = 0;

// CRC-16 with the polynomial 0x1021 and all ones to begin with, highest bit first.
uint16_t checksum(const uint8_t *bytes, uint8_t count) {
  uint16_t rest = 0xFFFF;
  for (uint8_t i = 0; i < count; i++) {
    rest ^= (uint16_t)bytes[i] << 8;
    for (uint8_t bit = 0; bit < 8; bit++) {
      rest = (rest & 0x8000) ? (uint16_t)(rest << 1) ^ 0x1021 : (uint16_t)(rest << 1);
    }
  }
  return rest;
}

// Take one byte; true where it completes a right frame.  Of a wrong one only the first byte is thrown away:
// a right one may begin within it.
bool complete(uint8_t byte) {
  frame[held++] = byte;
  for (;;) {
    while (held > 0 && frame[0] != TO_BOARD) {
      memmove(frame, frame + 1, --held);
    }
    if (held < sizeof frame) {
      return false;
    }
    uint16_t sum = (uint16_t)frame[5] | (uint16_t)frame[6] << 8;
    if (checksum(frame, 5) == sum) {
      held = 0;
      return true;
    }
    memmove(frame, frame + 1, --held);
  }
}

// The sensor's reading jumps by SPAN where a pole of the magnet passes: counts go on.  A reading within a jump
// is none; the next one decides.
void follow_sensor() {
  int reading = analogRead(SENSOR_PIN);
  int change = reading - last_reading;
  if (change > SPAN / 2) {
    change -= SPAN;
  } else if (change < -SPAN / 2) {
    change += SPAN;
  }
  leapt = !leapt && (change > LEAP || change < -LEAP);
  if (leapt) {
    return;
  }
  last_reading = reading;
  counts += change;
}

// The motor's torque goes with the square of the pulse width, as the Hapkit's course has measured it.
void give(int16_t millinewtons) {
  pushing = millinewtons != 0;
  float force = millinewtons * 0.001f;
  float torque = fabsf(force) * HANDLE_RADIUS * PULLEY_RADIUS / SECTOR_RADIUS;
  float width = sqrtf(torque / TORQUE);
  digitalWrite(DIRECTION_PIN, millinewtons > 0 ? FORWARD : !FORWARD);
  analogWrite(PWM_PIN, width < 1.0f ? (int)(255.0f * width + 0.5f) : 255);
}

void answer(uint8_t number) {
  uint8_t bytes[9] = {FROM_BOARD, number, (uint8_t)(cut ? CUT : 0)};
  for (uint8_t i = 0; i < 4; i++) {
    bytes[3 + i] = (uint8_t)((uint32_t)counts >> (8 * i));
  }
  uint16_t sum = checksum(bytes, 7);
  bytes[7] = (uint8_t)sum;
  bytes[8] = (uint8_t)(sum >> 8);
  Serial.write(bytes, sizeof bytes);
}

// A right frame: what it asks for.
void obey() {
  heard = TCNT1;
  switch (frame[1]) {
    case START:
      cut = false;
      counts = 0;
      give(0);
      answer(frame[2]);
      break;
    case ASK:
      answer(frame[2]);
      break;
    case FORCE:
      if (!cut) {
        give((int16_t)((uint16_t)frame[3] | (uint16_t)frame[4] << 8));
      }
      break;
  }
}

void setup() {
  pinMode(PWM_PIN, OUTPUT);
  pinMode(DIRECTION_PIN, OUTPUT);
  analogWrite(PWM_PIN, 0);
  TCCR0B = (TCCR0B & 0xF8) | 0x01;  // pulses at 62.5 kHz: not heard; micros() and delay() are wrong by it
  TIMSK0 = 0;                       // and its interrupt, every 16 us then, is not needed
  TCCR1A = 0;                       // timer 1 tells the time instead
  TCCR1B = 0x03;                    // 16 MHz / 64
  ADCSRA = (ADCSRA & 0xF8) | 0x05;  // a reading of the sensor in 26 us
  last_reading = analogRead(SENSOR_PIN);
  Serial.begin(BAUD);
}

void loop() {
  follow_sensor();
  while (Serial.available() > 0) {
    if (complete((uint8_t)Serial.read())) {
      obey();
    }
  }
  if (pushing && (uint16_t)(TCNT1 - heard) > SILENCE) {
    cut = true;
    give(0);
  }
}
