/* GetTiming and ResetTiming: every stage of a running servo, wrong arguments, and a struct that may grow in later
   versions. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

static void refused_without_a_hand(void)
{
    struct FingerTiming Timing;

    Timing.Size = sizeof Timing;
    REFUSED(GetTiming(1, TIMING_WIRE, &Timing), ENODEV, "OpenHand");
    Timing.Size = 1;
    REFUSED(GetTiming(1, TIMING_WIRE, &Timing), ENODEV, "OpenHand");
    REFUSED(GetTiming(1, TIMING_WIRE, NULL), EFAULT, "null");
    REFUSED(ResetTiming(0), ENODEV, "OpenHand");
}

int main(void)
{
    struct { struct FingerTiming Known; unsigned char Later[64]; } Larger;
    struct FingerTiming *Timing = &Larger.Known, Before;
    int finger, stage, byte;

    refused_without_a_hand();
    CHECK(OpenHand() == 0);
    PAUSE_MS(1000);
    for (finger = 1; finger <= 3; finger++) {
        for (stage = TIMING_WAKE_UP; stage <= TIMING_AGE; stage++) {
            memset(&Larger, 0x55, sizeof Larger);
            Timing->Size = sizeof Larger;
            CHECK(GetTiming(finger, stage, Timing) == 0);
            CHECK(Timing->Size == sizeof *Timing);
            for (byte = 0; byte < 64; byte++)
                CHECK(Larger.Later[byte] == 0x55);
            printf("finger %d stage %d: %lu of %lu cycles, ns: %lu %lu %lu %lu %lu; ", finger, stage, Timing->Count,
                   Timing->Cycles, Timing->Minimum, Timing->Median, Timing->P99, Timing->P999, Timing->Maximum);
            printf("%lu overruns %lu skipped %lu lost %lu late %lu corrupt\n", Timing->Overruns, Timing->SkippedPeriods,
                   Timing->LostReplies, Timing->LateReplies, Timing->CorruptReplies);
            CHECK(Timing->Stage == stage);
            CHECK(Timing->Count > 500 && Timing->Count <= Timing->Cycles);
            CHECK(Timing->Minimum <= Timing->Median && Timing->Median <= Timing->P99);
            CHECK(Timing->P99 <= Timing->P999 && Timing->P999 <= Timing->Maximum);
            CHECK(Timing->CorruptReplies == 0);
        }
        /* The last stage is the age of the feedback: one period, 1 ms. */
        CHECK(Timing->Median > 900000 && Timing->Median < 1100000);
    }

    REFUSED(GetTiming(0, TIMING_WIRE, Timing), EINVAL, "1, 2 and 3");
    REFUSED(GetTiming(1, -1, Timing), EINVAL, "stage -1");
    REFUSED(GetTiming(1, TIMING_AGE + 1, Timing), EINVAL, "stage 8");
    Before = *Timing;
    Timing->Size = 8;
    REFUSED(GetTiming(1, TIMING_WIRE, Timing), EINVAL, "Size");
    CHECK(Timing->Maximum == Before.Maximum);
    REFUSED(ResetTiming(4), EINVAL, "1, 2 and 3");

    Timing->Size = sizeof *Timing;
    CHECK(ResetTiming(2) == 0);
    CHECK(GetTiming(2, TIMING_CYCLE, Timing) == 0);
    CHECK(Timing->Cycles < 500 && Timing->Count < 500);
    CHECK(GetTiming(1, TIMING_CYCLE, Timing) == 0);
    CHECK(Timing->Cycles > 500 && Timing->Count > 500);
    CHECK(ResetTiming(0) == 0);
    CHECK(GetTiming(1, TIMING_CYCLE, Timing) == 0);
    CHECK(Timing->Cycles < 500 && Timing->Count < 500);
    CHECK(CloseHand() == 0);
    refused_without_a_hand();
    return 0;
}
