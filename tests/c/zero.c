/* ZeroFinger: a finger is zeroed while the others keep running. Fingers that do not exist are refused. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct FingerStatus Status;
    double After[3];

    CHECK(ZeroFinger(1) == -1 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(AdjustFinger(2, "zeroing.method = 'pose'") == 0);
    CHECK(ZeroFinger(2) == 0);
    CHECK(GetPos(2, After) == 0);
    Status.Size = sizeof Status;
    CHECK(GetStatus(2, &Status) == 0);
    CHECK(Status.State == FINGER_RUNNING && Status.Calibration == 0.0);
    CHECK(SendPos(2, After) == 0);
    CHECK(ZeroFinger(4) == -1 && errno == EINVAL);
    CHECK(IdentifyFinger(0) == -1 && errno == EINVAL);
    CHECK(strstr(HandError(), "IdentifyFinger") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
