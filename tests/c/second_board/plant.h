/* The finger: four motors, each with an elastic tendon, and three joints whose inertias do not couple. SI units. */

#ifndef PLANT_H
#define PLANT_H

#include <stdint.h>

enum { MOTORS = 4, JOINTS = 3 };
enum { COUNTS_A_REVOLUTION = 2000, GAUGE_BITS = 12 };

struct plant {
    double theta[JOINTS], theta_rate[JOINTS];
    double motor[MOTORS], motor_rate[MOTORS];
    double torque[MOTORS], tension[MOTORS];
    int braked;
    /* Time of the simulation, ns. It lags behind real time if the machine was too busy. */
    int64_t clock;
};

void start_plant(struct plant *plant);
void advance_plant(struct plant *plant, int64_t nanoseconds);

/* Readings of the encoder and the gauge of one motor, counts. */
int32_t encoder(const struct plant *plant, int i);
unsigned gauge(const struct plant *plant, int i);

#endif
