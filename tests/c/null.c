/* A null pointer in any spelling compiles and is refused at run time. The text names the call as the planner wrote
   it, and what to pass. */
#include <errno.h>
#include <stddef.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

/* CHECK would turn the expanded call into a string that is longer than C89 guarantees. */
#define REFUSED(Call, Text) \
    do { \
        errno = 0; \
        result = (Call); \
        CHECK(result == -1 && errno == EFAULT); \
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
    REFUSED(GetStatus(1, NULL), "GetStatus: Status is a null pointer: pass the address of a struct FingerStatus");
    REFUSED(GetFault(1, NULL), "GetFault: Fault is a null pointer: pass the address of a struct Fault");
    REFUSED(GetRecord(1, 0, NULL), "GetRecord: Record is a null pointer: pass the address of a struct FingerRecord");
    REFUSED(WriteBlackBox(1, NULL), "WriteBlackBox: Path is a null pointer: pass the name of a file");
    REFUSED(AdjustFinger(1, NULL), "AdjustFinger: Keys is a null pointer: pass a text");
    REFUSED(SendContact(1, 3, NULL, NULL), "SendContact: K is a null pointer: pass the array of the matrix");
    REFUSED(PushFinger(1, NULL), "PushFinger: Force is a null pointer: pass an array of 3 numbers");
    CHECK(CloseHand() == 0);
    return 0;
}
