/* A planner with large thread-local data: glibc takes it from the stack of every thread, including the library's. */
#include <errno.h>
#include "Sun2Xp.h"
#include "check.h"

static __thread volatile char Own[KIBIBYTES * 1024];

int main(void)
{
    double Pos[3] = {0.1, 0.5, 0.9};
    Own[5] = 1;
    CHECK(OpenHand() == 0);
    CHECK(SendPos(1, Pos) == 0);
    CHECK(WriteBlackBox(1, "thread_local.jsonl") == 0);
    CHECK(StopHand() == 0);
    PAUSE_MS(50);
    CHECK(RecoverHand(1) == 0);
    CHECK(AdjustFinger(1, "tendon.minimum = 6") == 0);
    CHECK(CloseHand() == 0);
    CHECK(Own[5] == 1);
    return 0;
}
