/* finger_physics.h - the physics of a finger, for examples whose hardware is a simulation: three joints, four tendons
   that only pull, four motors. The values are the defaults of docs/sun2xp.toml. Gravity and Coriolis torques are
   omitted. C89. SI units, except in the arguments of step_physics. */

#ifndef FINGER_PHYSICS_H
#define FINGER_PHYSICS_H

#include <math.h>

#define PHYSICS_STEP 1e-4               /* s */
#define PULLEY 0.000475                 /* radius of a motor's pulley, m */
#define TENDON 30000.0                  /* stiffness, N/m */
#define COUNTS (2000 / 6.283185307179586)  /* encoder counts per rad */

struct finger_physics {
    double theta[3], theta_rate[3];     /* rad, rad/s */
    double motor[4], motor_rate[4];     /* rad, rad/s */
    double home[4];                     /* tensions at motor angle 0 and joint angle 0, N */
    int braked;                         /* 1 while the motors cannot turn */
};

/* R of eq. 14 of COINS Technical Report 90-48: the moment arms of the tendons at the joints, m. */
static const double Arms[3][4] = {
    {-0.0109, 0.0062, 0.0062, -0.0109}, {0.0109, 0.0062, -0.0062, -0.0109}, {0, 0.0062, -0.0062, 0}};

static double tension_of(const struct finger_physics *finger, int tendon)
{
    double stretch = PULLEY * finger->motor[tendon];
    int joint;

    for (joint = 0; joint < 3; joint++)
        stretch -= Arms[joint][tendon] * finger->theta[joint];
    stretch = finger->home[tendon] + TENDON * stretch;
    return stretch > 0 ? stretch : 0;
}

static int count_of(const struct finger_physics *finger, int motor)
{
    return (int)floor(finger->motor[motor] * COUNTS);
}

/* Puts the finger into the state in which a finger of the built-in simulated hand starts: joint angles of 0, 30 and 60
   degrees, the tendons at the homing pretension (the member home), and the motors braked. */
static void begin_physics(struct finger_physics *finger)
{
    static const double Pose[3] = {0, 0.5235987755982988, 1.0471975511965976};
    static const double Home[4] = {5, 8.790322580645162, 8.790322580645162, 5};
    int joint, motor;

    for (joint = 0; joint < 3; joint++) {
        finger->theta[joint] = Pose[joint];
        finger->theta_rate[joint] = 0;
    }
    for (motor = 0; motor < 4; motor++) {
        finger->home[motor] = Home[motor];
        finger->motor[motor] = finger->motor_rate[motor] = 0;
        for (joint = 0; joint < 3; joint++)
            finger->motor[motor] += Arms[joint][motor] * Pose[joint] / PULLEY;
    }
    finger->braked = 1;
}

/* Returns the speed that remains after dry friction has reduced it by the amount `loss`. Dry friction can stop a motion
   but not reverse it. */
static double rubbed(double speed, double loss)
{
    return fabs(speed) <= loss ? 0 : speed - (speed > 0 ? loss : -loss);
}

/* Inverts the inertia matrix of the joints. Joint 0 is not coupled with the others. inverse gets the diagonal entries
   of the inverse matrix for joints 0, 1 and 2, and then its entry for the coupling of joints 1 and 2. */
static void invert_inertia(const struct finger_physics *finger, double inverse[4])
{
    double c1 = cos(finger->theta[1]), c12 = cos(finger->theta[1] + finger->theta[2]);
    double middle = 0.03556 + 0.0254 * c1, elbow = 0.03556 + 0.0508 * c1;
    double end = elbow + 0.02 * c12, tip = elbow + 0.04 * c12;
    double about_0 = 2.6e-5 + 0.045 * middle * middle + 9.7e-6 * c1 * c1 + 0.025 * end * end + 3.3e-6 * c12 * c12
        + 0.005 * tip * tip;
    double coupled = (0.025 / 2 + 0.005) * 0.0508 * 0.04 * cos(finger->theta[2]);
    double distal = 3.6e-6 + 0.025 * 0.02 * 0.02 + 0.005 * 0.04 * 0.04;
    double proximal = 1.04e-5 + 0.045 * 0.0254 * 0.0254 + 0.03 * 0.0508 * 0.0508 + distal + 2 * coupled;
    double determinant = proximal * distal - (distal + coupled) * (distal + coupled);

    inverse[0] = 1 / about_0;
    inverse[1] = distal / determinant;
    inverse[2] = proximal / determinant;
    inverse[3] = -(distal + coupled) / determinant;
}

/* Advances the simulation by PHYSICS_STEP. torques are the torques of the motors, N cm. */
static void step_physics(struct finger_physics *finger, const double torques[4])
{
    double tension[4], torque[3], inverse[4], rate;
    int joint, motor;

    for (motor = 0; motor < 4; motor++)
        tension[motor] = tension_of(finger, motor);
    for (joint = 0; joint < 3; joint++) {
        torque[joint] = -5e-4 * finger->theta_rate[joint];
        for (motor = 0; motor < 4; motor++)
            torque[joint] += Arms[joint][motor] * tension[motor];
    }
    invert_inertia(finger, inverse);
    for (joint = 0; joint < 3; joint++) {
        rate = finger->theta_rate[joint] + PHYSICS_STEP * inverse[joint] * torque[joint];
        if (joint > 0)
            rate += PHYSICS_STEP * inverse[3] * torque[3 - joint];
        finger->theta_rate[joint] = rubbed(rate, PHYSICS_STEP * inverse[joint] * 0.5e-3);
        finger->theta[joint] += PHYSICS_STEP * finger->theta_rate[joint];
    }
    for (motor = 0; motor < 4 && !finger->braked; motor++) {
        double pull = PULLEY * tension[motor];
        double driving = 0.01 * torques[motor] - pull - 2e-6 * finger->motor_rate[motor];
        double loss = PHYSICS_STEP / 6e-7 * (0.7e-3 + 0.05 * pull);

        finger->motor_rate[motor] = rubbed(finger->motor_rate[motor] + PHYSICS_STEP / 6e-7 * driving, loss);
        finger->motor[motor] += PHYSICS_STEP * finger->motor_rate[motor];
    }
}

#endif
