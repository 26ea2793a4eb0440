/* can_bus.h - CAN frames over SocketCAN, or over Unix datagram sockets where the machine has no CAN interface. Can.c
   and CanDrives.c use this file. GNU C99, Linux. */

#ifndef CAN_BUS_H
#define CAN_BUS_H

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

/* An identifier is one of these numbers plus the number of the finger, 1 to 3. Numbers of 16 bits are little-endian. */
#define CAN_CONTROL 0x100               /* to the drives: action (1 start, 2 stop); watchdog time, ms (16 bits each) */
#define CAN_TORQUES 0x200               /* to the drives: four torques in TORQUE_UNIT (16 bits each, signed) */
#define CAN_ENCODERS 0x180              /* from the drives: low 16 bits of four encoder counts */
#define CAN_TENSIONS 0x280              /* from the drives: four tensions in TENSION_UNIT (16 bits each) */
#define CAN_EMERGENCY 0x080             /* from the drives: the watchdog has tripped */

#define TORQUE_UNIT 0.0002              /* N cm */
#define TENSION_UNIT 0.005              /* N */

struct can_bus {
    int socket;
    const char *folder;                 /* folder of the Unix sockets; null for SocketCAN */
};

static double can_seconds(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static struct sockaddr_un can_address(const char *folder, int finger)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};

    /* The drives have address 0. */
    snprintf(address.sun_path, sizeof address.sun_path, "%.80s/%d", folder, finger);
    return address;
}

/* Opens the socket of Can.c for a finger, or the socket of CanDrives.c if finger is 0. place is the name of a CAN
   interface, or the path of a folder for Unix sockets. Only a path contains a slash. */
static int can_open(struct can_bus *bus, const char *place, int finger)
{
    struct sockaddr_can can = {.can_family = AF_CAN};

    bus->folder = strchr(place, '/') != NULL ? place : NULL;
    if (bus->folder != NULL) {
        struct sockaddr_un address = can_address(place, finger);

        bus->socket = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        return bus->socket < 0 ? -1 : bind(bus->socket, (struct sockaddr *)&address, sizeof address);
    }
    can.can_ifindex = (int)if_nametoindex(place);
    bus->socket = can.can_ifindex == 0 ? -1 : socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
    if (bus->socket < 0)
        return -1;
    if (finger != 0) {
        /* The socket of a finger receives only the frames of this finger's drive. */
        struct can_filter filter[3] = {{CAN_ENCODERS + finger, CAN_SFF_MASK}, {CAN_TENSIONS + finger, CAN_SFF_MASK},
            {CAN_EMERGENCY + finger, CAN_SFF_MASK}};

        setsockopt(bus->socket, SOL_CAN_RAW, CAN_RAW_FILTER, filter, sizeof filter);
    }
    return bind(bus->socket, (struct sockaddr *)&can, sizeof can);
}

/* Sends four numbers of 16 bits without waiting. If Can.c receives the frame, the argument `to` is the number of the
   finger. If CanDrives.c receives it, `to` is 0. */
static int can_send(const struct can_bus *bus, int to, unsigned identifier, const int numbers[4])
{
    struct can_frame frame = {.can_id = identifier, .can_dlc = 8};
    int i;

    for (i = 0; i < 4; i++) {
        frame.data[2 * i] = (unsigned char)((unsigned)numbers[i] & 0xFF);
        frame.data[2 * i + 1] = (unsigned char)((unsigned)numbers[i] >> 8 & 0xFF);
    }
    if (bus->folder != NULL) {
        struct sockaddr_un address = can_address(bus->folder, to);

        return sendto(bus->socket, &frame, sizeof frame, MSG_DONTWAIT, (struct sockaddr *)&address, sizeof address) < 0
            ? -1 : 0;
    }
    return send(bus->socket, &frame, sizeof frame, MSG_DONTWAIT) < 0 ? -1 : 0;
}

/* Receives a frame with four numbers. Returns its identifier, or -1 if no frame arrives before the deadline, a time of
   CLOCK_MONOTONIC, s. */
static int can_receive(const struct can_bus *bus, int numbers[4], double deadline)
{
    struct pollfd poll = {.fd = bus->socket, .events = POLLIN};
    struct can_frame frame;
    struct timespec left;
    double seconds = deadline - can_seconds();
    int i;

    seconds = seconds > 0 ? seconds : 0;
    left.tv_sec = (time_t)seconds;
    left.tv_nsec = (long)((seconds - (double)left.tv_sec) * 1e9);
    if (ppoll(&poll, 1, &left, NULL) != 1 || recv(bus->socket, &frame, sizeof frame, MSG_DONTWAIT) != sizeof frame)
        return -1;
    for (i = 0; i < 4; i++)
        numbers[i] = (short)(frame.data[2 * i] | frame.data[2 * i + 1] << 8);
    return (int)(frame.can_id & CAN_SFF_MASK);
}

#endif
