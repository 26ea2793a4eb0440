/* A simple simulated finger for a board that has no real one: four motors, each with an elastic tendon, and three
   joints whose inertias do not couple. It builds up tension and settles, but it is no measure of how a real finger
   moves. */

#ifndef FIRMWARE_MECHANISM_H
#define FIRMWARE_MECHANISM_H

#include "../hal.h"

#define JOINTS 3

/* SI units. */
struct mechanism {
    double theta[JOINTS], theta_rate[JOINTS];
    double motor[MOTORS], motor_rate[MOTORS];
    double torque[MOTORS];
    bool braked; /* True until the first non-zero torque. */
};

void mechanism_start(struct mechanism *finger);
void mechanism_advance(struct mechanism *finger, uint32_t microseconds);
void mechanism_sample(const struct mechanism *finger, struct sensors *sensors);

#endif
