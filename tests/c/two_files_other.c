/* One of two files of a program that both include Sun2Xp.c. The main program is in two_files.c. This file includes
   Sun2Xp.c twice, like a planner that includes it directly and through another one of its files. */
#include "Sun2Xp.c"
#include "Sun2Xp.c"

int other_file(float *Pos)
{
    return GetPos(1, Pos);
}
