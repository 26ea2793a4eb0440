/* Without a hand, the calls for a finger are refused with ENODEV, or with EFAULT if a pointer is null. CloseHand has
   nothing to do, and succeeds. The hand can be opened and closed repeatedly. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static void refused_without_a_hand(void)
{
    float Pos[3] = {1.0f, 2.0f, 3.0f}, Kx[3][3] = {{0}};
    double PosD[3] = {1.0, 2.0, 3.0}, KxD[9] = {0};
    struct sun2xp_status Status;

    Status.size = sizeof Status;
    CHECK(CloseHand() == 0);
#define REFUSED(Call, Errno) CHECK((errno = 0, (Call)) < 0 && errno == (Errno))
    REFUSED(SendPos(1, Pos), ENODEV);
    REFUSED(SendPos(9, PosD), ENODEV);
    REFUSED(SendKx(1, Kx), ENODEV);
    REFUSED(SendKx(1, KxD), ENODEV);
    REFUSED(GetPos(1, Pos), ENODEV);
    REFUSED(GetPos(1, PosD), ENODEV);
    REFUSED(sun2xp_status(HAND, 1, &Status), ENODEV);
    REFUSED(sun2xp_push(HAND, 1, PosD), ENODEV);
    REFUSED(SendPos(1, (float *)NULL), EFAULT);
    REFUSED(GetPos(9, (double *)NULL), EFAULT);
    CHECK(Pos[0] == 1.0f && PosD[2] == 3.0);
    CHECK(strstr(HandError(), "null") != NULL);
}

int main(void)
{
    int round;

    refused_without_a_hand();
    for (round = 0; round < 2; round++) {
        CHECK(OpenHand() == 0);
        CHECK(CloseHand() == 0);
        CHECK(CloseHand() == 0);
        refused_without_a_hand();
    }
    return 0;
}
