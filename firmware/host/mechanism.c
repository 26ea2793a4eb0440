#include "mechanism.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double pulley = 4.75e-4;
static const double stiffness = 30000.0;
static const double rotor_inertia = 6e-7, rotor_damping = 2e-6;
static const double joint_inertia[JOINTS] = {3.7e-4, 1.4e-4, 2.5e-5};
/* More than a real finger has: it replaces the friction and the coupling that this model leaves out. */
static const double joint_damping = 2e-3;
static const double gauge_range = 100.0, gauge_counts = 4096.0, counts_a_revolution = 2000.0;
static const double start_degrees[JOINTS] = {0.0, 30.0, 60.0};
static const double stop_degrees[JOINTS][2] = {{-63.0, 63.0}, {-33.0, 103.0}, {2.0, 123.0}};

/* Moment arms, m: the torque of each tendon at each joint, divided by the tension. A motor that pulls its tendon
   shortens the tendon, and so turns each joint in the direction of the sign of the moment arm. */
static const double R[JOINTS][MOTORS] = {
    {-0.0109, 0.0062, 0.0062, -0.0109},
    {0.0109, 0.0062, -0.0062, -0.0109},
    {0, 0.0062, -0.0062, 0},
};
/* Tensions that leave every joint without torque and have a minimum of 5 N. */
static const double home_tension[MOTORS] = {5.0, 5.0 * 109 / 62, 5.0 * 109 / 62, 5.0};

static double tension(const struct mechanism *finger, size_t i)
{
    double stretch = pulley * finger->motor[i];
    for (size_t j = 0; j < JOINTS; j++)
        stretch -= R[j][i] * finger->theta[j];
    return stretch > 0 ? stiffness * stretch : 0;
}

void mechanism_start(struct mechanism *finger)
{
    memset(finger, 0, sizeof *finger);
    for (size_t j = 0; j < JOINTS; j++)
        finger->theta[j] = start_degrees[j] * pi / 180;
    for (size_t i = 0; i < MOTORS; i++) {
        double pulled = home_tension[i] / stiffness;
        for (size_t j = 0; j < JOINTS; j++)
            pulled += R[j][i] * finger->theta[j];
        finger->motor[i] = pulled / pulley;
    }
    finger->braked = true;
}

static void step(struct mechanism *finger, double h)
{
    double pull[MOTORS];
    for (size_t i = 0; i < MOTORS; i++) {
        pull[i] = tension(finger, i);
        double torque = finger->torque[i] - pulley * pull[i] - rotor_damping * finger->motor_rate[i];
        finger->motor_rate[i] = finger->braked ? 0 : finger->motor_rate[i] + h * torque / rotor_inertia;
        finger->motor[i] += h * finger->motor_rate[i];
    }
    for (size_t j = 0; j < JOINTS; j++) {
        double torque = -joint_damping * finger->theta_rate[j];
        for (size_t i = 0; i < MOTORS; i++)
            torque += R[j][i] * pull[i];
        finger->theta_rate[j] += h * torque / joint_inertia[j];
        finger->theta[j] += h * finger->theta_rate[j];
        double lowest = stop_degrees[j][0] * pi / 180, highest = stop_degrees[j][1] * pi / 180;
        double within = fmin(fmax(finger->theta[j], lowest), highest);
        if (within != finger->theta[j]) {
            finger->theta[j] = within;
            finger->theta_rate[j] = 0;
        }
    }
}

void mechanism_advance(struct mechanism *finger, uint32_t microseconds)
{
    for (uint32_t left = microseconds; left > 0;) {
        uint32_t now = left < 50 ? left : 50;
        step(finger, 1e-6 * now);
        left -= now;
    }
}

void mechanism_sample(const struct mechanism *finger, struct sensors *sensors)
{
    /* Converter noise: -1, 0 or +1 count. The library can report a gauge without noise as stuck while the other gauges
       fluctuate. */
    static uint32_t random = 1;
    for (size_t i = 0; i < MOTORS; i++) {
        /* The encoders read zero when the finger is straight and its tendons have the tensions of the start. */
        double angle = finger->motor[i] - home_tension[i] / stiffness / pulley;
        random = random * 1664525u + 1013904223u;
        double noise = floor((double)(random >> 16) * 3 / 65536) - 1;
        double count = fmax(floor(tension(finger, i) * gauge_counts / gauge_range + 0.5) + noise, 0.0);
        sensors->encoders[i] = (int32_t)floor(angle * counts_a_revolution / (2 * pi));
        sensors->gauges[i] = (uint16_t)fmin(count, gauge_counts - 1);
    }
}
