/* A null pointer of any spelling compiles, and is refused at run time. */
#include <errno.h>
#include <stddef.h>
#include "Sun2Xp.h"
#include "check.h"

/* Not by CHECK: it would make a string of the expanded call, longer than C89 promises. */
#define REFUSED(Call) \
    do { \
        errno = 0; \
        result = (Call); \
        CHECK(result == -1 && errno == EFAULT); \
    } while (0)

int main(void)
{
    int result;

    CHECK(OpenHand() == 0);
    REFUSED(SendPos(1, NULL));
    REFUSED(SendPos(1, 0));
    REFUSED(SendPos(1, (float *)NULL));
    REFUSED(SendPos(1, (double *)NULL));
    REFUSED(SendKx(1, NULL));
    REFUSED(SendKx(1, 0));
    REFUSED(SendKx(1, (double (*)[3])NULL));
    REFUSED(GetPos(1, NULL));
    REFUSED(GetPos(1, 0));
    REFUSED(GetPos(1, (double *)NULL));
    REFUSED(GetStatus(1, NULL));
    REFUSED(PushFinger(1, NULL));
    CHECK(CloseHand() == 0);
    return 0;
}
