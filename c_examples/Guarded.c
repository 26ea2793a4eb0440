/* Guarded.c - a guarded move: a finger bends until its tip touches something, and stays there.

   A reflex in the servo ends the motion. The reflex reacts within two cycles of the servo, however slow this program
   is. The exit status is 0 if the reflex has fired and the tip presses only lightly. C89. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "sun2xp.h"

#define FINGER 1
#define PATIENCE 10.0                   /* s */

static sun2xp_hand *hand;
static double Open[3] = {0.0, 0.4, 0.8}, Bent[3] = {0.0, 0.9, 0.8};                         /* rad */

static int checked(int result)
{
    if (result < 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        exit(1);
    }
    return result;
}

/* Waits until the finger has an event of this kind. Returns 1 if the event has occurred, and 0 if no event of any kind
   occurs for the time PATIENCE. */
static int wait_for(int kind)
{
    struct sun2xp_event Event;

    memset(&Event, 0, sizeof Event);
    Event.size = sizeof Event;
    while (checked(sun2xp_wait_event(hand, &Event, PATIENCE)) == 1)
        if (Event.kind == kind && Event.finger == FINGER)
            return 1;
    return 0;
}

int main(void)
{
    struct sun2xp_reflex Guard;
    struct sun2xp_tip Tip;
    double Pressed;
    int fired;

    checked(sun2xp_open(NULL, &hand));
    checked(sun2xp_send_position(hand, FINGER, Open));
    wait_for(SUN2XP_EVENT_SETTLED);

    memset(&Guard, 0, sizeof Guard);
    Guard.size = sizeof Guard;
    Guard.condition = SUN2XP_WHEN_FORCE_ABOVE;
    Guard.bound = 0.4;                                                                  /* N */
    Guard.reaction = SUN2XP_THEN_HOLD;
    checked(sun2xp_install_reflex(hand, FINGER, &Guard));

    checked(sun2xp_send_position(hand, FINGER, Bent));
    fired = wait_for(SUN2XP_EVENT_REFLEX_FIRED);
    wait_for(SUN2XP_EVENT_SETTLED);
    Tip.size = sizeof Tip;
    checked(sun2xp_tip(hand, FINGER, &Tip));
    Pressed = sqrt(Tip.force[0] * Tip.force[0] + Tip.force[1] * Tip.force[1] + Tip.force[2] * Tip.force[2]);
    printf("%s: the tip is at %.2f %.2f %.2f cm and presses with %.2f N\n", fired ? "contact" : "no contact",
           Tip.position[0], Tip.position[1], Tip.position[2], Pressed);
    sun2xp_close(hand);
    return fired && Pressed < 1.5 ? 0 : 1;
}
