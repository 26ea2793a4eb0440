// Includes the header twice, in C++.
#include "Sun2Xp.h"
#include "Sun2Xp.h"

extern int unused;
