/* Says what OpenHand says. */
#include <errno.h>
#include <stdio.h>
#include "Sun2Xp.h"

int main(void)
{
    int result = OpenHand(), code = errno;
    printf("%d %d %s\n", result, result ? code : 0, result ? HandError() : "");
    return 0;
}
