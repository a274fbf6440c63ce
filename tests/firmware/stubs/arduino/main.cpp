// What Arduino's core does with a sketch, but for its own timers.
#include <Arduino.h>

int main() {
  setup();
  for (;;) {
    loop();
  }
}
