/* Tests the watchdog of c_examples/CanDrives.c: frames of encoder counts must not restart its time. A drive that gets
   only such frames releases its motors and sends an emergency frame. */
#define main main_of_the_example
#include "CanDrives.c"
#undef main
#include "Sun2Xp.h"
#include "check.h"

static struct can_bus far_end, planner;

int main(void)
{
    static const int Start[4] = {1, 50, 0, 0}, Nothing[4];
    int numbers[4];
    double end;

    CHECK(can_open(&far_end, "./", 0) == 0 && can_open(&planner, "./", 1) == 0);
    begin_physics(&Drives[0].physics);
    obey(&far_end, CAN_CONTROL, 1, Start);
    CHECK(Drives[0].running);
    for (end = can_seconds() + 0.1; can_seconds() < end; usleep(5000))
        obey(&far_end, CAN_ENCODERS, 1, Nothing);
    watch(&far_end);
    CHECK(!Drives[0].running);
    CHECK(can_receive(&planner, numbers, 0) == CAN_ENCODERS + 1);
    CHECK(can_receive(&planner, numbers, 0) == CAN_TENSIONS + 1);
    CHECK(can_receive(&planner, numbers, 0) == CAN_EMERGENCY + 1);
    return 0;
}
