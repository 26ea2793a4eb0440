/* Tests that is_there of c_examples/Can.c reports a finger that does not rest at its target. */
#define main main_of_the_example
#include "Can.c"
#undef main
#define CHECK_OUTPUT stdout
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    static const double Target[3] = {0.2, 0.6, 1.1}, Near[3] = {0.21, 0.61, 1.1}, Far[3] = {0.2, 0.6, 1.2};
    char said[200] = "";
    FILE *file;

    CHECK(freopen("said", "w", stderr) != NULL);
    CHECK(is_there(1, Near, Target) && ftell(stderr) == 0);
    CHECK(!is_there(2, Far, Target));
    fflush(stderr);
    file = fopen("said", "r");
    CHECK(file != NULL && fgets(said, sizeof said, file) != NULL);
    fclose(file);
    CHECK(strstr(said, "finger 2 rests 0.100 rad from its target: look for") != NULL);
    return 0;
}
