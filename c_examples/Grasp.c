/* Grasp.c - three fingers grasp a ball, lift it from the table, hold it and put it down.

   The hand is that of grasp.toml. The fingertips are springs. The program sets their anchors (rest positions) inside
   the ball, so the springs press the tips against the ball. Friction carries the weight. The fingers press so little
   that the ball is about to slip when they lift it. Reflexes then tighten the grasp: each finger presses harder when
   its contact or that of another finger is about to slip. A call that moves the anchors removes the force that the
   reflexes have added, and the reflexes must add it again. The exit status is 0 if the grasp tightens, and if the ball
   is lifted, does not creep while it is held, and is back on the table at the end. Otherwise the program says on
   standard error which of these conditions is not met. The program works with a simulated hand only, because
   sun2xp_object reads the pose of a simulated ball. It is C99 with functions of POSIX. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "sun2xp.h"

#define RADIUS 1.5                      /* of the ball, cm */
#define CLEAR 0.4                       /* gap between the open fingertips and the ball, cm */
#define SQUEEZE 0.25                    /* depth of the anchors below the surface of the ball, cm */
#define TIGHTEN 0.05                    /* increase of the force of each finger with each slip event, N */
#define STRONGEST 4.0                   /* largest force of a finger, N */
#define LIFT 1.5                        /* height to which the ball is lifted, cm */
#define HOLD 2.0                        /* time for which the ball is held, s */
#define HALF 0.5
#define SINE 0.8660254                  /* of 60 degrees */

/* Position of the ball on the table, cm, and directions from its vertical axis to the contacts around its equator, in
   the palm's frame. Fingers 1 and 2 are side by side, and finger 3 is the thumb. The palm faces down: its z axis points
   down, and the table is at z = 12 cm. */
static const double Start[3] = {0.0, 0.0, 10.5};
static const double Contact[3][3] = {{SINE, HALF, 0.0}, {-SINE, HALF, 0.0}, {0.0, -1.0, 0.0}};

/* The places of the fingers in the palm, as in docs/sun2xp.toml: the thumb is turned by 180 degrees about z. */
static const double Base[3][3] = {{3.0, 3.5, 0.0}, {-3.0, 3.5, 0.0}, {0.0, -3.5, 0.0}};     /* cm */
static const double Turned[3] = {1.0, 1.0, -1.0};

static const double Kx[9] = {3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0};                  /* N/cm */

static sun2xp_hand *hand;

static void check(int result)
{
    if (result != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        exit(1);
    }
}

static struct sun2xp_object object(void)
{
    struct sun2xp_object Object;

    Object.size = sizeof Object;
    check(sun2xp_object(hand, &Object));
    return Object;
}

/* Waits for the given simulated time, s. On a busy machine, simulated time passes more slowly than real time. */
static void pass(double seconds)
{
    const struct timespec tick = {0, 2000000};
    const double end = object().time + seconds;

    while (object().time < end)
        nanosleep(&tick, 0);
}

/* Sets the anchors of all fingertips in one cycle. up is the height of the anchors above Start, the centre of the ball
   on the table, cm. distance is their distance from the vertical axis of the ball, cm. */
static void anchor(double up, double distance)
{
    struct sun2xp_set_point Group[3] = {{0}};
    double Tip[3][3];
    int i;

    for (i = 0; i < 3; i++) {
        Tip[i][0] = Turned[i] * (Start[0] + distance * Contact[i][0] - Base[i][0]);
        Tip[i][1] = Turned[i] * (Start[1] + distance * Contact[i][1] - Base[i][1]);
        Tip[i][2] = Start[2] - up - Base[i][2];
        Group[i].size = sizeof Group[i];
        Group[i].finger = i + 1;
        Group[i].tip = Tip[i];
        Group[i].stiffness = Kx;
    }
    check(sun2xp_send_group(hand, 3, Group));
}

/* Installs the reflexes: each finger presses harder toward the axis of the ball when the contact of any finger is about
   to slip. */
