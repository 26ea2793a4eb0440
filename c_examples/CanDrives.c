/* CanDrives.c - the far end of Can.c. It simulates three fingers on a CAN bus, each with one drive for its four motors.
   GNU C99.

       CanDrives INTERFACE | FOLDER

   INTERFACE is the name of a CAN interface. On a machine without a CAN interface, give FOLDER instead: the path of an
   empty folder. The path must contain a slash, and have at most 80 characters. The frames then go through Unix datagram
   sockets in this folder.

   When a frame starts or stops a drive, the program answers with encoder counts and tensions. When a frame of torques
   reaches a started drive, the program answers in the same way, and then advances the physics of this drive's finger by
   1 ms. Each drive has a watchdog. The frame that starts the drive sets the watchdog's time. If no torques arrive for
   this time, the drive releases its motors and sends an emergency frame. The program ends after 10 s without a
   frame. */

#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#include "can_bus.h"
#include "finger_physics.h"

#define STEPS 10                        /* number of steps of PHYSICS_STEP in 1 ms */
#define LONGEST_SILENCE 10.0            /* s */

struct drive {
    struct finger_physics physics;
    double torques[4];                  /* N cm */
    double watchdog, commanded;         /* s */
    int running;
};

static struct drive Drives[3];

static void report(const struct can_bus *bus, int finger)
{
    const struct drive *drive = &Drives[finger - 1];
    int encoders[4], tensions[4], i;

    for (i = 0; i < 4; i++) {
        encoders[i] = count_of(&drive->physics, i);
        tensions[i] = (int)(tension_of(&drive->physics, i) / TENSION_UNIT + 0.5);
    }
    can_send(bus, finger, CAN_ENCODERS + finger, encoders);
    can_send(bus, finger, CAN_TENSIONS + finger, tensions);
}

static void obey(const struct can_bus *bus, unsigned kind, int finger, const int numbers[4])
{
    struct drive *drive = &Drives[finger - 1];
    int i;

    if (kind == CAN_CONTROL) {
        drive->running = numbers[0] == 1;
        drive->watchdog = 0.001 * numbers[1];
        drive->commanded = can_seconds();
        memset(drive->torques, 0, sizeof drive->torques);
        report(bus, finger);
    } else if (kind == CAN_TORQUES && drive->running) {
        report(bus, finger);
        drive->physics.braked = 0;
        for (i = 0; i < 4; i++)
            drive->torques[i] = TORQUE_UNIT * numbers[i];
        for (i = 0; i < STEPS; i++)
            step_physics(&drive->physics, drive->torques);
        drive->commanded = can_seconds();
    }
}

static void watch(const struct can_bus *bus)
{
    static const int Nothing[4];
    int finger;

    for (finger = 1; finger <= 3; finger++) {
        struct drive *drive = &Drives[finger - 1];

        if (drive->running && can_seconds() - drive->commanded > drive->watchdog) {
            drive->running = 0;
            memset(drive->torques, 0, sizeof drive->torques);
            can_send(bus, finger, CAN_EMERGENCY + finger, Nothing);
        }
    }
}

int main(int count, char **arguments)
{
    struct can_bus bus;
    double received = can_seconds();
    int numbers[4], identifier, finger;

    if (count != 2 || can_open(&bus, arguments[1], 0) != 0) {
        if (count == 2)
            fprintf(stderr, "%s: %s: name a CAN interface (ip link shows them), or an empty folder with a slash in its "
                "path\n", arguments[1], strerror(errno));
        else
            fprintf(stderr, "usage: CanDrives INTERFACE | FOLDER (a CAN interface, or an empty folder with a slash in "
                "its path)\n");
        return 1;
    }
    for (finger = 0; finger < 3; finger++)
        begin_physics(&Drives[finger].physics);
    while (can_seconds() - received < LONGEST_SILENCE) {
        identifier = can_receive(&bus, numbers, can_seconds() + 0.005);
        watch(&bus);
        finger = identifier & 0xF;
        if (identifier < 0 || finger < 1 || finger > 3)
            continue;
        received = can_seconds();
        obey(&bus, (unsigned)(identifier - finger), finger, numbers);
    }
    return 0;
}
