/*
 * One servo step of Figures 9 and 10, from counts to motor torques and report, as handwritten C for one finger.
 * The library's step is compared with it. This step has the arithmetic and the features of Controller::cycle for a
 * fingertip that is a spring with the report's law. Gravity compensation is off in both. The library also estimates the
 * contact force every 5 ms. This step does not.
 *
 * The units are those of the library: rad, cm, N, N cm, s. parameters.rs and by_hand.rs repeat the structures of
 * structures.h.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "stiffness.h"
#include "structures.h"

static const double SOFT_LIMIT_DEPTH = 0.0175, SOFT_LIMIT_DAMPING = 0.015, LIMP_DAMPING = 0.2;
static const double FADE = 0.02, REST = 0.05, WANDER = 0.007, WARM = 0.8;

static void measure(const struct parameters *p, struct state *s, const struct feedback *feedback)
{
    double angles[TENDONS], tensions[TENDONS], moved = 0.0, least = INFINITY;
    double elapsed = p->period * s->age;
    for (int i = 0; i < TENDONS; i++) {
        int32_t counts = (int32_t)((uint32_t)feedback->motor_counts[i] - (uint32_t)p->encoder_zero[i]);
        angles[i] = counts * p->radians_per_count[i];
        tensions[i] = (feedback->gauge_counts[i] - p->gauge_zero[i]) * p->newton_per_count[i];
    }
    for (int i = 0; i < TENDONS; i++) {
        double speed = (angles[i] - s->motor_angles[i]) / elapsed;
        s->motor_speeds[i] += (speed - s->motor_speeds[i]) * p->speed_gain;
        s->tensions[i] += (tensions[i] - s->tensions[i]) * p->stretch_gain;
        double way = fabs(angles[i] - s->still_at[i]);
        moved = way > moved ? way : moved;
        least = tensions[i] < least ? tensions[i] : least;
    }
    if (moved <= WANDER) {
        s->still_seconds += elapsed;
    } else {
        memcpy(s->still_at, angles, sizeof angles);
        s->still_seconds = 0.0;
    }
    for (int j = 0; j < JOINTS; j++) {
        double joint = 0.0, rate = 0.0;
        for (int i = 0; i < TENDONS; i++) {
            joint += p->from_motors[j][i] * angles[i] + p->from_tensions[j][i] * (s->tensions[i] - p->home[i]);
            rate += p->from_motors[j][i] * s->motor_speeds[i];
        }
        s->report.joints[j] = joint;
        s->report.joint_rates[j] = rate;
    }
    memcpy(s->motor_angles, angles, sizeof angles);
    memcpy(s->report.tensions, tensions, sizeof tensions);
    s->age = 0;
    s->report.under_tension = least >= p->tight && s->still_seconds >= REST;
}

/* Computes the largest pull that each motor may exert at its present heat. */
static void warm_limits(const struct parameters *p, const struct state *s, double limit[TENDONS])
{
    for (int i = 0; i < TENDONS; i++) {
        double part = s->heat[i] / (p->continuous[i] * p->continuous[i]);
        limit[i] = p->limit[i] + (p->continuous[i] - p->limit[i]) * clamp((part - WARM) / (1.0 - WARM), 0.0, 1.0);
    }
}

/* Computes the tensions by eqs. 18 to 20, with an upper bound. The bound of a tendon is the configured maximum or the
   tension that its motor can give with the pull `limit`, whichever is less, but at least the tension at rest. Returns
   the factor by which the torques are scaled down to stay within the bounds. */
