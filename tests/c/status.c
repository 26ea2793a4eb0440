/* sun2xp_status: the state of the servo, and a struct that may grow in later versions. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(void)
{
    struct { struct sun2xp_status Known; unsigned char Later[64]; } Larger;
    struct sun2xp_status *Status = &Larger.Known;
    /* The finger is outstretched. In this pose the tendons cannot produce a stiffness of 6 N/cm, the bound of Kx. */
    static float Stretched[3] = { 0.0F, 0.0F, 0.1F };
    static float Stiffest[3][3] = { { 6.0F, 0.0F, 0.0F }, { 0.0F, 6.0F, 0.0F }, { 0.0F, 0.0F, 6.0F } };
    int finger, byte;

    CHECK(OpenHand() == 0);
    PAUSE_MS(1000);
    for (finger = 1; finger <= 3; finger++) {
        memset(&Larger, 0x55, sizeof Larger);
        Status->size = sizeof Larger;
        CHECK(sun2xp_status(HAND, finger, Status) == 0);
        CHECK(Status->size == sizeof Larger);
        for (byte = 0; byte < 64; byte++)
            CHECK(Larger.Later[byte] == 0);
        printf("finger %d: %.1f of %.1f Hz, wake-up %.1f %.1f %.1f us, ", finger, Status->measured_rate, Status->rate,
               Status->wake_up_median, Status->wake_up_p99, Status->wake_up_maximum);
        printf("%lu cycles, %lu skipped, %lu lost, %lu damaged, real-time %d\n", Status->cycles,
                Status->skipped_periods,
               Status->lost_replies, Status->damaged_replies, Status->realtime);
        CHECK(Status->state == SUN2XP_STATE_RUNNING);
        CHECK(Status->rate == 1000.0);
        CHECK(Status->measured_rate > 900.0 && Status->measured_rate < 1001.0);
        CHECK(Status->cycles >= 900);
        CHECK(Status->wake_up_median <= Status->wake_up_p99 && Status->wake_up_p99 <= Status->wake_up_maximum);
        CHECK(Status->torque_scale > 0.0 && Status->torque_scale <= 1.0);
        CHECK(Status->stiffness_scale == 1.0);
        CHECK(Status->damaged_replies == 0);
    }
    CHECK(SendKx(1, Stiffest) == 0);
    CHECK(SendPos(1, Stretched) == 0);
    PAUSE_MS(2000);
    Status->size = sizeof *Status;
    CHECK(sun2xp_status(HAND, 1, Status) == 0);
    printf("finger 1 outstretched: %.3f of the commanded 6 N/cm\n", Status->stiffness_scale);
    CHECK(Status->stiffness_scale > 0.5 && Status->stiffness_scale < 1.0);
    CHECK(CloseHand() == 0);
    return 0;
}
