/* This planner is suspended by SIGSTOP for so long that it loses the hand. Then it recovers one finger, and later all
   of them. */
#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>
#include "sun2xp.h"

static sun2xp_hand *hand;

/* Returns the number of the finger's fault. On a busy machine, the newest cycle that has arrived may be too old. Then
   sun2xp_fault fails, so it is repeated. */
static int fault(int finger)
{
    struct sun2xp_fault fault;
    int tries;

    fault.size = sizeof fault;
    for (tries = 0; tries < 2000; tries++) {
        if (sun2xp_fault(hand, finger, &fault) == 0)
            return fault.number;
        usleep(1000);
    }
    return -1;
}

static int recovers(int finger)
{
    int tries, last = finger == SUN2XP_ALL_FINGERS ? 3 : finger;

    for (tries = 0; tries < 100 && sun2xp_recover(hand, finger) != 0; tries++)
        usleep(100000);
    for (tries = 0; tries < 2000 && fault(last) != 0; tries++)
        usleep(1000);
    return fault(last) == 0;
}

int main(void)
{
    double position[3] = {0.0, 0.5, 0.8};
    pid_t planner = getpid(), child;
    int tries;

    if (sun2xp_open(NULL, &hand) != 0)
        return 1;
    printf("stop %d\n", sun2xp_stop(hand, 2));
    child = fork();
    if (child == 0) {
        kill(planner, SIGSTOP);
        sleep(3);
        kill(planner, SIGCONT);
        _exit(0);
    }
    waitpid(child, NULL, 0);
    for (tries = 0; tries < 5000 && sun2xp_send_position(hand, 3, position) == 0; tries++)
        usleep(1000);
    printf("recovered %d,", recovers(1));
    printf(" stopped %d %d\n", fault(2) > 0, fault(3) > 0);
    printf("recovered %d,", recovers(SUN2XP_ALL_FINGERS));
    printf(" stopped %d %d\n", fault(2) > 0, fault(3) > 0);
    return sun2xp_close(hand);
}
