/* Path.c - moves a fingertip along a circle of 1 cm radius, one turn a second, and prints how far it is from the
   circle. C89. */

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"

#define FINGER 1
#define RADIUS 1.0                      /* cm */
#define TURNS 3.0                       /* one turn a second */
#define RAMP 0.5                        /* s in which the speed rises and falls */
#define POSES 70
#define PI 3.14159265358979323846

static const double Start[3] = {0.2, 0.6, 1.1};                                    /* rad */

/* How many turns the finger has made after some seconds of a ramp. */
static double ramp(double seconds)
{
    return 0.5 * (seconds - sin(PI * seconds / RAMP) * RAMP / PI);
}

/* How many turns the finger has made, from rest to rest. */
static double turns(double seconds)
{
    double length = TURNS + RAMP;

    if (seconds < RAMP)
        return ramp(seconds);
    if (seconds > length - RAMP)
        return TURNS - ramp(length - seconds);
    return seconds - 0.5 * RAMP;
}

int main(void)
{
    static struct PathPose poses[POSES];
    struct FingerTip tip;
    double centre[3], angle, off, worst = 0.0;
    int pose, step;

    tip.Size = sizeof tip;
    if (OpenHand() != 0 || SendPosD(FINGER, Start) != 0 || sleep(3) != 0 || GetTip(FINGER, &tip) != 0) {
        fprintf(stderr, "%s\n", HandError());
        return 1;
    }
    memcpy(centre, tip.Tip, sizeof centre);
    centre[0] -= RADIUS;
    for (pose = 0; pose < POSES; pose++) {
        poses[pose].Size = sizeof poses[pose];
        poses[pose].IsTip = 1;
        poses[pose].Time = (TURNS + RAMP) * (pose + 1) / POSES;
        angle = 2.0 * PI * turns(poses[pose].Time);
        poses[pose].Place[0] = centre[0] + RADIUS * cos(angle);
        poses[pose].Place[1] = centre[1] + RADIUS * sin(angle);
        poses[pose].Place[2] = centre[2];
    }
    if (SendPath(FINGER, POSES, poses, 0.0) != 0) {
        fprintf(stderr, "%s\n", HandError());
        return 1;
    }
    for (step = 0; step < 38; step++) {
        usleep(100000);
        if (GetTip(FINGER, &tip) != 0) {
            fprintf(stderr, "%s\n", HandError());
            return 1;
        }
        off = hypot(hypot(tip.Tip[0] - centre[0], tip.Tip[1] - centre[1]) - RADIUS, tip.Tip[2] - centre[2]);
        if (off > worst)
            worst = off;
        printf("%4.1f s  %7.3f %7.3f cm, %.2f mm from the circle\n", 0.1 * (step + 1), tip.Tip[0] - centre[0],
               tip.Tip[1] - centre[1], 10.0 * off);
    }
    CloseHand();
    printf("at most %.2f mm from the circle\n", 10.0 * worst);
    return worst < 0.05 ? 0 : 1;
}
