#include "plant.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double pulley_radius = 4.75e-4;
static const double stiffness = 30000.0;
static const double rotor_inertia = 6e-7, rotor_damping = 2e-6;
static const double joint_inertia[JOINTS] = {3.7e-4, 1.4e-4, 2.5e-5};
/* This damping is larger than that of a real finger. It replaces friction and coupling, which this model omits. */
static const double joint_damping[JOINTS] = {2e-3, 2e-3, 2e-3};
static const double gauge_range = 100.0;
static const double start_degrees[JOINTS] = {0.0, 30.0, 60.0};
static const double stop_degrees[JOINTS][2] = {{-63.0, 63.0}, {-33.0, 103.0}, {2.0, 123.0}};

/* Moment arms, m: the torque of each tendon (column) on each joint (row), divided by the tension of the tendon. A motor
   that pulls its tendon shortens the tendon. This turns each joint in the direction of the sign of the tendon's moment
   arm at this joint. */
static const double R[JOINTS][MOTORS] = {
    {-0.0109, 0.0062, 0.0062, -0.0109},
    {0.0109, 0.0062, -0.0062, -0.0109},
    {0, 0.0062, -0.0062, 0},
};
/* Tensions that leave every joint without torque and have a minimum of 5 N. */
static const double home_tension[MOTORS] = {5.0, 5.0 * 109 / 62, 5.0 * 109 / 62, 5.0};

static void find_tensions(struct plant *plant)
{
    for (int i = 0; i < MOTORS; i++) {
        double stretch = pulley_radius * plant->motor[i];
        for (int j = 0; j < JOINTS; j++)
            stretch -= R[j][i] * plant->theta[j];
        plant->tension[i] = stretch > 0 ? stiffness * stretch : 0;
    }
}

void start_plant(struct plant *plant)
{
    memset(plant, 0, sizeof *plant);
    for (int j = 0; j < JOINTS; j++)
        plant->theta[j] = start_degrees[j] * pi / 180;
    for (int i = 0; i < MOTORS; i++) {
        double pulled = home_tension[i] / stiffness;
        for (int j = 0; j < JOINTS; j++)
            pulled += R[j][i] * plant->theta[j];
        plant->motor[i] = pulled / pulley_radius;
    }
    plant->braked = 1;
    find_tensions(plant);
}

static void step_plant(struct plant *plant, double h)
{
    find_tensions(plant);
    for (int i = 0; i < MOTORS; i++) {
        double torque = plant->torque[i] - pulley_radius * plant->tension[i] - rotor_damping * plant->motor_rate[i];
        plant->motor_rate[i] = plant->braked ? 0 : plant->motor_rate[i] + h * torque / rotor_inertia;
        plant->motor[i] += h * plant->motor_rate[i];
    }
    for (int j = 0; j < JOINTS; j++) {
        double torque = -joint_damping[j] * plant->theta_rate[j];
        for (int i = 0; i < MOTORS; i++)
            torque += R[j][i] * plant->tension[i];
        plant->theta_rate[j] += h * torque / joint_inertia[j];
        plant->theta[j] += h * plant->theta_rate[j];
        for (int side = 0; side < 2; side++) {
            double beyond = plant->theta[j] - stop_degrees[j][side] * pi / 180;
            if (side ? beyond > 0 : beyond < 0) {
                plant->theta[j] -= beyond;
                plant->theta_rate[j] = 0;
            }
        }
    }
}

void advance_plant(struct plant *plant, int64_t nanoseconds)
{
    const int64_t step = 50000;
    plant->clock += nanoseconds;
    while (nanoseconds > 0) {
        int64_t length = nanoseconds < step ? nanoseconds : step;
        step_plant(plant, 1e-9 * (double)length);
        nanoseconds -= length;
    }
    find_tensions(plant);
}

/* The encoder reads zero when the finger is straight and its tendons have the tensions of the start. */
int32_t encoder(const struct plant *plant, int i)
{
    double angle = plant->motor[i] - home_tension[i] / stiffness / pulley_radius;
    return (int32_t)floor(angle * COUNTS_A_REVOLUTION / (2 * pi));
}

/* Includes converter noise of at most one count up or down, like a real gauge. The library can report a gauge without
   noise as stuck while the other gauges fluctuate. */
unsigned gauge(const struct plant *plant, int i)
{
    static uint32_t random = 1;
    const double counts = 1 << GAUGE_BITS;
    random = random * 1664525u + 1013904223u;
    double count = floor(plant->tension[i] * counts / gauge_range + 0.5) + (double)(random >> 16) * 3 / 65536 - 1;
    return (unsigned)(count < 0 ? 0 : count < counts - 1 ? count : counts - 1);
}
