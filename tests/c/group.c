/* sun2xp_send_group: all fingers of a group move, and a refused group moves none. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static struct { struct sun2xp_set_point Known; unsigned char Later[32]; } Larger[3];
static double Pos[3] = {0.2, 0.6, 1.1}, Far[3] = {9, 0, 0}, Tip[3] = {1.0, -6.0, 8.0};
static double Kx[9] = {2, 0, 0, 0, 2.5, 0, 0, 0, 1.5};

static void arrive(int finger, const double *Wanted)
{
    double Is[3];
    int tries;

    for (tries = 0; tries < 500; tries++) {
        CHECK(GetPos(finger, Is) == 0);
        if (APART(Is[0], Wanted[0]) + APART(Is[1], Wanted[1]) + APART(Is[2], Wanted[2]) < 0.05)
            return;
        PAUSE_MS(20);
    }
    fprintf(stderr, "finger %d is at %g %g %g\n", finger, Is[0], Is[1], Is[2]);
    exit(1);
}

int main(void)
{
    struct sun2xp_set_point *One = &Larger[0].Known, *Two = &Larger[1].Known, *Three = &Larger[2].Known;
    struct sun2xp_tip Fingertip;
    double Before[3], After[3];
    int tries;

    CHECK(OpenHand() == 0);
    /* The commands have the size that they would have with a later version of the header. */
    One->size = Two->size = Three->size = sizeof Larger[0];
    One->finger = 3;
    One->position = Pos;
    One->stiffness = Kx;
    One->damping = 1.1;
    Two->finger = 1;
    Two->position = Far;
    Three->finger = 2;
    Three->tip = Tip;
    CHECK(sun2xp_send_group(HAND, 0, One) == 0 && sun2xp_send_group(HAND, 0, NULL) == 0);
    REFUSED(sun2xp_send_group(HAND, 1, NULL), EFAULT, "set_points");
    CHECK(GetPos(3, Before) == 0);
    REFUSED(sun2xp_send_group(HAND, 3, One), ERANGE, "limits");
    REFUSED(sun2xp_send_group(HAND, 4, One), EINVAL, "0 to 3 commands, and not 4: send at most one command");
    REFUSED(sun2xp_send_group(HAND, -1, One), EINVAL, "-1");
    PAUSE_MS(300);
    CHECK(GetPos(3, After) == 0);
    CHECK(APART(Before[0], After[0]) + APART(Before[1], After[1]) + APART(Before[2], After[2]) < 0.01);
    Two->position = Pos;
    CHECK(sun2xp_send_group(HAND, 3, One) == 0);
    arrive(1, Pos);
    arrive(3, Pos);
    Fingertip.size = sizeof Fingertip;
    for (tries = 0; ; tries++) {
        CHECK(sun2xp_tip(HAND, 2, &Fingertip) == 0);
        if (APART(Fingertip.position[0], 1.0) + APART(Fingertip.position[1], -6.0) + APART(Fingertip.position[2],
                8.0) < 0.3)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    CHECK(sun2xp_tip(HAND, 3, &Fingertip) == 0);
    CHECK(APART(Fingertip.stiffness[1][1], 2.5) < 0.01);
    REFUSED(sun2xp_send_damping(HAND, 3, 99), ERANGE, "99");
    CHECK(CloseHand() == 0);
    return 0;
}
