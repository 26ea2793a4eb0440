/* A planner with large thread-local data. glibc places a copy of this data in the stack of each new thread, including
   the threads of the library. */
#include <errno.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static __thread volatile char Own[KIBIBYTES * 1024];

int main(void)
{
    double Pos[3] = {0.1, 0.5, 0.9};
    Own[5] = 1;
    CHECK(OpenHand() == 0);
    CHECK(SendPos(1, Pos) == 0);
    CHECK(sun2xp_write_black_box(HAND, 1, "thread_local.jsonl") == 0);
    CHECK(sun2xp_stop_all() == 0);
    PAUSE_MS(50);
    CHECK(sun2xp_recover(HAND, 1) == 0);
    CHECK(sun2xp_adjust(HAND, 1, "tendon.minimum = 6") == 0);
    CHECK(CloseHand() == 0);
    CHECK(Own[5] == 1);
    return 0;
}
