/* Settle.c - moves all fingers, and waits until each has come to rest or one has stopped because of a fault. C89. */

#include <stdio.h>
#include "sun2xp.h"

#define LONGEST_WAIT 5.0                /* s */

int main(void)
{
    double Pos[3] = {0.1, 0.6, 1.0};
    struct sun2xp_event Event;
    sun2xp_hand *hand;
    int finger, taken, moving = 3;

    if (sun2xp_open(NULL, &hand) != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        return 1;
    }
    for (finger = 1; finger <= 3; finger++)
        if (sun2xp_send_position(hand, finger, Pos) != 0) {
            fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
            return 1;
        }
    Event.size = sizeof Event;
    while (moving > 0) {
        taken = sun2xp_wait_event(hand, &Event, LONGEST_WAIT);
        if (taken != 1) {
            fprintf(stderr, "%s\n", taken < 0 ? sun2xp_error_text(NULL)
                : "a finger has not come to rest in time: run this on a less busy machine, or raise LONGEST_WAIT");
            break;
        }
        if (Event.kind == SUN2XP_EVENT_SETTLED) {
            printf("finger %d rests at %.3f %.3f %.3f rad, in its cycle %lu\n", Event.finger, Event.values[0],
                Event.values[1], Event.values[2], Event.cycle);
            moving--;
        } else if (Event.kind == SUN2XP_EVENT_FAULT) {
            fprintf(stderr, "finger %d: %s\n", Event.finger, sun2xp_fault_text((int)Event.values[0]));
            break;
        }
    }
    sun2xp_close(hand);
    return moving == 0 ? 0 : 1;
}
