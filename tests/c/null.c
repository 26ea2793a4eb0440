/* A null pointer in any spelling compiles and is refused at run time. The text of HandError names the call as the
   planner wrote it, and says what to pass. */
#include <errno.h>
#include <stddef.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* CHECK would turn the expanded call into a string that is longer than a C89 compiler must accept. */
#define REFUSED(Call, Text) \
    do { \
        errno = 0; \
        result = (Call); \
        CHECK(result < 0 && errno == EFAULT); \
        CHECK(strcmp(HandError(), Text) == 0); \
    } while (0)

int main(void)
{
    int result;

    CHECK(OpenHand() == 0);
    REFUSED(SendPos(1, NULL), "SendPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(SendPos(1, 0), "SendPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(SendPos(1, (float *)NULL), "SendPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(SendPos(1, (double *)NULL), "SendPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(SendKx(1, NULL), "SendKx: Kx is a null pointer: pass an array of 9 numbers");
    REFUSED(SendKx(1, 0), "SendKx: Kx is a null pointer: pass an array of 9 numbers");
    REFUSED(SendKx(1, (double (*)[3])NULL), "SendKx: Kx is a null pointer: pass an array of 9 numbers");
    REFUSED(GetPos(1, NULL), "GetPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(GetPos(1, 0), "GetPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(GetPos(1, (double *)NULL), "GetPos: Pos is a null pointer: pass an array of 3 numbers");
    REFUSED(sun2xp_status(HAND, 1, NULL),
            "sun2xp_status: status is a null pointer: pass the address of a struct sun2xp_status");
    REFUSED(sun2xp_fault(HAND, 1, NULL),
            "sun2xp_fault: fault is a null pointer: pass the address of a struct sun2xp_fault");
    REFUSED(sun2xp_record(HAND, 1, 0, NULL),
            "sun2xp_record: record is a null pointer: pass the address of a struct sun2xp_record");
    REFUSED(sun2xp_write_black_box(HAND, 1, NULL),
            "sun2xp_write_black_box: path is a null pointer: pass the name of a file");
    REFUSED(sun2xp_adjust(HAND, 1, NULL), "sun2xp_adjust: keys is a null pointer: pass a text");
    REFUSED(sun2xp_send_contact(HAND, 1, 3, NULL, NULL),
            "sun2xp_send_contact: stiffness is a null pointer: pass the array of the matrix");
    REFUSED(sun2xp_push(HAND, 1, NULL), "sun2xp_push: force is a null pointer: pass an array of 3 numbers");
    CHECK(CloseHand() == 0);
    return 0;
}
