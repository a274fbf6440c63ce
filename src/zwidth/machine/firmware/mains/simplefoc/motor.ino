// A law on a brushless motor with SimpleFOC: encoder counts in, torque out, on any board that the library knows.
//
// The motor and its driver are those of your board: everything between the two lines.  The torque is as good as
// the motor's control of it: with TorqueControlType::voltage, and no resistance given, it falls with speed,
// which the hand feels as damping beyond the certificate's.
//
// The force begins and ends as guard.h says, and ends for good where a sample comes later than half a period.
// Where loop() itself hangs nothing here notices: start the watchdog of your chip in watchdog_start.

#include <SimpleFOC.h>
#include <stdint.h>

#include "law.h"

#define TELEMETRY_RING 1024
#include "guard.h"
#include "telemetry.h"

// ---- what differs from one motor to the next ------------------------------------------------------------

#define PULSES 2048        // of the encoder in a turn; it counts four times as many (a sensor of 14 bits: 4096)
#define SENSE 1            // -1 where the angle falls while the handle goes into the wall
#define TORQUE_PER_TARGET 0.05f  // [N*m] of the motor for a target of 1 A, k_t = 9.55/(rpm/V); of 1 V k_t/R
#define BAUD 115200

BLDCMotor motor = BLDCMotor(7);
BLDCDriver3PWM driver = BLDCDriver3PWM(9, 5, 6, 8);
Encoder sensor = Encoder(2, 3, PULSES);  // a magnetic one is MagneticSensorSPI sensor(AS5147_SPI, 10); or
// MagneticSensorI2C sensor(AS5600_I2C); then on_a, on_b and the line with enableInterrupts go

void on_a() { sensor.handleA(); }
void on_b() { sensor.handleB(); }

void watchdog_start() {}
void watchdog_restart() {}

// ---- what is the same for all ---------------------------------------------------------------------------

#define TURN 6.283185307179586

static_assert(LAW_ROTARY, "the position of this sketch is the angle of the motor");
static_assert(4 * PULSES * LAW_RESOLUTION > 0.9999 * TURN && 4 * PULSES * LAW_RESOLUTION < 1.0001 * TURN,
              "the encoder has another step than the law was proved with");

constexpr uint32_t PERIOD = (uint32_t)(1e6 * LAW_SAMPLE_PERIOD_S + 0.5);
static_assert(1e6 * LAW_SAMPLE_PERIOD_S > 0.9999 * PERIOD && 1e6 * LAW_SAMPLE_PERIOD_S < 1.0001 * PERIOD,
              "the clock counts microseconds and misses the period by more than 1 in 10 000");

guard guarded;
telemetry told;
uint32_t due;

// Whole turns and the angle within one: each exact where one float for both would not be.
int32_t position_counts() {
  float within = sensor.getMechanicalAngle() * (float)(4 * PULSES / TURN);
  return SENSE * (sensor.getFullRotations() * 4 * PULSES + (int32_t)(within + 0.5f));
}

// Positive out of the wall: towards smaller angles.
void apply_force(law_force force) {
  motor.target = -SENSE * (float)force * (float)LAW_FORCE_PER_UNIT / TORQUE_PER_TARGET;
}

void setup() {
  guard_init(&guarded);
  telemetry_init(&told);
  Serial.begin(BAUD);
  sensor.init();
  sensor.enableInterrupts(on_a, on_b);
  motor.linkSensor(&sensor);
  driver.voltage_power_supply = 12;
  driver.init();
  motor.linkDriver(&driver);
  motor.controller = MotionControlType::torque;
  motor.torque_controller = TorqueControlType::voltage;
  motor.target = 0;
  motor.init();
  if (!motor.initFOC()) {
    guard_end(&guarded, GUARD_FAILED);
    motor.disable();
  }
  watchdog_start();
  due = micros() + PERIOD;
}

void loop() {
  motor.loopFOC();  // reads the sensor, and commutates as often as it can
  uint32_t late = micros() - due;
  if (late < 0x80000000u) {
    if (late > PERIOD / 2) {
      guard_end(&guarded, GUARD_LATE);
    }
    law_force force = guard_step(&guarded, position_counts());
    apply_force(force);
    telemetry_sample(&told, due, guarded.counts, force, guard_status(&guarded));
    due += late > PERIOD ? late : PERIOD;
    if (guarded.phase == GUARD_ENDED) {
      motor.disable();
    }
    watchdog_restart();
  }
  motor.move();
  if (Serial.availableForWrite() > 0) {
    int byte = telemetry_next(&told);
    if (byte >= 0) {
      Serial.write((uint8_t)byte);
    }
  }
}
