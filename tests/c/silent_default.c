/* The hand that OpenHand opens has hand.print_refusals = false. Refusals of the calls of 1990 are not reported after
   CloseHand either, because these calls have only this hand. Refusals of calls with its closed handle are reported.
   C89. */
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refusals.h"

int main(void)
{
    double far[3] = {9, 0.5, 0.9}, position[3];
    float Pos[3];
    sun2xp_hand *hand;

    CHECK(sun2xp_set_log(count_refusal, NULL) == 0);
    CHECK(OpenHand() == 0);
    hand = sun2xp_default_hand();
    CHECK(sun2xp_send_position(hand, 1, far) < 0 && refusals == 0);
    CHECK(CloseHand() == 0);
    CHECK(GetPos(1, Pos) < 0 && refusals == 0);
    CHECK(sun2xp_position(hand, 1, position) < 0 && refusals == 1);
    return 0;
}
