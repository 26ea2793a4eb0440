/* Prints the result, the errno and the error text of OpenHand. */
#include <errno.h>
#include <stdio.h>
#include "Sun2Xp.h"

int main(void)
{
    int result = OpenHand(), code = errno;
    printf("%d %d %s\n", result, result ? code : 0, result ? HandError() : "");
    return 0;
}
