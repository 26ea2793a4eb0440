/* One of two files of a program that both include Sun2Xp.c. The main program is in two_files.c. This file includes
   Sun2Xp.c twice, which a planner may do through a file of its own. */
#include "Sun2Xp.c"
#include "Sun2Xp.c"

int other_file(float *Pos)
{
    return GetPos(1, Pos);
}
