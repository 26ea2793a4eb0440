/* Leaves nested functions by longjmp as soon as a call is refused, and tries the next plan. */
#include <setjmp.h>
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

static jmp_buf retry;

static void must(int result)
{
    if (result != 0)
        longjmp(retry, 1);
}

static void step(int depth, double *pos)
{
    if (depth > 0)
        step(depth - 1, pos);
    else
        must(SendPos(2, pos));
}

int main(void)
{
    static double plans[4][3] = {{9.0, 0.0, 0.5}, {0.0, -9.0, 0.5}, {0.0, 0.5, 9.0}, {0.15, 0.55, 0.95}};
    static volatile int plan = -1;
    double here[3];

    if (OpenHand() != 0)
        return 1;
    if (setjmp(retry) != 0)
        printf("plan %d refused: %s\n", plan, HandError());
    if (++plan < 4) {
        step(5, plans[plan]);
        printf("plan %d sent\n", plan);
    }
    sleep(4);
    must(GetPos(2, here));
    printf("%.2f %.2f %.2f\n", here[0], here[1], here[2]);
    return CloseHand();
}
