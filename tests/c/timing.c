/* Tests sun2xp_timing and sun2xp_reset_timing: for every stage of a running servo, with wrong arguments, and with the
   larger struct of a program that was compiled for a later version. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static void refused_without_a_hand(void)
{
    struct sun2xp_timing Timing;

    Timing.size = sizeof Timing;
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_WIRE, &Timing), ENODEV, "sun2xp_open");
    Timing.size = 1;
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_WIRE, &Timing), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_WIRE, NULL), EFAULT, "null");
    REFUSED(sun2xp_reset_timing(HAND, 0), ENODEV, "sun2xp_open");
}

int main(void)
{
    struct { struct sun2xp_timing Known; unsigned char Later[64]; } Larger;
    struct sun2xp_timing *Timing = &Larger.Known, Before;
    int finger, stage, byte;

    refused_without_a_hand();
    CHECK(OpenHand() == 0);
    PAUSE_MS(1000);
    for (finger = 1; finger <= 3; finger++) {
        for (stage = SUN2XP_STAGE_WAKE_UP; stage <= SUN2XP_STAGE_AGE; stage++) {
            memset(&Larger, 0x55, sizeof Larger);
            Timing->size = sizeof Larger;
            CHECK(sun2xp_timing(HAND, finger, stage, Timing) == 0);
            CHECK(Timing->size == sizeof Larger);
            for (byte = 0; byte < 64; byte++)
                CHECK(Larger.Later[byte] == 0);
            printf("finger %d stage %d: %lu of %lu cycles, ns: %lu %lu %lu %lu %lu; ", finger, stage, Timing->count,
                   Timing->cycles, Timing->minimum, Timing->median, Timing->p99, Timing->p999, Timing->maximum);
            printf("%lu overruns %lu skipped %lu lost %lu late %lu corrupt\n", Timing->overruns,
                    Timing->skipped_periods,
                   Timing->lost_replies, Timing->late_replies, Timing->damaged_replies);
            CHECK(Timing->stage == stage);
            CHECK(Timing->count > 500 && Timing->count <= Timing->cycles);
            CHECK(Timing->minimum <= Timing->median && Timing->median <= Timing->p99);
            CHECK(Timing->p99 <= Timing->p999 && Timing->p999 <= Timing->maximum);
            CHECK(Timing->damaged_replies == 0);
        }
        /* The last stage is the age of the feedback: one period, 1 ms. */
        CHECK(Timing->median > 900000 && Timing->median < 1100000);
    }

    REFUSED(sun2xp_timing(HAND, 0, SUN2XP_STAGE_WIRE, Timing), EINVAL, "1, 2 and 3");
    REFUSED(sun2xp_timing(HAND, 1, -1, Timing), EINVAL, "stage -1");
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_AGE + 1, Timing), EINVAL, "stage 8");
    Before = *Timing;
    Timing->size = 8;
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_WIRE, Timing), EINVAL, "size");
    CHECK(Timing->maximum == Before.maximum);
    REFUSED(sun2xp_reset_timing(HAND, 4), EINVAL, "1, 2 and 3");

    Timing->size = sizeof *Timing;
    CHECK(sun2xp_reset_timing(HAND, 2) == 0);
    CHECK(sun2xp_timing(HAND, 2, SUN2XP_STAGE_CYCLE, Timing) == 0);
    CHECK(Timing->cycles < 500 && Timing->count < 500);
    CHECK(sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, Timing) == 0);
    CHECK(Timing->cycles > 500 && Timing->count > 500);
    CHECK(sun2xp_reset_timing(HAND, 0) == 0);
    CHECK(sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, Timing) == 0);
    CHECK(Timing->cycles < 500 && Timing->count < 500);
    CHECK(CloseHand() == 0);
    refused_without_a_hand();
    return 0;
}
