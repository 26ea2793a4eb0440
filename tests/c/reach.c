/* A planner with arrays of REAL, in the common subset of C89 to C23: every finger reaches its pose. */
#include "Sun2Xp.h"
#include "check.h"

#ifndef REAL
#define REAL float
#endif

static const REAL targets[3][3] = {{0.15, 0.5, 0.9}, {-0.2, 0.4, 0.8}, {0.0, 0.7, 1.2}};

/* Waits until the finger is at rest: no joint moves by more than a milliradian in 200 ms. Gives up after 10 s. */
static void rest(int finger, REAL *Pos)
{
    REAL before[3];
    int tries, joint, moving = 1;

    CHECK(GetPos(finger, before) == 0);
    for (tries = 0; moving && tries < 50; tries++) {
        PAUSE_MS(200);
        CHECK(GetPos(finger, Pos) == 0);
        moving = 0;
        for (joint = 0; joint < 3; joint++) {
            if (APART(Pos[joint], before[joint]) > 1e-3)
                moving = 1;
            before[joint] = Pos[joint];
        }
    }
    CHECK(!moving);
}

int main(void)
{
    REAL Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    const REAL ConstKx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    REAL FlatKx[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
    REAL Pos[3];
    const REAL *Target = targets[2];
    int finger, joint;

    CHECK(OpenHand() == 0);
    CHECK(SendKx(1, Kx) == 0);
    CHECK(SendKx(2, ConstKx) == 0);
    CHECK(SendKx(3, FlatKx) == 0);
    CHECK(SendKx(3, &FlatKx[0]) == 0);
    CHECK(SendKx(3, &FlatKx) == 0);
    CHECK(SendKx(1, &Kx) == 0);
    CHECK(SendPos(1, targets[0]) == 0);
    CHECK(SendPos(2, targets[1]) == 0);
    CHECK(SendPos(3, Target) == 0);
    for (finger = 1; finger <= 3; finger++) {
        rest(finger, Pos);
        for (joint = 0; joint < 3; joint++) {
            printf("finger %d joint %d: sent %.4f, is %.4f rad\n", finger, joint, targets[finger - 1][joint],
                   Pos[joint]);
            CHECK(APART(Pos[joint], targets[finger - 1][joint]) < 0.02);
        }
    }
    CHECK(CloseHand() == 0);
    return 0;
}
