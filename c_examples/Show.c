/* Show.c - three fingers take a ball and move it about, for people who watch them with sun2xp monitor.

   The hand is that of grasp.toml, as in Grasp.c. The fingers lift the ball, move it along a circle while they change
   their stiffness, and put it down. The argument is the time for which the ball moves along the circle, s; 10 by
   default. The exit status is 0 if the fingers still hold the ball at the end of the circle. The program is C99
   with functions of POSIX. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "sun2xp.h"

#define RADIUS 1.5                      /* of the ball, cm */
#define CLEAR 0.4                       /* gap between the open fingertips and the ball, cm */
#define SQUEEZE 0.8                     /* depth of the anchors (rest positions) below the surface of the ball, cm */
#define LIFT 0.9                        /* height to which the ball is lifted, cm */
#define CIRCLE 0.6                      /* radius of the circle, cm */
#define PERIOD 3.0                      /* time for one turn of the circle, s */
#define SOFT 2.5                        /* smallest stiffness, N/cm */
#define STIFF 4.5                       /* largest stiffness, N/cm */
#define HALF 0.5
#define SINE 0.8660254                  /* of 60 degrees */
#define TURN 6.2831853                  /* rad */

/* As in Grasp.c: the position of the ball on the table, cm; the directions from its vertical axis to the contacts
   around its equator; the places of the fingers in the palm, cm; and -1 for the thumb, which is turned by 180 degrees
   about z. */
static const double Start[3] = {0.0, 0.0, 10.5};
static const double Contact[3][2] = {{SINE, HALF}, {-SINE, HALF}, {0.0, -1.0}};
static const double Base[3][2] = {{3.0, 3.5}, {-3.0, 3.5}, {0.0, -3.5}};
static const double Turned[3] = {1.0, 1.0, -1.0};

/* What the fingers do: the place of the ball relative to Start, cm, the distance of the anchors from the axis of the
   ball, cm, and the stiffness, N/cm. */
struct Grip {
    double X, Y, Up, Distance, Stiffness;
};

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

/* Sets the anchors and the stiffness of all fingertips in one cycle. */
static void grip(struct Grip To)
{
    const double Kx[9] = {To.Stiffness, 0.0, 0.0, 0.0, To.Stiffness, 0.0, 0.0, 0.0, To.Stiffness};
    struct sun2xp_set_point Group[3] = {{0}};
    double Tip[3][3];
    int i;

    for (i = 0; i < 3; i++) {
        Tip[i][0] = Turned[i] * (Start[0] + To.X + To.Distance * Contact[i][0] - Base[i][0]);
        Tip[i][1] = Turned[i] * (Start[1] + To.Y + To.Distance * Contact[i][1] - Base[i][1]);
        Tip[i][2] = Start[2] - To.Up;
        Group[i].size = sizeof Group[i];
        Group[i].finger = i + 1;
        Group[i].tip = Tip[i];
        Group[i].stiffness = Kx;
    }
    check(sun2xp_send_group(hand, 3, Group));
}

/* Interpolates between two values. part is the completed part of the motion, 0 to 1. The speed is zero at the beginning
   and at the end. */
static double between(double from, double to, double part)
{
    return from + (to - from) * (HALF - HALF * cos(HALF * TURN * part));
}

/* Moves from one grip to another. The seconds are simulated time, which passes more slowly on a busy machine. */
static struct Grip glide(struct Grip From, struct Grip To, double seconds)
{
    const struct timespec tick = {0, 10000000};
    const double begin = object().time;
    double part = 0.0;

    while (part < 1.0) {
        struct Grip Now;
        part = fmin((object().time - begin) / seconds, 1.0);
        Now.X = between(From.X, To.X, part);
        Now.Y = between(From.Y, To.Y, part);
        Now.Up = between(From.Up, To.Up, part);
        Now.Distance = between(From.Distance, To.Distance, part);
        Now.Stiffness = between(From.Stiffness, To.Stiffness, part);
        grip(Now);
        nanosleep(&tick, 0);
    }
    return To;
}

/* Moves the ball along a circle, up and down, and makes the springs softer and stiffer. */
static struct Grip circle(struct Grip At, double seconds)
{
    const struct timespec tick = {0, 10000000};
    const double begin = object().time;
    const double middle = At.Up;
    double time = 0.0;

    while (time < seconds) {
        const double angle = TURN * time / PERIOD;
        const double grown = fmin(time, 1.0);
        At.X = grown * CIRCLE * cos(angle);
        At.Y = grown * CIRCLE * sin(angle);
        At.Up = middle + grown * HALF * CIRCLE * sin(HALF * angle);
        At.Stiffness = between(SOFT, STIFF, 1.0 - fabs(fmod(time, 4.0) / 2.0 - 1.0));
        grip(At);
        nanosleep(&tick, 0);
        time = object().time - begin;
    }
    return At;
}

int main(int argc, char **argv)
{
    char *rest = NULL;
    const double seconds = argc > 1 ? strtod(argv[1], &rest) : 10.0;
    const struct Grip Open = {0.0, 0.0, 0.0, RADIUS + CLEAR, SOFT};
    const struct Grip Closed = {0.0, 0.0, 0.0, RADIUS - SQUEEZE, SOFT};
    const struct Grip Lifted = {0.0, 0.0, LIFT, RADIUS - SQUEEZE, SOFT};
    struct sun2xp_object Ball;
    struct Grip At;
    double off;

    if (argc > 1 && *rest != '\0') {
        fprintf(stderr, "Show: %s is not a time in s: give a number, for example 10\n", argv[1]);
        return 1;
    }
    check(sun2xp_open(NULL, &hand));
    printf("The hand is open. It moves the ball for %g s. To watch it, run sun2xp monitor or sun2xp monitor --web.\n",
           seconds);
    fflush(stdout);
    At = glide(Open, Open, 1.0);
    At = glide(At, Closed, 1.5);
    At = glide(At, Lifted, 1.5);
    At = circle(At, seconds);
    Ball = object();
    off = hypot(Ball.position[0] - Start[0] - At.X, Ball.position[1] - Start[1] - At.Y);
    off = hypot(off, Ball.position[2] - Start[2] + At.Up);
    printf("the ball is %.2f cm from where the fingers carry it (the limit is 0.5 cm)\n", off);
    At = glide(At, Closed, 1.5);
    glide(At, Open, 1.0);
    check(sun2xp_close(hand));
    return off < 0.5 ? 0 : 1;
}
