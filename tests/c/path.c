/* SendPath: a path is followed as a whole, and a refused path moves nothing. SendPosFor: the angles expire. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

static struct { struct PathPose Known; unsigned char Later[32]; } Larger[2];
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

int main(void)
{
    struct PathPose *First = &Larger[0].Known, *Second = &Larger[1].Known;
    struct FingerTip Fingertip;
    double Before[3];
    int tries;

    CHECK(OpenHand() == 0);
    /* The poses of a later version are larger. */
    First->Size = Second->Size = sizeof Larger[0];
    CHECK(GetPos(1, Before) == 0);
    First->Time = 0.02;
    Second->Time = 0.05;
    memcpy(First->Place, Before, sizeof Before);
    memcpy(Second->Place, Target, sizeof Target);
    REFUSED(SendPath(1, 2, First, 0), ERANGE, "multiply all times by");
    REFUSED(SendPath(1, 0, First, 0), EINVAL, "0 poses");
    REFUSED(SendPath(1, -1, First, 0), EINVAL, "1 to 128");
    PAUSE_MS(300);
    CHECK(away(1, Before) < 0.02);
    First->Time = 0.5;
    Second->Time = 1.0;
    Second->Kx = Kx;
    CHECK(SendPath(1, 2, First, 0) == 0);
    arrive(1, Target);
    Fingertip.Size = sizeof Fingertip;
    for (tries = 0; ; tries++) {
        CHECK(GetTip(1, &Fingertip) == 0);
        if (APART(Fingertip.Stiffness[1][1], 2.5) < 0.01)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    First->IsTip = 1;
    memcpy(First->Place, Tip, sizeof Tip);
    First->Time = 2.0;
    CHECK(SendPath(2, 1, First, 0) == 0);
    CHECK(SendPosFor(1, Before, 60000.0) == 0);
    arrive(1, Before);
    for (tries = 0; ; tries++) {
        CHECK(GetTip(2, &Fingertip) == 0);
        if (APART(Fingertip.Tip[0], Tip[0]) + APART(Fingertip.Tip[1], Tip[1]) + APART(Fingertip.Tip[2], Tip[2]) < 0.3)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    /* The finger has no time to arrive, and holds the pose that it has reached with 1 N/cm. */
    CHECK(SendPosFor(1, Target, 50.0) == 0);
    for (tries = 0; ; tries++) {
        CHECK(GetTip(1, &Fingertip) == 0);
        if (APART(Fingertip.Stiffness[1][1], 1.0) < 0.01)
            break;
        CHECK(tries < 500);
        PAUSE_MS(20);
    }
    PAUSE_MS(300);
    CHECK(away(1, Target) > 0.05);
    CHECK(CloseHand() == 0);
    return 0;
}
