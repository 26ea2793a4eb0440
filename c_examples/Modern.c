/* Modern.c - a planner in C17: double arrays, every result checked, a smooth reach instead of a jump. */

#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "Sun2Xp.h"

enum { FINGER = 2, STEPS = 100, STEP_MS = 10, REST_MS = 2000 };

/* Reports why the last call was refused, closes the hand and ends the program. */
static _Noreturn void give_up(const char *doing)
{
    fprintf(stderr, "while %s: %s\n", doing, HandError());
    CloseHand();
    exit(EXIT_FAILURE);
}

static void pause_ms(long milliseconds)
{
    const struct timespec span = {.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1000000};
    nanosleep(&span, NULL);
}

/* Moves a finger along a minimum-jerk path of STEPS steps. */
static void reach(int finger, const double to[3])
{
    double from[3];
    if (GetPos(finger, from) != 0)
        give_up("reading the start");
    for (int step = 1; step <= STEPS; step++) {
        const double s = (double)step / STEPS;
        const double part = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        double at[3];
        for (int joint = 0; joint < 3; joint++)
            at[joint] = from[joint] + part * (to[joint] - from[joint]);
        if (SendPos(finger, at) != 0)
            give_up("moving the finger");
        pause_ms(STEP_MS);
    }
}

int main(void)
{
    if (OpenHand() != 0)
        give_up("opening the hand");

    const double soft_along_z[3][3] = {{4, 0, 0}, {0, 4, 0}, {0, 0, 2}};
    if (SendKx(FINGER, soft_along_z) != 0)
        give_up("setting the stiffness");

    /* A pose beyond the joint limits is refused. The set point stays as it was, and the program continues. */
    if (SendPos(FINGER, (double[]){0.0, 0.0, 3.0}) == 0) {
        fprintf(stderr, "a pose beyond the joint limits was accepted: set hand.out_of_range = \"refuse\"\n");
        CloseHand();
        return EXIT_FAILURE;
    }
    if (errno != ERANGE)
        give_up("expecting a refusal with ERANGE");
    printf("as expected: %s\n", HandError());

    const double target[3] = {0.2, 0.6, 1.0};
    reach(FINGER, target);
    pause_ms(REST_MS);

    double now[3];
    if (GetPos(FINGER, now) != 0)
        give_up("reading the end");
    double worst = 0.0;
    for (int joint = 0; joint < 3; joint++)
        worst = fmax(worst, fabs(now[joint] - target[joint]));
    printf("finger %d is at %.4f %.4f %.4f rad, at most %.4f rad off\n", FINGER, now[0], now[1], now[2], worst);

    if (CloseHand() != 0)
        give_up("closing the hand");
    return worst < 0.02 ? EXIT_SUCCESS : EXIT_FAILURE;
}
