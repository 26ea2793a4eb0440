/* Must not compile: there is no hand for integers. */
#include "Sun2Xp.h"

int main(void)
{
    int Pos[3] = {0, 0, 1};
    return SendPos(1, Pos);
}
