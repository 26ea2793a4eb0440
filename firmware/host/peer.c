/* The firmware as a program: a board on a pseudo-terminal that can be opened as a port, with simulated fingers.

       peer ADDRESS...

   The first line of output is the path of the port. The program answers each line on standard input with the true
   joint angles, rad, three for each finger. Read this answer before you write the next line. The end of standard
   input ends the program. */

#define _XOPEN_SOURCE 700

#include "mechanism.h"
#include "../core/board.h"
#include "../core/protocol.h"
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

enum { FINGERS_MOST = 3 };

/* uN m/A. */
enum { TORQUE_CONSTANT = 23400 };

static int line;
static struct finger_traits traits[FINGERS_MOST];
static struct finger fingers[FINGERS_MOST];
static struct mechanism mechanisms[FINGERS_MOST];
/* How much longer each finger may move before its next sample, us. A real finger does not wait for a sample. On a busy
   machine, however, host and board are both delayed by more than any control loop tolerates, so this finger waits. */
static uint32_t motion_left[FINGERS_MOST];
static const uint32_t motion_most = 2000;

uint32_t hal_microseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint32_t)((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u);
}

size_t hal_receive(unsigned number, uint8_t *bytes, size_t room, uint32_t *arrived_at)
{
    /* Bytes that were read but not yet passed on: hal_receive must not return more than one frame at a time. */
    static uint8_t pending[512];
    static size_t begin, end;
    (void)number;
    if (begin == end) {
        ssize_t count = read(line, pending, sizeof pending);
        begin = 0;
        end = count > 0 ? (size_t)count : 0;
    }
    size_t taken = 0;
    while (taken < room && begin < end) {
        bytes[taken] = pending[begin++];
        if (bytes[taken++] == 0)
            break;
    }
    *arrived_at = hal_microseconds();
    return taken;
}

void hal_send(unsigned number, const uint8_t *bytes, size_t length)
{
    (void)number;
    ssize_t written = write(line, bytes, length);
    (void)written;
}

void hal_sample(unsigned finger, struct sensors *sensors)
{
    motion_left[finger] = motion_most;
    mechanism_sample(&mechanisms[finger], sensors);
}

void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS])
{
    for (size_t i = 0; i < MOTORS; i++) {
        mechanisms[finger].torque[i] = 1e-12 * TORQUE_CONSTANT * microamperes[i];
        if (microamperes[i] != 0)
            mechanisms[finger].braked = false;
    }
}

bool hal_touch(unsigned finger, unsigned element, uint16_t *count)
{
    (void)finger;
    (void)element;
    (void)count;
    return false;
}

uint16_t hal_faults(unsigned finger)
{
    (void)finger;
    return 0;
}

void hal_set_toggle(unsigned finger, bool high)
{
    (void)finger;
    (void)high;
}

/* Sets raw mode before the path is printed: a terminal that edits lines or echoes would damage the first frames. The
   far end stays open, because the line would otherwise hang up whenever no host has opened it. */
static bool open_line(void)
{
    struct termios raw;
    line = posix_openpt(O_RDWR | O_NOCTTY);
    if (line < 0 || grantpt(line) < 0 || unlockpt(line) < 0)
        return false;
    int far_end = open(ptsname(line), O_RDWR | O_NOCTTY);
    if (far_end < 0 || tcgetattr(far_end, &raw) < 0)
        return false;
    raw.c_iflag &= ~(tcflag_t)(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | IXOFF | INPCK);
    raw.c_oflag &= ~(tcflag_t)OPOST;
    raw.c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    raw.c_cflag = (raw.c_cflag & ~(tcflag_t)(CSIZE | PARENB | CSTOPB)) | CS8 | CREAD | CLOCAL;
    return tcsetattr(far_end, TCSANOW, &raw) == 0 && fcntl(line, F_SETFL, O_NONBLOCK) == 0;
}

static struct finger_traits traits_of(uint8_t address)
{
    struct finger_traits made = {
        .address = address,
        .unique_number = {'p', 'e', 'e', 'r', address},
        .firmware_version = {1, 0, 0},
        .counts_per_revolution = 2000,
        .gauge_bits = 12,
        .torque_unit = 2000,
        .torque_limit = 23750,
        .shortest_watchdog_ms = 2,
        .capabilities = CAPABILITY_HOLD | CAPABILITY_KEEPS_ZERO,
    };
    for (size_t i = 0; i < MOTORS; i++) {
        made.torque_constants[i] = TORQUE_CONSTANT;
        made.largest_currents[i] = 2100000;
    }
    /* The process number makes the unique number different even for two peers with the same addresses. */
    pid_t process = getpid();
    memcpy(made.unique_number + 8, &process, 4);
    return made;
}

int main(int count, char **arguments)
{
    static struct board board;
    size_t number = 0;
    while (number < FINGERS_MOST && (int)number + 1 < count) {
        traits[number] = traits_of((uint8_t)atoi(arguments[number + 1]));
        mechanism_start(&mechanisms[number]);
        finger_start(&fingers[number], &traits[number], (unsigned)number);
        number++;
    }
    if (number == 0) {
        fprintf(stderr, "usage: peer ADDRESS..., with one to three addresses from 1 to 15 in rising order\n");
        return 1;
    }
    if (!open_line()) {
        perror("peer cannot open a pseudo-terminal");
        return 1;
    }
    board_start(&board, 0, fingers, number);
    printf("%s\n", ptsname(line));
    fflush(stdout);

    uint32_t then = hal_microseconds();
    for (;;) {
        struct pollfd waits[2] = {{line, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
        poll(waits, 2, 1);
        uint32_t now = hal_microseconds(), passed = now - then < motion_most ? now - then : motion_most;
        then = now;
        for (size_t n = 0; n < number; n++) {
            uint32_t motion = fingers[n].state != FINGER_ENABLED || passed < motion_left[n] ? passed : motion_left[n];
            mechanism_advance(&mechanisms[n], motion);
            motion_left[n] -= motion < motion_left[n] ? motion : motion_left[n];
        }
        board_poll(&board);
        if (waits[1].revents != 0) {
            char ignored[64];
            if (read(STDIN_FILENO, ignored, sizeof ignored) <= 0)
                return 0;
            for (size_t n = 0; n < number; n++)
                printf("%.6f %.6f %.6f%c", mechanisms[n].theta[0], mechanisms[n].theta[1], mechanisms[n].theta[2],
                       n + 1 < number ? ' ' : '\n');
            fflush(stdout);
        }
    }
}
