/* dlclose must leave the library and the hand as they are. */
#include <dlfcn.h>
#include <string.h>
#include "check.h"

static const char *(*why)(void);
#define HandError why

/* Copies the address of a function with memcpy, because ISO C has no conversion from an object pointer to a function
   pointer. */
static void find(void *library, const char *name, void *function)
{
    void *symbol = dlsym(library, name);
    CHECK(symbol != NULL);
    memcpy(function, &symbol, sizeof symbol);
}

int main(void)
{
    int (*open_hand)(void), (*close_hand)(void), (*get)(int, double *);
    double Pos[3];
    void *library = dlopen("libsun2xp.so.0", RTLD_NOW);

    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    find(library, "HandError", &why);
    find(library, "OpenHand", &open_hand);
    CHECK(open_hand() == 0);
    CHECK(dlclose(library) == 0);
    PAUSE_MS(100);

    library = dlopen("libsun2xp.so.0", RTLD_NOW);
    CHECK(library != NULL);
    find(library, "GetPosD", &get);
    find(library, "CloseHand", &close_hand);
    CHECK(get(3, Pos) == 0);
    CHECK(close_hand() == 0);
    CHECK(dlclose(library) == 0);
    return 0;
}
