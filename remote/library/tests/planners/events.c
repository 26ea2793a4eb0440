/* Waits for the events of a motion, and stops the hand from a signal handler. */
#include <signal.h>
#include <stdio.h>
#include <unistd.h>
#include "sun2xp.h"

static void on_signal(int number)
{
    (void)number;
    sun2xp_stop_all();
}

static int waits_for(sun2xp_hand *hand, int kind)
{
    struct sun2xp_event event;
    int tries;

    event.size = sizeof event;
    for (tries = 0; tries < 1000 && sun2xp_wait_event(hand, &event, 20.0) == 1; tries++)
        if (event.finger == 1 && event.kind == kind)
            return 1;
    return 0;
}

int main(void)
{
    double position[3] = {0.0, 0.7, 0.9};
    struct sun2xp_fault fault;
    sun2xp_hand *hand;

    if (sun2xp_open(NULL, &hand) != 0)
        return 1;
    sun2xp_send_position(hand, 1, position);
    printf("arrived %d\n", waits_for(hand, SUN2XP_EVENT_ARRIVED));
    signal(SIGUSR1, on_signal);
    raise(SIGUSR1);
    printf("fault %d\n", waits_for(hand, SUN2XP_EVENT_FAULT));
    fault.size = sizeof fault;
    do
        usleep(1000);
    while (sun2xp_fault(hand, 1, &fault) == 0 && fault.number == 0);
    printf("refused %d\n", sun2xp_send_position(hand, 1, position));
    printf("recovered %d\n", sun2xp_recover(hand, SUN2XP_ALL_FINGERS));
    printf("sent %d\n", sun2xp_send_position(hand, 1, position));
    return sun2xp_close(hand);
}
