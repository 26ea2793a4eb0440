/* Works until Control-C, which the program sends to itself, and then closes the hand. It does so twice. */
#include <signal.h>
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

static volatile sig_atomic_t stop;

static void on_interrupt(int number)
{
    signal(number, on_interrupt);
    stop = 1;
}

int main(void)
{
    double pos[3] = {0.0, 0.6, 0.6};
    int round, count;

    signal(SIGINT, on_interrupt);
    for (round = 0; round < 2; round++) {
        if (OpenHand() != 0) {
            printf("%s\n", HandError());
            return 1;
        }
        for (stop = 0, count = 0; !stop; count++) {
            pos[1] = 0.6 + 0.1 * round;
            if (SendPos(1, pos) != 0)
                return 2;
            if (count == 350)
                kill(getpid(), SIGINT);
            usleep(10000);
        }
        GetPos(1, pos);
        printf("round %d, %d commands: %.2f %.2f %.2f\n", round, count, pos[0], pos[1], pos[2]);
        printf("close %d\n", CloseHand());
    }
    return 0;
}
