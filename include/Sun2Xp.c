/* Sun2Xp.c - planners of 1990 include this file (Figure 6 of the report). What it held is in the library now; only its
   declarations are left, so several files of a program may include it. */
#include "Sun2Xp.h"
