/* Sun2Xp.c - planners of 1990 include this file (Figure 6 of the report). Its code is now in the library. Only the
   declarations remain, so several files of a program may include it. */
#include "Sun2Xp.h"
