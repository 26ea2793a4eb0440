/* sun2xp_send_path: a finger follows a path to its end, and a refused path moves nothing. sun2xp_send_position_for: the
   angles expire. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static struct { struct sun2xp_path_pose Known; unsigned char Later[32]; } Larger[2];
static double Kx[9] = {2, 0, 0, 0, 2.5, 0, 0, 0, 1.5}, Target[3] = {0.2, 0.6, 1.1}, Tip[3] = {1.0, -6.0, 8.0};

static double away(int finger, const double *Wanted)
{
    double Is[3];

    CHECK(GetPos(finger, Is) == 0);
    return APART(Is[0], Wanted[0]) + APART(Is[1], Wanted[1]) + APART(Is[2], Wanted[2]);
}

static void arrive(int finger, const double *Wanted)
{
    int tries;

    for (tries = 0; away(finger, Wanted) > 0.05; tries++) {
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
}

static double distance(const double *One, const double *Other)
{
    return APART(One[0], Other[0]) + APART(One[1], Other[1]) + APART(One[2], Other[2]);
}

int main(void)
{
    struct sun2xp_path_pose *First = &Larger[0].Known, *Second = &Larger[1].Known;
    struct sun2xp_tip Fingertip;
    double Before[3];
    int tries;

    CHECK(OpenHand() == 0);
    /* A planner for a later version of the library may send larger poses. */
    First->size = Second->size = sizeof Larger[0];
    CHECK(GetPos(1, Before) == 0);
    First->time = 0.02;
    Second->time = 0.05;
    memcpy(First->place, Before, sizeof Before);
    memcpy(Second->place, Target, sizeof Target);
    REFUSED(sun2xp_send_path(HAND, 1, 2, First, 0), ERANGE, "multiply all times by");
    REFUSED(sun2xp_send_path(HAND, 1, 0, First, 0), EINVAL, "0 poses");
    REFUSED(sun2xp_send_path(HAND, 1, -1, First, 0), EINVAL, "has -1 poses: send 1 to 128");
    PAUSE_MS(300);
    CHECK(away(1, Before) < 0.02);
    First->time = 0.5;
    Second->time = 1.0;
    Second->stiffness = Kx;
    CHECK(sun2xp_send_path(HAND, 1, 2, First, 0) == 0);
    arrive(1, Target);
    Fingertip.size = sizeof Fingertip;
    for (tries = 0; ; tries++) {
        CHECK(sun2xp_tip(HAND, 1, &Fingertip) == 0);
        if (APART(Fingertip.stiffness[1][1], 2.5) < 0.01)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    First->is_tip = 1;
    memcpy(First->place, Tip, sizeof Tip);
    First->time = 2.0;
    CHECK(sun2xp_send_path(HAND, 2, 1, First, 0) == 0);
    CHECK(sun2xp_send_position_for(HAND, 1, Before, 60.0) == 0);
    arrive(1, Before);
    for (tries = 0; ; tries++) {
        CHECK(sun2xp_tip(HAND, 2, &Fingertip) == 0);
        if (distance(Fingertip.position, Tip) < 0.3)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    /* The finger has no time to arrive. When the angles expire, the finger holds its current pose with 1 N/cm. */
    CHECK(sun2xp_send_position_for(HAND, 1, Target, 0.05) == 0);
    for (tries = 0; ; tries++) {
        CHECK(sun2xp_tip(HAND, 1, &Fingertip) == 0);
        if (APART(Fingertip.stiffness[1][1], 1.0) < 0.01)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    PAUSE_MS(300);
    CHECK(away(1, Target) > 0.05);
    CHECK(CloseHand() == 0);
    return 0;
}
