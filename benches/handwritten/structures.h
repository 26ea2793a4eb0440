/* The structures of a servo step. parameters.rs and by_hand.rs repeat them in Rust. */
#ifndef STRUCTURES_H
#define STRUCTURES_H

#include <stdint.h>

enum { JOINTS = 3, TENDONS = 4, TIP = 6 };

struct parameters {
    double period;
    double radians_per_count[TENDONS];
    double newton_per_count[TENDONS];
    double gauge_zero[TENDONS];
    double speed_gain, stretch_gain;
    double from_motors[JOINTS][TENDONS];
    double from_tensions[JOINTS][TENDONS];
    double home[TENDONS];
    double tight;
    double spring_part;
    double slew_step;
    double links[JOINTS];
    double joint_damping[JOINTS];
    double inverse_cholesky[JOINTS][JOINTS];
    double compliance[JOINTS];
    double share;
    double low[JOINTS], high[JOINTS];
    double limit_stiffness[JOINTS];
    double from_torque[TENDONS][JOINTS];
    double ghost[TENDONS], inverse_ghost[TENDONS];
    double ratio[TENDONS][TENDONS];
    double idle[TENDONS][TENDONS];
    double at_rest[TENDONS], strongest[TENDONS];
    double coulomb[TENDONS], past_conduit[TENDONS];
    double least_tension;
    double tension_gain, integral_gain, motor_damping;
    double limit[TENDONS], continuous[TENDONS];
    double heat_gain;
    double radius_m[TENDONS];
    double signed_radius[TENDONS];
    int32_t encoder_zero[TENDONS];
};

struct set_point {
    double joints[JOINTS];
    double stiffness[TIP][TIP];
    double damping;
};

/* The fingertip's spring, which changes gradually from one set point to the next. */
struct spring {
    double stiffness[TIP][TIP];
    double exact, damping;
};

struct report {
    double joints[JOINTS], joint_rates[JOINTS];
    double tensions[TENDONS], desired_tensions[TENDONS];
    double joint_torques[JOINTS];
    double torque_scale, stiffness_scale;
    double motor_torques[TENDONS];
    int32_t under_tension;
};

struct state {
    double motor_angles[TENDONS], motor_speeds[TENDONS], tensions[TENDONS];
    double integral[TENDONS];
    double transition[TENDONS];
    double still_at[TENDONS], still_seconds;
    double pulls[TENDONS];
    double heat[TENDONS];
    double anchor[JOINTS];
    struct spring first, second;
    struct report report;
    uint32_t age;
    int32_t following;
};

struct feedback {
    int32_t motor_counts[TENDONS];
    uint16_t gauge_counts[TENDONS];
};

#endif
