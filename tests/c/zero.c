/* sun2xp_zero: a zeroed finger runs again and takes a set point. The call is refused before the hand is open.
   sun2xp_zero and sun2xp_identify are refused for fingers that do not exist. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(void)
{
    struct sun2xp_status Status;
    double After[3];

    CHECK(sun2xp_zero(HAND, 1) < 0 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(sun2xp_adjust(HAND, 2, "zeroing.method = 'pose'") == 0);
    CHECK(sun2xp_zero(HAND, 2) == 0);
    CHECK(GetPos(2, After) == 0);
    Status.size = sizeof Status;
    CHECK(sun2xp_status(HAND, 2, &Status) == 0);
    CHECK(Status.state == SUN2XP_STATE_RUNNING && Status.calibration == 0.0);
    CHECK(SendPos(2, After) == 0);
    CHECK(sun2xp_zero(HAND, 4) < 0 && errno == EINVAL);
    CHECK(sun2xp_identify(HAND, 0) < 0 && errno == EINVAL);
    CHECK(strstr(HandError(), "sun2xp_identify") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
