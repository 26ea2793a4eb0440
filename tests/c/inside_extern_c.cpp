// Old C headers are often included like this.
extern "C" {
#include "Sun2Xp.h"
}

int main()
{
    double pos[3];
    return GetPos(1, pos) == -1 && SendPos(1, pos) == -1 ? 0 : 1;
}