static double distribute(const struct parameters *p, const double limit[TENDONS], const double torques[JOINTS],
                         double tensions[TENDONS])
{
    double wanted[TENDONS], scale = 1.0, ghost_torque = -INFINITY;
    for (int i = 0; i < TENDONS; i++)
        wanted[i] = p->from_torque[i][0] * torques[0] + p->from_torque[i][1] * torques[1]
            + p->from_torque[i][2] * torques[2];
    for (int i = 0; i < TENDONS; i++) {
        double given = (limit[i] - p->coulomb[i]) * p->past_conduit[i];
        double most = p->strongest[i] < given ? p->strongest[i] : given;
        most = most > p->at_rest[i] ? most : p->at_rest[i];
        for (int j = 0; j < TENDONS; j++) {
            double added = wanted[i] - p->ratio[i][j] * wanted[j];
            double headroom = most - p->idle[i][j];
            if (added * scale > headroom)
                scale = headroom / added;
        }
    }
    for (int i = 0; i < TENDONS; i++) {
        double needed = (p->least_tension - wanted[i] * scale) * p->inverse_ghost[i];
        ghost_torque = needed > ghost_torque ? needed : ghost_torque;
    }
    for (int i = 0; i < TENDONS; i++) {
        double tension = wanted[i] * scale + p->ghost[i] * ghost_torque;
        tensions[i] = tension > p->least_tension ? tension : p->least_tension;
    }
    return scale;
}

static void approach(struct spring *spring, const double stiffness[TIP][TIP], double exact, double damping, double part)
{
    for (int row = 0; row < TIP; row++)
        for (int column = 0; column < TIP; column++)
            spring->stiffness[row][column] += (stiffness[row][column] - spring->stiffness[row][column]) * part;
    spring->exact += (exact - spring->exact) * part;
    spring->damping += (damping - spring->damping) * part;
}

/* Computes the joint torques of the spring, of its damper and of the soft limits. Moves the anchor, the rest position
   of the spring, toward the set point. */
static void joint_torques(const struct parameters *p, struct state *s, const struct set_point *set_point,
                          double torques[JOINTS])
{
    const double *joints = s->report.joints, *rates = s->report.joint_rates;
    double j[TIP][JOINTS], k_theta[JOINTS][JOINTS], way[JOINTS], farthest = 0.0;
    double b[JOINTS], pushed[JOINTS], limits[JOINTS];
    approach(&s->first, set_point->stiffness, 0.0, set_point->damping, p->spring_part);
    approach(&s->second, (const double (*)[TIP])s->first.stiffness, s->first.exact, s->first.damping, p->spring_part);
    spatial_jacobian(p->links, joints, j);
    joint_stiffness((const double (*)[TIP])s->second.stiffness, j, k_theta);
    k_theta[0][0] += hold((const double (*)[TIP])s->second.stiffness, j);
    for (int i = 0; i < JOINTS; i++) {
        double beyond = clamp(joints[i], p->low[i], p->high[i]) - joints[i];
        double deep = fabs(beyond) / SOFT_LIMIT_DEPTH < 1.0 ? fabs(beyond) / SOFT_LIMIT_DEPTH : 1.0;
        limits[i] = p->limit_stiffness[i] * deep;
        pushed[i] = limits[i] * (beyond - clamp(0.5 * beyond, -0.5 * SOFT_LIMIT_DEPTH, 0.5 * SOFT_LIMIT_DEPTH));
    }
    double carried = admissible(p, k_theta, limits);
    s->report.stiffness_scale = carried;

    for (int i = 0; i < JOINTS; i++) {
        way[i] = set_point->joints[i] - s->anchor[i];
        farthest = fabs(way[i]) > farthest ? fabs(way[i]) : farthest;
    }
    if (farthest > p->slew_step)
        for (int i = 0; i < JOINTS; i++)
            s->anchor[i] += way[i] * (p->slew_step / farthest);
    else
        memcpy(s->anchor, set_point->joints, sizeof s->anchor);

    for (int row = 0; row < JOINTS; row++)
        for (int column = 0; column < JOINTS; column++)
            k_theta[row][column] *= carried;
    for (int i = 0; i < JOINTS; i++) {
        double k = k_theta[i][i] > 1e-6 ? k_theta[i][i] : 1e-6;
        b[i] = sqrt(sqrt(p->joint_damping[i] / k));
    }
    for (int row = 0; row < JOINTS; row++) {
        double spring = 0.0, damper = LIMP_DAMPING * rates[row];
        for (int column = 0; column < JOINTS; column++) {
            spring += k_theta[row][column] * (s->anchor[column] - joints[column]);
            damper += b[row] * k_theta[row][column] * b[column] * rates[column];
        }
        torques[row] = spring * (1.0 - s->second.exact) - damper * s->second.damping + pushed[row]
            - limits[row] * rates[row] * SOFT_LIMIT_DAMPING;
    }
}

