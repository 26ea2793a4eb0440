/* Tries to write a black box to the file that the argument names, which cannot be written. Prints the reason. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(int count, char **arguments)
{
    CHECK(count == 2);
    CHECK(OpenHand() == 0);
    CHECK(sun2xp_write_black_box(HAND, 1, arguments[1]) < 0);
    printf("%s\n", HandError());
    CHECK(CloseHand() == 0);
    return 0;
}
