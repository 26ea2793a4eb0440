/* GetStatus: the state of the servo, and a struct that may grow in later versions. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct { struct FingerStatus Known; unsigned char Later[64]; } Larger;
    struct FingerStatus *Status = &Larger.Known;
    /* Outstretched, where the tendons carry less stiffness than the bound. */
    static float Stretched[3] = { 0.0F, 0.0F, 0.1F };
    static float Stiffest[3][3] = { { 6.0F, 0.0F, 0.0F }, { 0.0F, 6.0F, 0.0F }, { 0.0F, 0.0F, 6.0F } };
    int finger, byte;

    CHECK(OpenHand() == 0);
    PAUSE_MS(1000);
    for (finger = 1; finger <= 3; finger++) {
        memset(&Larger, 0x55, sizeof Larger);
        Status->Size = sizeof Larger;
        CHECK(GetStatus(finger, Status) == 0);
        CHECK(Status->Size == sizeof *Status);
        for (byte = 0; byte < 64; byte++)
            CHECK(Larger.Later[byte] == 0x55);
        printf("finger %d: %.1f of %.1f Hz, wake-up %.1f %.1f %.1f us, ", finger, Status->MeasuredRate, Status->Rate,
               Status->WakeUpMedian, Status->WakeUp99, Status->WakeUpMaximum);
        printf("%lu cycles, %lu skipped, %lu lost, %lu damaged, real-time %d\n", Status->Cycles, Status->SkippedPeriods,
               Status->LostReplies, Status->DamagedFrames, Status->Realtime);
        CHECK(Status->State == FINGER_RUNNING);
        CHECK(Status->Rate == 1000.0);
        CHECK(Status->MeasuredRate > 900.0 && Status->MeasuredRate < 1001.0);
        CHECK(Status->Cycles >= 900);
        CHECK(Status->WakeUpMedian <= Status->WakeUp99 && Status->WakeUp99 <= Status->WakeUpMaximum);
        CHECK(Status->TorqueScale > 0.0 && Status->TorqueScale <= 1.0);
        CHECK(Status->StiffnessScale == 1.0);
        CHECK(Status->DamagedFrames == 0);
    }
    CHECK(SendKx(1, Stiffest) == 0);
    CHECK(SendPos(1, Stretched) == 0);
    PAUSE_MS(2000);
    Status->Size = sizeof *Status;
    CHECK(GetStatus(1, Status) == 0);
    printf("stretched, at 6 N/cm: %.3f of it\n", Status->StiffnessScale);
    CHECK(Status->StiffnessScale > 0.5 && Status->StiffnessScale < 1.0);
    CHECK(CloseHand() == 0);
    return 0;
}
