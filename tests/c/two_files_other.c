/* The other file. */
#include "Sun2Xp.c"
#include "Sun2Xp.c"

int other_file(float *Pos)
{
    return GetPos(1, Pos);
}