static void tighten_on_slip(void)
{
    struct sun2xp_reflex Rule = {0};
    int i, slipping;

    Rule.size = sizeof Rule;
    Rule.event = SUN2XP_EVENT_SLIP;
    Rule.reaction = SUN2XP_THEN_GRIP;
    Rule.value = TIGHTEN;
    Rule.largest = STRONGEST;
    for (i = 0; i < 3; i++)
        for (slipping = 0; slipping < 3; slipping++) {
            Rule.condition = slipping == i ? SUN2XP_WHEN_EVENT : SUN2XP_WHEN_OTHER_FINGER;
            Rule.finger = slipping + 1;
            Rule.position[0] = -Turned[i] * Contact[i][0];
            Rule.position[1] = -Turned[i] * Contact[i][1];
            if (sun2xp_install_reflex(hand, i + 1, &Rule) < 0)
                check(-1);
        }
}

/* Moves the anchors in small steps. up and distance are the arguments of anchor at the beginning of the motion, to_up
   and to_distance those at its end. */
static void glide(double up, double distance, double to_up, double to_distance)
{
    int step;

    for (step = 1; step <= 20; step++) {
        anchor(up + (to_up - up) * step / 20, distance + (to_distance - distance) * step / 20);
        pass(0.05);
    }
    pass(0.5);
}

/* Prints where the ball is and how hard each finger presses. Returns the sum of the forces toward the axis of the
   ball, N. */
static double show(const char *doing)
{
    struct sun2xp_object Object = object();
    double force, sum = 0.0;
    int i;

    printf("%-10s  ball at %6.3f %6.3f %6.3f cm, pressed with", doing, Object.position[0], Object.position[1],
           Object.position[2]);
    for (i = 0; i < 3; i++) {
        force = -Object.force[i][0] * Contact[i][0] - Object.force[i][1] * Contact[i][1];
        printf(" %4.2f", force);
        sum += force;
    }
    printf(" N\n");
    return sum;
}

/* Computes the mean position of the ball over 0.1 s, because the fingers vibrate by some micrometres. */
static void average(double *Mean)
{
    int tries, axis;

    Mean[0] = Mean[1] = Mean[2] = 0.0;
    for (tries = 0; tries < 50; tries++) {
        struct sun2xp_object Object = object();
        for (axis = 0; axis < 3; axis++)
            Mean[axis] += Object.position[axis] / 50;
        pass(0.002);
    }
}

/* Returns the distance by which the ball moves while it is held, cm. */
static double hold(double seconds)
{
    double Before[3], After[3];

    average(Before);
    pass(seconds);
    average(After);
    return sqrt(pow(After[0] - Before[0], 2) + pow(After[1] - Before[1], 2) + pow(After[2] - Before[2], 2));
}

/* Returns whether a condition is met. If it is not, says so. */
static int expect(int met, const char *condition)
{
    if (!met)
        fprintf(stderr, "Grasp: this condition is not met: %s\n", condition);
    return met;
}

int main(void)
{
    double grasped, tightened, lifted, crept, back;
    int success;

    check(sun2xp_open(NULL, &hand));
    show("started");
    anchor(0.0, RADIUS + CLEAR);
    pass(1.0);
    show("open");
    glide(0.0, RADIUS + CLEAR, 0.0, RADIUS - SQUEEZE);
    grasped = show("grasped");
    tighten_on_slip();
    glide(0.0, RADIUS - SQUEEZE, LIFT, RADIUS - SQUEEZE);
    tightened = show("lifted");
    lifted = Start[2] - object().position[2];
    crept = hold(HOLD);
    printf("held for %g s: moved by %.4f cm\n", HOLD, crept);
    glide(LIFT, RADIUS - SQUEEZE, 0.0, RADIUS - SQUEEZE);
    glide(0.0, RADIUS - SQUEEZE, 0.0, RADIUS + CLEAR);
    show("released");
    back = fabs(object().position[2] - Start[2]);
    sun2xp_close(hand);
    success = expect(tightened > 1.05 * grasped, "the grasp tightens by more than 5 %");
    success &= expect(lifted > LIFT - 0.3, "the ball rises by more than LIFT - 0.3 cm");
    success &= expect(crept < 0.01, "the ball moves by less than 0.01 cm while it is held");
    success &= expect(back < 0.1, "the ball is less than 0.1 cm from the table at the end");
    return success ? 0 : 1;
}
