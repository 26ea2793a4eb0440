/* Can.c - a hand whose drives are on a CAN bus. The library reaches the drives through functions of this program
   (docs/other-hardware.md). GNU C99, Linux.

       Can [INTERFACE]

   The drives are simulated by CanDrives, which this program starts. The two programs exchange CAN frames over
   INTERFACE. Without an argument, they use vcan0 if the machine has it, and otherwise Unix datagram sockets. These
   commands create vcan0: ip link add dev vcan0 type vcan; ip link set vcan0 up. */

#define _GNU_SOURCE
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include "can_bus.h"
#include "sun2xp.h"

/* The watchdog of the simulated drives has a long time limit, because a busy machine may delay the drives. */
#define CONFIGURATION "[hand]\nend_state = \"release\"\nwatchdog_ms = 200\n"

/* Longest wait for the simulated drives in an exchange, s. With real drives, stop waiting before the deadline of the
   command. */
#define PATIENCE 0.08

/* A finger has reached its target if the absolute errors of its three joint angles add up to at most this, rad. */
#define FARTHEST 0.03

struct drives {
    struct can_bus bus;
    int finger;
    int encoders[4];                    /* full counts; a frame contains their low 16 bits */
};

static void start_far_end(const char *program, const char *place, pid_t *process)
{
    char path[4096];
    const char *end = strrchr(program, '/');

    snprintf(path, sizeof path, "%.*sCanDrives", end != NULL ? (int)(end - program) + 1 : 0, program);
    *process = fork();
    if (*process < 0) {
        fprintf(stderr, "CanDrives cannot be started (%s): end other programs\n", strerror(errno));
        exit(1);
    }
    if (*process == 0) {
        execl(path, path, place, (char *)NULL);
        fprintf(stderr, "%s cannot be started (%s): build it with make -C c_examples all\n", path, strerror(errno));
        _exit(1);
    }
}

/* Waits for a frame with encoder counts and then one with tensions, in the order in which the drives send them. A late
   frame of the previous exchange may come first. Tensions without counts before them are therefore ignored, and later
   counts replace earlier ones. */
static int receive_sample(struct drives *drives, struct sun2xp_io_sample *sample, double deadline)
{
    int numbers[4], has_counts = 0, identifier, i;

    for (;;) {
        identifier = can_receive(&drives->bus, numbers, deadline);
        if (identifier < 0)
            return ETIMEDOUT;
        if (identifier == CAN_EMERGENCY + drives->finger)
            sample->faults |= SUN2XP_IO_WATCHDOG;
        if (identifier == CAN_ENCODERS + drives->finger) {
            for (i = 0; i < 4; i++)
                drives->encoders[i] += (short)(numbers[i] - drives->encoders[i]);
            has_counts = 1;
        }
        if (identifier == CAN_TENSIONS + drives->finger && has_counts)
            break;
    }
    for (i = 0; i < 4; i++)
        sample->tensions[i] = TENSION_UNIT * (numbers[i] & 0xFFFF);
    memcpy(sample->encoders, drives->encoders, sizeof drives->encoders);
    return 0;
}

/* Removes frames that came too late for an earlier exchange. */
static void discard(struct drives *drives)
{
    int numbers[4];

    while (can_receive(&drives->bus, numbers, 0) >= 0)
        ;
}

static int start(void *user, const struct sun2xp_io_terms *terms, struct sun2xp_io_sample *first)
{
    struct drives *drives = user;
    int control[4] = {1, (int)(terms->watchdog * 1000), 0, 0};
    int tries;

    /* CanDrives may still be starting. */
    for (tries = 0; tries < 100; tries++) {
        discard(drives);
        if (can_send(&drives->bus, 0, CAN_CONTROL + drives->finger, control) == 0
            && receive_sample(drives, first, can_seconds() + 0.05) == 0)
            return 0;
        usleep(10000);
    }
    return ETIMEDOUT;
}

static int exchange(void *user, const struct sun2xp_io_command *command, struct sun2xp_io_sample *sample)
{
    struct drives *drives = user;
    int torques[4], i;

    discard(drives);
    for (i = 0; i < 4; i++)
        torques[i] = (int)floor(command->torques[i] / TORQUE_UNIT + 0.5);
    if (can_send(&drives->bus, 0, CAN_TORQUES + drives->finger, torques) != 0)
        return errno;
    return receive_sample(drives, sample, can_seconds() + PATIENCE);
}

