// All that the sketches need of Arduino's own header for this chip: who calls what.
#pragma once
void setup();
void loop();
