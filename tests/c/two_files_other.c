/* One of two files of a program that both include Sun2Xp.c. The main program is in two_files.c. */
#include "Sun2Xp.c"
#include "Sun2Xp.c"

int other_file(float *Pos)
{
    return GetPos(1, Pos);
}
