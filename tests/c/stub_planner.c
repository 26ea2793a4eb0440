/* A planner with a hand on another machine. stub_remote.c takes the place of the library of remote hands. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(void)
{
    struct sun2xp_set_point one;
    sun2xp_hand *hand;
    double seen[3];

    memset(&one, 0, sizeof one);
    CHECK(sun2xp_open_text("[remote]\nendpoint = \"tcp/127.0.0.1:9\"\n", &hand) == 0);
    /* stub_remote.c calls sun2xp_stop_all of libsun2xp while it is being loaded. libsun2xp passes this stop on after
       the opening. sun2xp_position of stub_remote.c returns the numbers of stops and groups that it has received. */
    CHECK(sun2xp_position(hand, 1, seen) == 0 && seen[0] == 1);
    /* A group without commands needs no memory for set points, and is not passed on to stub_remote.c. */
    CHECK(sun2xp_send_group(hand, 0, &one) == 0 && sun2xp_send_group(hand, 0, NULL) == 0);
    CHECK(sun2xp_position(hand, 1, seen) == 0 && seen[1] == 0);
    CHECK(sun2xp_close(hand) == 0);
    return 0;
}
