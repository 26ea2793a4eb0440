/* Push.c - measures the stiffness of a fingertip. It pushes a fingertip of the simulated hand to and fro along each
   axis, and prints the measured stiffness beside the commanded one. Friction in the joints makes a finger that is
   pushed from rest feel a little stiffer than it is. The program works with the simulated hand only, because
   sun2xp_push simulates the push. C89. */

#include <math.h>
#include <stdio.h>
#include <unistd.h>
#include "sun2xp.h"

#define FINGER 1
#define FORCE 0.6                       /* N; moves the tip by 2 mm at 3 N/cm */

static sun2xp_hand *hand;
static const double Links[3] = {3.556, 5.080, 4.000};                              /* cm */
static const double Pos[3] = {0.1, 0.5, 0.9};                                      /* rad */
static const double Kx[3][3] = {{3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {0.0, 0.0, 3.0}};  /* N/cm */

/* Waits for the finger to come to rest, and computes where its tip is, cm, in the finger's frame. */
static int rest(double *tip)
{
    double before[3], now[3], reach, moved;
    int tries;

    if (sun2xp_position(hand, FINGER, now) != 0)
        return -1;
    for (tries = 0; tries < 8; tries++) {
        before[0] = now[0];
        before[1] = now[1];
        before[2] = now[2];
        sleep(1);
        if (sun2xp_position(hand, FINGER, now) != 0)
            return -1;
        moved = fabs(now[0] - before[0]) + fabs(now[1] - before[1]) + fabs(now[2] - before[2]);
        if (moved < 1e-3)
            break;
    }
    reach = Links[0] + Links[1] * cos(now[1]) + Links[2] * cos(now[1] + now[2]);
    tip[0] = reach * sin(now[0]);
    tip[1] = -Links[1] * sin(now[1]) - Links[2] * sin(now[1] + now[2]);
    tip[2] = reach * cos(now[0]);
    return 0;
}

/* Pushes with the given force, N, along one axis, and computes where the tip comes to rest. */
static int push(int axis, double newton, double *tip)
{
    double force[3] = {0.0, 0.0, 0.0};

    force[axis] = newton;
    return sun2xp_push(hand, FINGER, force) != 0 ? -1 : rest(tip);
}

int main(void)
{
    double there[3], back[3], stiffness;
    int axis, springs = 0;

    if (sun2xp_open(NULL, &hand) != 0 || sun2xp_send_stiffness(hand, FINGER, &Kx[0][0]) != 0
        || sun2xp_send_position(hand, FINGER, Pos) != 0 || rest(there) != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        return 1;
    }
    printf("axis   commanded   measured, N/cm\n");
    for (axis = 0; axis < 3; axis++) {
        if (push(axis, FORCE, there) != 0 || push(axis, -FORCE, back) != 0) {
            fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
            return 1;
        }
        stiffness = 2.0 * FORCE / (there[axis] - back[axis]);
        printf("%c       %8.2f   %8.2f\n", "xyz"[axis], Kx[axis][axis], stiffness);
        springs += stiffness > 0.5 * Kx[axis][axis] && stiffness < 2.0 * Kx[axis][axis];
    }
    sun2xp_close(hand);
    return springs == 3 ? 0 : 1;
}
