/* Settle.c - moves all fingers, and waits until each has come to rest or one has stopped because of a fault. C89. */

#include <stdio.h>
#include "Sun2Xp.h"

enum { LONGEST_WAIT_MS = 5000 };

int main(void)
{
    double Pos[3] = {0.1, 0.6, 1.0};
    struct Event Event;
    int finger, moving = 3;

    if (OpenHand() != 0) {
        fprintf(stderr, "%s\n", HandError());
        return 1;
    }
    for (finger = 1; finger <= 3; finger++)
        SendPos(finger, Pos);
    Event.Size = sizeof Event;
    while (moving > 0 && WaitEvent(&Event, LONGEST_WAIT_MS) == 1) {
        if (Event.Kind == EVENT_SETTLED) {
            printf("finger %d rests at %.3f %.3f %.3f rad, in its cycle %lu\n", Event.Finger, Event.Values[0],
                Event.Values[1], Event.Values[2], Event.Cycle);
            moving--;
        } else if (Event.Kind == EVENT_FAULT) {
            fprintf(stderr, "finger %d: %s\n", Event.Finger, FaultText((int)Event.Values[0]));
            break;
        }
    }
    CloseHand();
    return moving == 0 ? 0 : 1;
}
