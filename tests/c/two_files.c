/* The main file of a program of two files. Both include Sun2Xp.c. */
#include "Sun2Xp.c"
#include "check.h"

int other_file(float *Pos);

int main(void)
{
    float Pos[3];
    double PosD[3];

    CHECK(OpenHand() == 0);
    CHECK(other_file(Pos) == 0);
    CHECK(GetPos(1, PosD) == 0);
    CHECK(APART(Pos[2], PosD[2]) < 0.02);
    CHECK(CloseHand() == 0);
    return 0;
}
