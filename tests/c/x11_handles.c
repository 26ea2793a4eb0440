/* A planner that uses sun2xp.h, macros of X11, and macros of its own with short names. It also makes the calls of
   Sun2Xp.h, as planners with one hand do. It is also compiled as C++. */
#ifdef WINDOW_LAST
#include "sun2xp.h"
#include "Sun2Xp.h"
#endif
#include "x11_macros.h"
#include "short_macros.h"
#ifndef WINDOW_LAST
#include "sun2xp.h"
#include "Sun2Xp.h"
#endif
/* Uses every member of every struct. */
#include "layout.c"

int main(void)
{
    double Angles[Size] = {0.0, 0.5, 0.8};
    double Stiffness[9] = {K, 0, 0, 0, K, 0, 0, 0, K};
    struct sun2xp_tip Found;
    struct sun2xp_set_point Point[Success + 1];
    sun2xp_hand *hand = NULL;
    Status Sent = sun2xp_open(NULL, &hand);

    Found.size = sizeof Found;
    Point[0].size = sizeof Point[0];
    Point[0].finger = Pos;
    Point[0].position = Angles;
    Point[0].tip = NULL;
    Point[0].stiffness = Stiffness;
    Point[0].damping = True;
    Sent += sun2xp_send_position(hand, i, Angles);
    Sent += sun2xp_send_stiffness(hand, i, Stiffness);
    Sent += sun2xp_send_group(hand, True, Point);
    Sent += sun2xp_wait(hand, Pos, SUN2XP_WAIT_SETTLED, D);
    Sent += sun2xp_tip(hand, i, &Found);
    Sent += Found.touching + Kx + Fault + GetTip(i) + max(i, Pos);
    Sent += sun2xp_close(hand);
    Sent += SendPos(i, Angles) + sun2xp_stop(sun2xp_default_hand(), i);
    return Sent + (HandError() == None ? True : False);
}
