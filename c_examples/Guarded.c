/* Guarded.c - a guarded move: a finger bends until its tip touches something, and stays there.

   A reflex in the servo ends the motion. It reacts within two cycles of the servo, so it does not matter how slow this
   program is. The exit status is 0 if the reflex has fired and the tip presses only lightly. C89. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "Sun2Xp.h"

#define FINGER 1
#define PATIENCE 10000                  /* ms */

static double Open[3] = {0.0, 0.4, 0.8}, Bent[3] = {0.0, 0.9, 0.8};                         /* rad */

static int checked(int result)
{
    if (result < 0) {
        fprintf(stderr, "%s\n", HandError());
        exit(1);
    }
    return result;
}

/* Waits for an event of this kind. Returns 1 if it has come, and 0 after the time limit. */
static int wait_for(int kind)
{
    struct Event Event;

    memset(&Event, 0, sizeof Event);
    Event.Size = sizeof Event;
    while (checked(WaitEvent(&Event, PATIENCE)) == 1)
        if (Event.Kind == kind && Event.Finger == FINGER)
            return 1;
    return 0;
}

int main(void)
{
    struct Reflex Guard;
    struct FingerTip Tip;
    double Pressed;
    int fired;

    checked(OpenHand());
    checked(SendPos(FINGER, Open));
    wait_for(EVENT_SETTLED);

    memset(&Guard, 0, sizeof Guard);
    Guard.Size = sizeof Guard;
    Guard.Condition = WHEN_FORCE_ABOVE;
    Guard.Bound = 0.4;                                                                  /* N */
    Guard.Reaction = THEN_HOLD;
    checked(InstallReflex(FINGER, &Guard));

    checked(SendPos(FINGER, Bent));
    fired = wait_for(EVENT_REFLEX_FIRED);
    wait_for(EVENT_SETTLED);
    Tip.Size = sizeof Tip;
    checked(GetTip(FINGER, &Tip));
    Pressed = sqrt(Tip.Force[0] * Tip.Force[0] + Tip.Force[1] * Tip.Force[1] + Tip.Force[2] * Tip.Force[2]);
    printf("%s: the tip is at %.2f %.2f %.2f cm and presses with %.2f N\n", fired ? "contact" : "no contact",
           Tip.Tip[0], Tip.Tip[1], Tip.Tip[2], Pressed);
    CloseHand();
    return fired && Pressed < 1.5 ? 0 : 1;
}
