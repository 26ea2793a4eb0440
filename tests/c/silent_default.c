/* The test that runs this program sets hand.print_refusals = false in the configuration that OpenHand reads. So no
   refusal of a call for this hand is reported. After CloseHand, no refusal of a call of 1990 is reported either,
   because these calls know only this hand. A refusal of a call of sun2xp.h with the closed handle is reported. C89. */
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
