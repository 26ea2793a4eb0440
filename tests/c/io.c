/* Tests hardware that the program provides: opening, moving, faults, recovery and the refusals of sun2xp_open_io. */

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "finger_physics.h"

struct hardware {
    struct finger_physics physics;
    unsigned long number, exchanges;
    double simulated, limit;
    int starts, stops, finger, fails, start_fails;
    unsigned faults;
    int unreadable;
};

static struct hardware Hardware[3];

static void measure(const struct hardware *hardware, struct sun2xp_io_sample *sample)
{
    int i;

    for (i = 0; i < 4; i++) {
        sample->encoders[i] = count_of(&hardware->physics, i);
        sample->tensions[i] = tension_of(&hardware->physics, i);
    }
    if (hardware->unreadable)
        sample->tensions[2] = sqrt(-1.0);
    sample->time = 1 + hardware->simulated;
    sample->faults = hardware->faults;
}

static int start(void *user, const struct sun2xp_io_terms *terms, struct sun2xp_io_sample *first)
{
    struct hardware *hardware = user;

    CHECK(terms->size == sizeof *terms && first->size == sizeof *first);
    CHECK(terms->rate == 1000.0 && terms->watchdog == 0.2 && terms->hold == 0);
    CHECK(terms->torque_limits[0] > 4.7 && terms->torque_limits[0] <= 4.75);
    if (hardware->start_fails)
        return ENODEV;
    hardware->starts++;
    hardware->finger = terms->finger;
    hardware->limit = terms->torque_limits[0];
    hardware->number = 0;
    measure(hardware, first);
    return 0;
}

static int exchange(void *user, const struct sun2xp_io_command *command, struct sun2xp_io_sample *sample)
{
    struct hardware *hardware = user;
    int i;

    if (hardware->fails)
        return -ETIMEDOUT;
    measure(hardware, sample);
    hardware->exchanges++;
    if (command->number != hardware->number) {
        hardware->number = command->number;
        if (command->enable)
            hardware->physics.braked = 0;
        for (i = 0; i < 10; i++)
            step_physics(&hardware->physics, command->torques);
        hardware->simulated += 0.001;
    }
    for (i = 0; i < 4; i++)
        if (fabs(command->torques[i]) > hardware->limit)
            return EINVAL;
    return 0;
}

static int stop(void *user)
{
    ((struct hardware *)user)->stops++;
    return 0;
}

static void pause_for(double seconds)
{
    struct timespec wait;

    wait.tv_sec = (time_t)seconds;
    wait.tv_nsec = (long)((seconds - floor(seconds)) * 1e9);
    nanosleep(&wait, NULL);
}

static int fault_of(sun2xp_hand *hand, int finger)
{
    struct sun2xp_fault fault;
    int tries;

    fault.size = sizeof fault;
    for (tries = 0; tries < 10000; tries++) {
        CHECK(sun2xp_fault(hand, finger, &fault) == 0);
        if (fault.number != 0)
            return fault.number;
        pause_for(0.001);
    }
    return 0;
}

static void refusals(const struct sun2xp_io *io)
{
    struct sun2xp_io wrong[2];
    sun2xp_hand *hand = NULL;

    CHECK(sun2xp_open_io(NULL, 1, NULL, &hand) < 0 && errno == EFAULT);
    CHECK(sun2xp_open_io(NULL, 1, io, NULL) < 0 && errno == EFAULT);
    CHECK(sun2xp_open_io(NULL, 4, io, &hand) < 0 && errno == EINVAL);
    CHECK(sun2xp_open_io(NULL, -1, io, &hand) < 0 && errno == EINVAL);
    CHECK(sun2xp_open_io_text(NULL, 1, io, &hand) < 0 && errno == EFAULT);
    wrong[0] = wrong[1] = *io;
    CHECK(sun2xp_open_io(NULL, 2, wrong, &hand) < 0 && errno == EINVAL);
    CHECK(strstr(sun2xp_error_text(NULL), "two elements of io are for finger 1") != NULL);
    wrong[1].finger = 4;
    CHECK(sun2xp_open_io(NULL, 2, wrong, &hand) < 0 && errno == EINVAL);
    wrong[0].exchange = NULL;
    /* The wrong finger of the second element is reported before the missing function of the first. */
    CHECK(sun2xp_open_io(NULL, 2, wrong, &hand) < 0 && errno == EINVAL);
    CHECK(sun2xp_open_io(NULL, 1, wrong, &hand) < 0 && errno == EFAULT);
    CHECK(strstr(sun2xp_error_text(NULL), "io->exchange is a null pointer") != NULL);
    wrong[0] = *io;
    wrong[0].size = sizeof wrong[0] - 1;
    CHECK(sun2xp_open_io(NULL, 1, wrong, &hand) < 0 && errno == EINVAL);
    wrong[0] = *io;
    wrong[0].shortest_watchdog = -0.01;
    CHECK(sun2xp_open_io(NULL, 1, wrong, &hand) < 0 && errno == EINVAL);
    CHECK(strstr(sun2xp_error_text(NULL), "shortest_watchdog of the io of finger 1 is -0.01 s") != NULL);
    wrong[0].shortest_watchdog = sqrt(-1.0);
    CHECK(sun2xp_open_io(NULL, 1, wrong, &hand) < 0 && errno == EINVAL);
    wrong[0] = *io;
    wrong[0].tension_unit = -1;
    CHECK(sun2xp_open_io(NULL, 1, wrong, &hand) < 0 && errno == EINVAL);
    CHECK(hand == NULL && Hardware[0].starts == 0);
}

