// What the example asks of SimpleFOC and of Arduino, declared as their documentation has it.
#pragma once
#include <stddef.h>
#include <stdint.h>

struct Line {
  void begin(unsigned long baud);
  int availableForWrite();
  size_t write(uint8_t byte);
};
extern Line Serial;
unsigned long micros();

enum MotionControlType : uint8_t { torque = 0x00, velocity = 0x01, angle = 0x02 };
enum TorqueControlType : uint8_t { voltage = 0x00, dc_current = 0x01, foc_current = 0x02 };

class Sensor {
 public:
  virtual ~Sensor() {}
  virtual float getMechanicalAngle();
  virtual int32_t getFullRotations();
};

class Encoder : public Sensor {
 public:
  Encoder(int a, int b, float pulses, int index = 0);
  void init();
  void enableInterrupts(void (*on_a)() = nullptr, void (*on_b)() = nullptr, void (*on_index)() = nullptr);
  void handleA();
  void handleB();
};

class BLDCDriver {
 public:
  float voltage_power_supply;
};

class BLDCDriver3PWM : public BLDCDriver {
 public:
  BLDCDriver3PWM(int a, int b, int c, int enable = -1);
  int init();
};

class BLDCMotor {
 public:
  explicit BLDCMotor(int pole_pairs, float resistance = -1, float kv = -1, float inductance = -1);
  void linkSensor(Sensor *sensor);
  void linkDriver(BLDCDriver *driver);
  int init();
  int initFOC();
  void loopFOC();
  void move(float target = -12345.0f);
  void disable();
  float target;
  MotionControlType controller;
  TorqueControlType torque_controller;
};