static int stop(void *user)
{
    static const int Control[4] = {2, 0, 0, 0};
    struct drives *drives = user;

    return can_send(&drives->bus, 0, CAN_CONTROL + drives->finger, Control) == 0 ? 0 : errno;
}

/* Returns whether a finger rests at the target. If it does not, prints how far away it is. */
static int is_there(int finger, const double position[3], const double target[3])
{
    double distance = fabs(position[0] - target[0]) + fabs(position[1] - target[1]) + fabs(position[2] - target[2]);

    if (distance <= FARTHEST)
        return 1;
    fprintf(stderr, "finger %d rests %.3f rad from its target: look for what keeps it from moving\n", finger, distance);
    return 0;
}

/* Moves every finger to the target. Returns 0 if all of them arrive, 1 if one rests elsewhere, and -1 if a call is
   refused. */
static int move(sun2xp_hand *hand)
{
    double target[3] = {0.2, 0.6, 1.1}, position[3];
    struct sun2xp_timing timing;
    int finger;

    for (finger = 1; finger <= 3; finger++)
        if (sun2xp_send_position(hand, finger, target) != 0)
            return -1;
    if (sun2xp_wait(hand, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_SETTLED, 20.0) != 0)
        return -1;
    timing.size = sizeof timing;
    for (finger = 1; finger <= 3; finger++) {
        if (sun2xp_position(hand, finger, position) != 0
            || sun2xp_timing(hand, finger, SUN2XP_STAGE_WIRE, &timing) != 0)
            return -1;
        printf("finger %d rests at %.3f %.3f %.3f rad, exchange: median %.0f us\n", finger, position[0], position[1],
            position[2], (double)timing.median / 1000);
        if (!is_there(finger, position, target))
            return 1;
    }
    return 0;
}

/* Ends CanDrives, and removes the temporary folder with the sockets if there is one. */
static void end_far_end(pid_t far_end, const char *folder)
{
    int i;

    kill(far_end, SIGTERM);
    waitpid(far_end, NULL, 0);
    if (folder == NULL)
        return;
    for (i = 0; i <= 3; i++)
        unlink(can_address(folder, i).sun_path);
    rmdir(folder);
}

int main(int count, char **arguments)
{
    char folder[] = "/tmp/can-XXXXXX";
    const char *place = count > 1 ? arguments[1] : "vcan0";
    struct drives drives[3];
    struct sun2xp_io io[3];
    sun2xp_hand *hand;
    pid_t far_end;
    int i, result;

    if (count == 1 && if_nametoindex(place) == 0 && (place = mkdtemp(folder)) == NULL) {
        fprintf(stderr, "%s: %s: make /tmp writable, or name a CAN interface\n", folder, strerror(errno));
        return 1;
    }
    printf("CAN over %s\n", place);
    start_far_end(arguments[0], place, &far_end);
    memset(drives, 0, sizeof drives);
    memset(io, 0, sizeof io);
    for (i = 0; i < 3; i++) {
        drives[i].finger = i + 1;
        if (can_open(&drives[i].bus, place, i + 1) != 0) {
            fprintf(stderr, "%s: %s: name a CAN interface that exists (ip link shows them)\n", place, strerror(errno));
            end_far_end(far_end, place == folder ? folder : NULL);
            return 1;
        }
        io[i].size = sizeof io[i];
        io[i].finger = i + 1;
        io[i].in_step = 1;              /* 0 for real drives */
        io[i].user = &drives[i];
        io[i].start = start;
        io[i].exchange = exchange;
        io[i].stop = stop;
    }
    result = sun2xp_open_io_text(CONFIGURATION, 3, io, &hand);
    if (result == 0) {
        result = move(hand);
        if (result < 0)
            fprintf(stderr, "%s\n", sun2xp_error_text(hand));
        sun2xp_close(hand);
    } else {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
    }
    end_far_end(far_end, place == folder ? folder : NULL);
    return result == 0 ? 0 : 1;
}