static void count_notices(int severity, const char *text, void *user)
{
    if (severity == SUN2XP_LOG_WARNING && strstr(text, "(zero lost)") != NULL)
        ++*(int *)user;
}

/* Opening hardware that starts without a zero succeeds with a warning. Recovering it succeeds with another warning. */
static void starts_without_zero(const struct sun2xp_io *io)
{
    static const char Text[] = "[hand]\nfingers = [1]\nwatchdog_ms = 200\nend_state = \"release\"\n";
    sun2xp_hand *hand;
    int notices = 0;

    CHECK(sun2xp_set_log(count_notices, &notices) == 0);
    Hardware[0].faults = SUN2XP_IO_ZERO_LOST;
    CHECK(sun2xp_open_io_text(Text, 1, io, &hand) == 0);
    CHECK(sun2xp_stop(hand, 1) == 0 && fault_of(hand, 1) == SUN2XP_FAULT_STOP_CALL);
    CHECK(sun2xp_recover(hand, 1) == 0);
    CHECK(sun2xp_close(hand) == 0 && sun2xp_set_log(NULL, NULL) == 0);
    CHECK(notices == 2);
    memset(&Hardware[0], 0, sizeof Hardware[0]);
    begin_physics(&Hardware[0].physics);
}

int main(void)
{
    static const char Text[] = "[hand]\nwatchdog_ms = 200\nend_state = \"release\"\n";
    double target[3] = {0.2, 0.6, 1.1}, position[3];
    struct sun2xp_io io[3];
    sun2xp_hand *hand;
    int i;

    memset(io, 0, sizeof io);
    for (i = 0; i < 3; i++) {
        begin_physics(&Hardware[i].physics);
        io[i].size = sizeof io[i];
        io[i].finger = i + 1;
        io[i].in_step = i != 1;
        io[i].user = &Hardware[i];
        io[i].start = start;
        io[i].exchange = exchange;
        io[i].stop = stop;
    }
    refusals(io);
    starts_without_zero(io);
    Hardware[0].start_fails = 1;
    CHECK(sun2xp_open_io_text(Text, 3, io, &hand) < 0 && errno == ENODEV);
    Hardware[0].start_fails = 0;

    if (sun2xp_open_io_text(Text, 3, io, &hand) != 0) {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        return 1;
    }
    for (i = 0; i < 3; i++) {
        CHECK(Hardware[i].finger == i + 1 && Hardware[i].exchanges > 10);
        CHECK(sun2xp_send_position(hand, i + 1, target) == 0);
    }
    CHECK(sun2xp_wait(hand, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_SETTLED, 10.0) == 0);
    for (i = 0; i < 3; i++)
        CHECK(fabs(Hardware[2].physics.theta[i] - target[i]) < 0.02);

    Hardware[1].fails = 1;
    CHECK(fault_of(hand, 2) == SUN2XP_FAULT_LOST_REPLIES);
    Hardware[1].start_fails = 1;
    CHECK(sun2xp_recover(hand, 2) < 0 && errno == ENODEV);
    CHECK(strstr(sun2xp_error_text(hand), "failed to start") != NULL);
    Hardware[1].fails = Hardware[1].start_fails = 0;
    CHECK(sun2xp_recover(hand, 2) == 0 && Hardware[1].starts == 2);
    CHECK(sun2xp_position(hand, 2, position) == 0);
    Hardware[2].unreadable = 1;
    CHECK(fault_of(hand, 3) == SUN2XP_FAULT_SENSOR_FAULT);
    Hardware[0].faults = SUN2XP_IO_DRIVER;
    CHECK(fault_of(hand, 1) == SUN2XP_FAULT_DRIVER_FAULT);
    CHECK(sun2xp_close(hand) == 0);
    for (i = 0; i < 3; i++)
        CHECK(Hardware[i].stops == Hardware[i].starts);
    return 0;
}
