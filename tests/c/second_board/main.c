/* A board with one finger, written from docs/board-protocol.md alone. It shares no code with the library, so the two
   can agree only through the page.

       second_board ADDRESS         a board on a pseudo-terminal, whose path is the first line of the output
       second_board --check PAGE    compares the hex examples of the page with the codec in frame.c

   For each line on its standard input the board prints the three true joint angles, rad. It ends when its standard
   input ends, so that it does not outlive the program that started it. */

#include "board.h"
#include "examples.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static int64_t nanoseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int fail(const char *what)
{
    fprintf(stderr, "second_board: %s: %s\n", what, strerror(errno));
    return 1;
}

/* Sets raw mode before the path is printed: a terminal that edits lines or echoes would damage the first frames. */
static int open_line(int *line, int *far_end)
{
    struct termios raw;
    *line = posix_openpt(O_RDWR | O_NOCTTY);
    if (*line < 0 || grantpt(*line) < 0 || unlockpt(*line) < 0)
        return -1;
    /* This process keeps the far end open too. Otherwise the line would report a hang-up while no host is connected. */
    *far_end = open(ptsname(*line), O_RDWR | O_NOCTTY);
    if (*far_end < 0 || tcgetattr(*far_end, &raw) < 0)
        return -1;
    raw.c_iflag &= ~(tcflag_t)(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | IXOFF | INPCK);
    raw.c_oflag &= ~(tcflag_t)OPOST;
    raw.c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    raw.c_cflag = (raw.c_cflag & ~(tcflag_t)(CSIZE | PARENB | CSTOPB)) | CS8 | CREAD | CLOCAL;
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    if (tcsetattr(*far_end, TCSANOW, &raw) < 0)
        return -1;
    return fcntl(*line, F_SETFL, O_NONBLOCK);
}

static int run(unsigned address)
{
    static struct board board;
    int far_end;
    board.address = address;
    start_plant(&board.plant);
    if (open_line(&board.line, &far_end) < 0)
        return fail("pseudo-terminal");
    printf("%s\n", ptsname(board.line));
    fflush(stdout);

    int64_t then = nanoseconds();
    for (;;) {
        struct pollfd waits[2] = {{board.line, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
        if (poll(waits, 2, 1) < 0 && errno != EINTR)
            return fail("poll");

        /* Limits how long the finger moves before the host's next Command, and in one wake-up of the board. A real
           finger has no such limit. The simulated one needs it, because Commands and wake-ups on a busy machine are
           later than any control loop tolerates. */
        int64_t now = nanoseconds();
        int64_t motion = now - then < MOTION_MOST ? now - then : MOTION_MOST;
        if (board.state == ENABLED) {
            if (motion > board.motion_left)
                motion = board.motion_left;
            board.motion_left -= motion;
        }
        advance_plant(&board.plant, motion);
        then = now;

        /* Input is read before the watchdog is checked: a Command that arrived in time counts, however late it is
           read. */
        uint8_t bytes[512];
        ssize_t count = waits[0].revents & POLLIN ? read(board.line, bytes, sizeof bytes) : 0;
        for (ssize_t i = 0; i < count; i++)
            receive(&board, bytes[i], now);
        watch_time(&board, now);

        if (waits[1].revents) {
            char ignored[64];
            if (read(STDIN_FILENO, ignored, sizeof ignored) <= 0)
                return 0;
            printf("%.6f %.6f %.6f\n", board.plant.theta[0], board.plant.theta[1], board.plant.theta[2]);
            fflush(stdout);
        }
    }
}

int main(int count, char **arguments)
{
    if (count == 3 && strcmp(arguments[1], "--check") == 0)
        return check_page(arguments[2]);
    int address = count == 2 ? atoi(arguments[1]) : 0;
    if (address < 1 || address > 15) {
        fprintf(stderr, "usage: second_board ADDRESS (1 to 15), or second_board --check PAGE\n");
        return 2;
    }
    return run((unsigned)address);
}
