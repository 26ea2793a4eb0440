/* A planner of 1990 that was extended with calls of sun2xp.h. */
#include <stdio.h>
#include "Sun2Xp.h"
#include "sun2xp.h"

int main(void)
{
    double tip[3] = {0.0, -6.0, 8.0}, pos[3] = {0.0, 0.5, 0.8};
    struct sun2xp_limits limits;
    struct sun2xp_status status;
    struct sun2xp_fault fault;
    struct sun2xp_tip found;
    sun2xp_hand *hand;

    limits.size = sizeof limits;
    status.size = sizeof status;
    fault.size = sizeof fault;
    found.size = sizeof found;
    if (OpenHand() != 0)
        return 1;
    hand = sun2xp_default_hand();
    printf("position %d\n", sun2xp_send_position(hand, 1, pos));
    printf("wait %d\n", sun2xp_wait(hand, 1, SUN2XP_WAIT_ARRIVED, 20.0));
    printf("tip %d\n", sun2xp_send_tip(hand, 1, tip));
    printf("wait %d\n", sun2xp_wait(hand, 1, SUN2XP_WAIT_SETTLED, 20.0));
    printf("read %d", sun2xp_tip(hand, 1, &found));
    printf(" %.1f %.1f %.1f\n", found.position[0], found.position[1], found.position[2]);
    printf("limits %d", sun2xp_limits(hand, 1, &limits));
    printf(" %.4f %.4f %.1f\n", limits.joint_minimum[0], limits.joint_maximum[2], limits.stiffness);
    printf("status %d", sun2xp_status(hand, 1, &status));
    printf(" %d %.0f\n", status.state, status.rate);
    printf("stop %d\n", sun2xp_stop(hand, 1));
    while (sun2xp_fault(hand, 1, &fault) == 0 && fault.number == 0)
        ;
    printf("fault %d, send %d\n", fault.number, SendPos(1, pos));
    printf("recover %d\n", sun2xp_recover(hand, 1));
    printf("send %d\n", SendPos(1, pos));
    printf("null %d, size %d\n", sun2xp_tip(hand, 1, NULL), (limits.size = 3, sun2xp_limits(hand, 1, &limits)));
    printf("close %d\n", sun2xp_close(hand));
    return CloseHand();
}
