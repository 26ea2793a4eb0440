/* Path.c - moves a fingertip along a circle of 1 cm radius, one turn a second, and prints the distance of the tip from
   the circle. The program is C89 with functions of POSIX. */

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "sun2xp.h"

#define FINGER 1
#define RADIUS 1.0                      /* cm */
#define TURNS 3.0                       /* number of turns; at full speed, a turn takes 1 s */
#define RAMP 0.5                        /* time in which the speed rises, and time in which it falls, s */
#define POSES 70
#define PI 3.14159265358979323846

static const double Start[3] = {0.2, 0.6, 1.1};                                    /* rad */

/* Returns the number of turns that the tip makes in the given time, s, while its speed rises from 0. */
static double ramp(double seconds)
{
    return 0.5 * (seconds - sin(PI * seconds / RAMP) * RAMP / PI);
}

/* Returns the number of turns that the tip has made at the given time, s. The motion begins and ends at rest. */
static double turns(double seconds)
{
    double duration = TURNS + RAMP;

    if (seconds < RAMP)
        return ramp(seconds);
    if (seconds > duration - RAMP)
        return TURNS - ramp(duration - seconds);
    return seconds - 0.5 * RAMP;
}

int main(void)
{
    static struct sun2xp_path_pose poses[POSES];
    struct sun2xp_tip tip;
    sun2xp_hand *hand;
    double centre[3], angle, off, worst = 0.0;
    int pose, step;

    tip.size = sizeof tip;
    if (sun2xp_open(NULL, &hand) != 0 || sun2xp_send_position(hand, FINGER, Start) != 0
        || sun2xp_wait(hand, FINGER, SUN2XP_WAIT_SETTLED, 10.0) != 0 || sun2xp_tip(hand, FINGER, &tip) != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        return 1;
    }
    memcpy(centre, tip.position, sizeof centre);
    centre[0] -= RADIUS;
    for (pose = 0; pose < POSES; pose++) {
        poses[pose].size = sizeof poses[pose];
        poses[pose].is_tip = 1;
        poses[pose].time = (TURNS + RAMP) * (pose + 1) / POSES;
        angle = 2.0 * PI * turns(poses[pose].time);
        poses[pose].place[0] = centre[0] + RADIUS * cos(angle);
        poses[pose].place[1] = centre[1] + RADIUS * sin(angle);
        poses[pose].place[2] = centre[2];
    }
    if (sun2xp_send_path(hand, FINGER, POSES, poses, 0.0) != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        return 1;
    }
    for (step = 0; step < 38; step++) {
        usleep(100000);
        if (sun2xp_tip(hand, FINGER, &tip) != 0) {
            fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
            return 1;
        }
        off = hypot(tip.position[0] - centre[0], tip.position[1] - centre[1]) - RADIUS;
        off = hypot(off, tip.position[2] - centre[2]);
        if (off > worst)
            worst = off;
        printf("%4.1f s  %7.3f %7.3f cm, %.2f mm from the circle\n", 0.1 * (step + 1), tip.position[0] - centre[0],
               tip.position[1] - centre[1], 10.0 * off);
    }
    sun2xp_close(hand);
    printf("at most %.2f mm from the circle\n", 10.0 * worst);
    return worst < 0.05 ? 0 : 1;
}
