/* A library in place of libsun2xp_remote.so, for stub_planner.c. While it is being loaded, it calls sun2xp_stop_all of
   libsun2xp, as a planner could at that moment. It counts the calls of its own sun2xp_stop_all since the hand was
   opened, and those of its sun2xp_send_group. Its sun2xp_position returns both numbers. GNU C99. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include "sun2xp.h"

static char place;
static int stops, groups;

unsigned int sun2xp_abi_version(void)
{
    return 0;
}

unsigned int sun2xp_version_number(void)
{
    return SUN2XP_VERSION_NUMBER;
}

/* libsun2xp makes this call before it knows that this library is loaded. */
int sun2xp_set_log(sun2xp_log callback, void *user)
{
    int (*stop_all_of_planner)(void);

    (void)callback;
    (void)user;
    *(void **)&stop_all_of_planner = dlsym(RTLD_DEFAULT, "sun2xp_stop_all");
    return stop_all_of_planner();
}

int sun2xp_stop_all(void)
{
    stops++;
    return 0;
}

int sun2xp_open_text(const char *configuration, sun2xp_hand **hand)
{
    (void)configuration;
    *hand = (sun2xp_hand *)&place;
    stops = 0;
    return 0;
}

int sun2xp_send_group(sun2xp_hand *hand, int count, const struct sun2xp_set_point *set_points)
{
    (void)hand;
    (void)count;
    groups++;
    return set_points->size == sizeof *set_points ? 0 : -SUN2XP_ERROR_ARGUMENT;
}

int sun2xp_position(sun2xp_hand *hand, int finger, double *position)
{
    (void)hand;
    (void)finger;
    position[0] = stops;
    position[1] = groups;
    position[2] = 0;
    return 0;
}

int sun2xp_close(sun2xp_hand *hand)
{
    (void)hand;
    return 0;
}
