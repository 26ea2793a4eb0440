/* A planner with a window and with short names for its own macros. Also compiled as C++. */
#ifdef WINDOW_LAST
#include "Sun2Xp.h"
#endif
#include "x11_macros.h"
#include "short_macros.h"
#ifndef WINDOW_LAST
#include "Sun2Xp.h"
#endif

int main(void)
{
    double Angles[Size] = {0.0, 0.5, 0.8};
    float Stiffness[Size][Size] = {{K, 0, 0}, {0, K, 0}, {0, 0, K}};
    Status Sent = OpenHand();

    Sent += SendPos(i, Angles);
    Sent += SendKx(i, Stiffness);
    Sent += GetPos(Pos, Angles);
    Sent += D + Kx + Fault + GetTip(i) + max(i, Pos);
    return Sent + CloseHand() + (HandError() == None ? True : False);
}
