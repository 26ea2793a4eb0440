/* A timer interrupts the planner hundreds of times a second. Its handler counts the ticks, which determine the next
   command. */
#include <signal.h>
#include <stdio.h>
#include <sys/time.h>
#include <unistd.h>
#include "Sun2Xp.h"

static volatile sig_atomic_t ticks;

static void tick(int number)
{
    (void)number;
    ticks++;
}

int main(void)
{
    struct sigaction action;
    struct itimerval timer = {{0, 3000}, {0, 3000}}, none = {{0, 0}, {0, 0}};
    double pos[3] = {0.0, 0.4, 0.6}, here[3];
    int refused = 0;

    action.sa_handler = tick;
    action.sa_flags = 0;
    sigemptyset(&action.sa_mask);
    sigaction(SIGALRM, &action, 0);
    setitimer(ITIMER_REAL, &timer, 0);
    printf("open %d\n", OpenHand());
    ticks = 0;
    while (ticks < 900) {
        pos[1] = 0.4 + 0.5 * (ticks < 400 ? ticks / 400.0 : 1.0);
        refused += SendPos(1, pos) != 0;
        pause();
    }
    GetPos(1, here);
    setitimer(ITIMER_REAL, &none, 0);
    printf("refused %d, at %.2f %.2f %.2f\n", refused, here[0], here[1], here[2]);
    printf("close %d\n", CloseHand());
    return 0;
}
