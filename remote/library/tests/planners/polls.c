/* Sends three goals. After each one, polls the position until the finger has reached it. All arrays are of double. */
#include <math.h>
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

static int near(double *a, double *b)
{
    int k;
    for (k = 0; k < 3; k++)
        if (fabs(a[k] - b[k]) > 0.02)
            return 0;
    return 1;
}

int main(void)
{
    static double goals[3][3] = {{0.0, 0.5, 0.8}, {-0.2, 0.9, 1.2}, {0.2, 0.3, 0.6}};
    double here[3];
    int goal, tries;

    if (OpenHand() != 0)
        return 1;
    for (goal = 0; goal < 3; goal++) {
        printf("send %d\n", SendPos(2, goals[goal]));
        for (tries = 0; tries < 1000; tries++) {
            if (GetPos(2, here) != 0)
                return 2;
            if (near(here, goals[goal]))
                break;
            usleep(20000);
        }
        printf("goal %d %s\n", goal, tries < 1000 ? "reached" : "missed");
    }
    printf("close %d\n", CloseHand());
    return 0;
}
