/* A planner that packs its structs and has macros named like keywords of C. Its calls must be served all the same. */
#include <string.h>
#include <unistd.h>
#include "check.h"
#pragma pack(1)
#include "sun2xp.h"
#define const
#define volatile
#define int long
#define unsigned
#define float double
#include "Sun2Xp.h"

struct packed { char Byte; float Number; };

static float far_from(const float *Pos, const float *Wanted)
{
    return APART(Pos[0], Wanted[0]) + APART(Pos[1], Wanted[1]) + APART(Pos[2], Wanted[2]);
}

#undef int

int main(void)
{
    const float Wanted[3] = {0.1, 0.5, 0.9};
    volatile float Now[3] = {0, 0, 0};
    struct sun2xp_status Status;
    int tries;

    CHECK(sizeof(struct packed) == 1 + sizeof(double));
    CHECK(OpenHand() == 0);
    CHECK(SendPos(1, Wanted) == 0);
    for (tries = 0; tries < 300; tries++) {
        CHECK(GetPos(1, Now) == 0);
        if (far_from(Now, Wanted) < 0.06)
            break;
        PAUSE_MS(20);
    }
    CHECK(tries < 300);
    memset(&Status, 0, sizeof Status);
    Status.size = sizeof Status;
    CHECK(sun2xp_status(HAND, 1, &Status) == 0);
    CHECK(Status.size == sizeof Status && Status.state == SUN2XP_STATE_RUNNING);
    CHECK(Status.rate == 1000.0 && Status.cycles > 100);
    CHECK(Status.stiffness_scale > 0.0 && Status.stiffness_scale <= 1.0);
    return CloseHand();
}