static inline void follow(const struct parameters *p, struct state *s, const struct set_point *set_point,
                          int proportional)
{
    double torques[JOINTS], asked[TENDONS], limit[TENDONS];
    int begins = !s->following;
    if (begins) {
        memcpy(s->anchor, s->report.joints, sizeof s->anchor);
        memcpy(s->first.stiffness, set_point->stiffness, sizeof s->first.stiffness);
        s->first.exact = 0.0;
        s->first.damping = set_point->damping;
        s->second = s->first;
        s->following = 1;
    }
    joint_torques(p, s, set_point, torques);
    warm_limits(p, s, limit);
    s->report.torque_scale = distribute(p, limit, torques, s->report.desired_tensions);
    memcpy(s->report.joint_torques, torques, sizeof torques);

    for (int i = 0; i < TENDONS; i++) {
        double desired = s->report.desired_tensions[i], error = desired - s->report.tensions[i];
        double rest = desired - s->motor_speeds[i] * p->radius_m[i] * p->motor_damping;
        if (proportional)
            rest += error * p->tension_gain;
        double integral = s->integral[i] + p->integral_gain * error;
        double pull = rest + integral;
        if (!(fabs(pull) > limit[i] && pull * error > 0.0)) {
            s->integral[i] = integral;
        } else if (pull > 0.0) {
            double room = limit[i] - rest > 0.0 ? limit[i] - rest : 0.0;
            s->integral[i] = s->integral[i] < room ? s->integral[i] : room;
        } else {
            double room = -limit[i] - rest < 0.0 ? -limit[i] - rest : 0.0;
            s->integral[i] = s->integral[i] > room ? s->integral[i] : room;
        }
        asked[i] = clamp(rest + s->integral[i], -limit[i], limit[i]);
    }
    double fade = p->period / FADE < 1.0 ? p->period / FADE : 1.0;
    for (int i = 0; i < TENDONS; i++) {
        if (begins)
            s->transition[i] = s->pulls[i] - asked[i];
        s->pulls[i] = clamp(asked[i] + s->transition[i], -limit[i], limit[i]);
        s->transition[i] -= s->transition[i] * fade;
    }
}

static inline void step(const struct parameters *p, struct state *s, const struct feedback *feedback,
                        const struct set_point *set_point, double motor_torques[TENDONS], struct report *report,
                        int proportional)
{
    if (s->age < UINT32_MAX)
        s->age++;
    if (feedback != NULL) {
        measure(p, s, feedback);
        follow(p, s, set_point, proportional);
    }
    for (int i = 0; i < TENDONS; i++) {
        s->heat[i] += (s->pulls[i] * s->pulls[i] - s->heat[i]) * p->heat_gain;
        motor_torques[i] = s->report.motor_torques[i] = s->pulls[i] * p->signed_radius[i];
    }
    *report = s->report;
}

void figure9_step(const struct parameters *p, struct state *s, const struct feedback *feedback,
                  const struct set_point *set_point, double motor_torques[TENDONS], struct report *report)
{
    step(p, s, feedback, set_point, motor_torques, report, 0);
}

void figure10_step(const struct parameters *p, struct state *s, const struct feedback *feedback,
                   const struct set_point *set_point, double motor_torques[TENDONS], struct report *report)
{
    step(p, s, feedback, set_point, motor_torques, report, 1);
}

/* Starts at rest, with motors that pull as much as their tendons. */
void start(const struct parameters *p, struct state *s, const struct feedback *feedback)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < TENDONS; i++) {
        int32_t counts = (int32_t)((uint32_t)feedback->motor_counts[i] - (uint32_t)p->encoder_zero[i]);
        double angle = counts * p->radians_per_count[i];
        double tension = (feedback->gauge_counts[i] - p->gauge_zero[i]) * p->newton_per_count[i];
        s->motor_angles[i] = s->still_at[i] = angle;
        s->tensions[i] = tension;
        s->pulls[i] = clamp(tension, 0.0, p->limit[i]);
    }
    s->report.torque_scale = s->report.stiffness_scale = 1.0;
}
