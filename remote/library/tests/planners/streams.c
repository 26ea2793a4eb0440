/* Computes a trajectory and sends it at 100 Hz; then waits at its end. */
#define _USE_MATH_DEFINES
#include <math.h>
#include <stdio.h>
#include <time.h>
#include "Sun2Xp.h"

int main(void)
{
    const struct timespec period = {0, 10000000};
    double pos[3], kx[9] = {5, 0, 0, 0, 5, 0, 0, 0, 5};
    int i, refused = 0;

    if (OpenHand() != 0)
        return 1;
    refused += SendKx(1, kx) != 0;
    for (i = 0; i <= 300; i++) {
        double s = 0.5 - 0.5 * cos(3.14159265 * 3 * i / 300);
        pos[0] = 0.3 * s, pos[1] = 0.4 + 0.5 * s, pos[2] = 0.6 + 0.4 * s;
        refused += SendPos(1, pos) != 0;
        nanosleep(&period, 0);
    }
    for (i = 0; i < 300; i++)
        nanosleep(&period, 0);
    refused += GetPos(1, pos) != 0;
    printf("refused %d, end %.2f %.2f %.2f\n", refused, pos[0], pos[1], pos[2]);
    return CloseHand();
}
