/* A board with one finger, written from docs/board-protocol.md alone. It shares no code with the library, so that the two
   agree only where the page makes them agree.

       second_board ADDRESS         a board on a pseudo-terminal, whose path is the first line of the output
       second_board --check PAGE    the hex examples of the page against the codec below

   A line on its standard input asks where the joints truly are; it prints three angles, rad. The board ends when its standard
   input does, so that it does not outlive whoever started it. */

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define MOTORS 4
#define JOINTS 3

/* Frames */

enum { HELLO = 0x1, CONFIGURE = 0x2, COMMAND = 0x3, STOP = 0x4, TACTILE_REQUEST = 0x6 };
enum { IDENTITY = 0x9, CONFIGURED = 0xA, REPLY = 0xB, STOPPED = 0xC, REFUSED = 0xD, TACTILE_EVENT = 0xE };

enum { FRAME_OVERHEAD = 6, FRAME_MAXIMUM = 128, STUFFED_MAXIMUM = 129, WIRE_MAXIMUM = 130 };

struct frame {
    unsigned length;
    uint8_t bytes[FRAME_MAXIMUM];
};

/* The whole length of a frame of this type, or 0 for a type of another version. */
static unsigned frame_length(unsigned type)
{
    switch (type) {
    case HELLO: return 8;
    case CONFIGURE: return 38;
    case COMMAND: return 15;
    case STOP: return 6;
    case TACTILE_REQUEST: return 7;
    case IDENTITY: return 43;
    case CONFIGURED: return 64;
    case REPLY: return 26;
    case STOPPED: return 8;
    case REFUSED: return 10;
    case TACTILE_EVENT: return 18;
    default: return 0;
    }
}

static uint32_t crc32_of(const uint8_t *bytes, unsigned length)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (unsigned i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            /* 0xEDB88320 is 0x04C11DB7 with its bits in the other order. */
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    return crc ^ 0xFFFFFFFFu;
}

static void put(struct frame *frame, uint32_t value, unsigned bytes)
{
    while (bytes--) {
        frame->bytes[frame->length++] = (uint8_t)(value & 0xFF);
        value >>= 8;
    }
}

static void put8(struct frame *frame, uint32_t value) { put(frame, value, 1); }
static void put16(struct frame *frame, uint32_t value) { put(frame, value, 2); }
static void put32(struct frame *frame, uint32_t value) { put(frame, value, 4); }

static uint32_t get(const uint8_t *bytes, unsigned count)
{
    uint32_t value = 0;
    while (count--)
        value = value << 8 | bytes[count];
    return value;
}

static int32_t get_signed16(const uint8_t *bytes)
{
    int32_t value = (int32_t)get(bytes, 2);
    return value < 0x8000 ? value : value - 0x10000;
}

static void begin(struct frame *frame, unsigned type, unsigned address, unsigned sequence)
{
    frame->length = 0;
    put8(frame, type << 4 | address);
    put8(frame, sequence);
}

/* Appends the check, stuffs, and appends the delimiter. Returns the number of bytes for the line. */
static unsigned to_wire(struct frame *frame, uint8_t wire[WIRE_MAXIMUM])
{
    put32(frame, crc32_of(frame->bytes, frame->length));
    unsigned code = 0, out = 1;
    for (unsigned i = 0; i < frame->length; i++) {
        if (frame->bytes[i]) {
            wire[out++] = frame->bytes[i];
        } else {
            wire[code] = (uint8_t)(out - code);
            code = out++;
        }
    }
    wire[code] = (uint8_t)(out - code);
    wire[out++] = 0;
    return out;
}

/* Takes the bytes between two delimiters. Returns 0 for a bad frame, else 1 and the frame with its check. */
static int from_wire(const uint8_t *stuffed, unsigned length, struct frame *frame)
{
    frame->length = 0;
    unsigned i = 0;
    while (i < length) {
        unsigned code = stuffed[i++];
        if (code == 0 || i + code - 1 > length)
            return 0;
        for (unsigned n = 1; n < code; n++) {
            if (frame->length == FRAME_MAXIMUM)
                return 0;
            frame->bytes[frame->length++] = stuffed[i++];
        }
        /* The last distance leads to the end, which is not a zero of the frame. */
        if (i < length) {
            if (frame->length == FRAME_MAXIMUM)
                return 0;
            frame->bytes[frame->length++] = 0;
        }
    }
    if (frame->length < FRAME_OVERHEAD)
        return 0;
    return get(frame->bytes + frame->length - 4, 4) == crc32_of(frame->bytes, frame->length - 4);
}

/* What this board is */

enum { VERSION = 1, KIND = 0x8000, TORQUE_UNIT = 2000, TORQUE_LIMIT = 23750, WATCHDOG_SHORTEST = 2 };
enum { COUNTS_A_REVOLUTION = 2000, GAUGE_BITS = 12 };
enum { CAN_HOLD = 1 << 0, COUNTS_SURVIVE = 1 << 1 };

enum {
    IS_CONFIGURED = 1 << 0,
    IS_ENABLED = 1 << 1,
    WATCHDOG_TRIPPED = 1 << 2,
    HAS_ENDED = 1 << 3,
    IS_HOLDING = 1 << 4,
    ZERO_VALID = 1 << 5,
    TORQUE_CLIPPED = 1 << 10,
    DAMAGED_INPUT = 1 << 11
};

/* The finger: four motors, each pulling one elastic tendon, and three joints whose inertias do not couple. SI units. */

static const double pi = 3.14159265358979323846;
static const double pulley = 4.75e-4;
static const double stiffness = 30000.0;
static const double rotor_inertia = 6e-7, rotor_damping = 2e-6;
static const double joint_inertia[JOINTS] = {3.7e-4, 1.4e-4, 2.5e-5};
/* More than a real finger has: it stands for the friction and the coupling that are left out. */
static const double joint_damping[JOINTS] = {2e-3, 2e-3, 2e-3};
static const double gauge_range = 100.0;
static const double start_degrees[JOINTS] = {0.0, 30.0, 60.0};
static const double stop_degrees[JOINTS][2] = {{-63.0, 63.0}, {-33.0, 103.0}, {2.0, 123.0}};

/* Joint torque of each tendon's tension, m. A pull on a tendon's motor shortens it, and so turns the joints this way. */
static const double R[JOINTS][MOTORS] = {
    {-0.0109, 0.0062, 0.0062, -0.0109},
    {0.0109, 0.0062, -0.0062, -0.0109},
    {0, 0.0062, -0.0062, 0},
};
/* Tensions at which no joint feels a torque, and the least is 5 N. */
static const double home_tension[MOTORS] = {5.0, 5.0 * 109 / 62, 5.0 * 109 / 62, 5.0};

struct plant {
    double theta[JOINTS], theta_rate[JOINTS];
    double motor[MOTORS], motor_rate[MOTORS];
    double torque[MOTORS], tension[MOTORS];
    int braked;
    /* Time that the finger has lived through. It lags behind the world's where the machine was too busy. */
    int64_t clock;
};

static void find_tensions(struct plant *plant)
{
    for (int i = 0; i < MOTORS; i++) {
        double stretch = pulley * plant->motor[i];
        for (int j = 0; j < JOINTS; j++)
            stretch -= R[j][i] * plant->theta[j];
        plant->tension[i] = stretch > 0 ? stiffness * stretch : 0;
    }
}

static void start_plant(struct plant *plant)
{
    memset(plant, 0, sizeof *plant);
    for (int j = 0; j < JOINTS; j++)
        plant->theta[j] = start_degrees[j] * pi / 180;
    for (int i = 0; i < MOTORS; i++) {
        double pulled = home_tension[i] / stiffness;
        for (int j = 0; j < JOINTS; j++)
            pulled += R[j][i] * plant->theta[j];
        plant->motor[i] = pulled / pulley;
    }
    plant->braked = 1;
    find_tensions(plant);
}

static void step_plant(struct plant *plant, double h)
{
    find_tensions(plant);
    for (int i = 0; i < MOTORS; i++) {
        double torque = plant->torque[i] - pulley * plant->tension[i] - rotor_damping * plant->motor_rate[i];
        plant->motor_rate[i] = plant->braked ? 0 : plant->motor_rate[i] + h * torque / rotor_inertia;
        plant->motor[i] += h * plant->motor_rate[i];
    }
    for (int j = 0; j < JOINTS; j++) {
        double torque = -joint_damping[j] * plant->theta_rate[j];
        for (int i = 0; i < MOTORS; i++)
            torque += R[j][i] * plant->tension[i];
        plant->theta_rate[j] += h * torque / joint_inertia[j];
        plant->theta[j] += h * plant->theta_rate[j];
        for (int side = 0; side < 2; side++) {
            double beyond = plant->theta[j] - stop_degrees[j][side] * pi / 180;
            if (side ? beyond > 0 : beyond < 0) {
                plant->theta[j] -= beyond;
                plant->theta_rate[j] = 0;
            }
        }
    }
}

static void advance_plant(struct plant *plant, int64_t nanoseconds)
{
    const int64_t step = 50000;
    plant->clock += nanoseconds;
    while (nanoseconds > 0) {
        int64_t now = nanoseconds < step ? nanoseconds : step;
        step_plant(plant, 1e-9 * (double)now);
        nanoseconds -= now;
    }
    find_tensions(plant);
}

/* Zero is the straight finger under the tension of the start. */
static int32_t encoder(const struct plant *plant, int i)
{
    double angle = plant->motor[i] - home_tension[i] / stiffness / pulley;
    return (int32_t)floor(angle * COUNTS_A_REVOLUTION / (2 * pi));
}

/* With the noise of a converter, one count up or down: the library takes a gauge that shows one count for ever for a dead one. */
static unsigned gauge(const struct plant *plant, int i)
{
    static uint32_t random = 1;
    const double counts = 1 << GAUGE_BITS;
    random = random * 1664525u + 1013904223u;
    double count = floor(plant->tension[i] * counts / gauge_range + 0.5) + (double)(random >> 16) * 3 / 65536 - 1;
    return (unsigned)(count < 0 ? 0 : count < counts - 1 ? count : counts - 1);
}

/* The board */

enum state { IDLE, READY, ENABLED, ENDED };

struct board {
    int line;
    unsigned address;
    enum state state;
    int tripped, holding, damaged;
    int64_t last_command, hold_until;
    /* How much longer the finger may move before the next Command. */
    int64_t motion_left;

    uint8_t configure[32];
    int64_t watchdog, hold_time;
    int hold;
    int32_t hold_limit, limit[MOTORS], torque[MOTORS];

    /* What has come in since the last zero. One byte more than fits a frame marks one that is too long. */
    unsigned collected;
    uint8_t stuffed[STUFFED_MAXIMUM + 1];

    struct plant plant;
};

/* The longest motion in one wake-up of the board, and from one Command to the next, ns. */
static const int64_t motion_most = 2000000;

static int64_t nanoseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int32_t clip(int32_t value, int32_t limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

static void set_torques(struct board *board, const int32_t torque[MOTORS])
{
    for (int i = 0; i < MOTORS; i++) {
        board->torque[i] = torque[i];
        board->plant.torque[i] = 1e-9 * TORQUE_UNIT * torque[i];
    }
}

static void motors_off(struct board *board)
{
    static const int32_t none[MOTORS] = {0};
    board->holding = 0;
    set_torques(board, none);
}

static void end(struct board *board, int64_t now)
{
    if (board->state == ENABLED && board->hold && board->hold_time > 0) {
        int32_t torque[MOTORS];
        for (int i = 0; i < MOTORS; i++)
            torque[i] = clip(board->torque[i], board->hold_limit);
        set_torques(board, torque);
        board->holding = 1;
        board->hold_until = now + board->hold_time;
    } else {
        motors_off(board);
    }
    board->state = ENDED;
}

static unsigned status(const struct board *board)
{
    return (board->state != IDLE ? IS_CONFIGURED : 0u) | (board->state == ENABLED ? IS_ENABLED : 0u) |
           (board->tripped ? WATCHDOG_TRIPPED : 0u) | (board->state == ENDED ? HAS_ENDED : 0u) |
           (board->holding ? IS_HOLDING : 0u) | ZERO_VALID;
}

static void send_frame(struct board *board, struct frame *frame)
{
    uint8_t wire[WIRE_MAXIMUM];
    unsigned length = to_wire(frame, wire);
    /* As on a real line, what nobody takes is lost: a board never waits. */
    ssize_t written = write(board->line, wire, length);
    (void)written;
}

static void refuse(struct board *board, const struct frame *request, unsigned reason, unsigned detail)
{
    struct frame answer;
    begin(&answer, REFUSED, board->address, request->bytes[1]);
    put8(&answer, request->bytes[0] >> 4);
    put8(&answer, reason);
    put16(&answer, detail);
    send_frame(board, &answer);
}

static void hello(struct board *board, const struct frame *request)
{
    if (request->bytes[2] > VERSION || request->bytes[3] < VERSION) {
        refuse(board, request, 1, VERSION | VERSION << 8);
        return;
    }
    struct frame answer;
    begin(&answer, IDENTITY, board->address, request->bytes[1]);
    put8(&answer, VERSION);
    put16(&answer, 1u << board->address);
    put16(&answer, KIND);
    /* Two boards may be built alike and differ in their addresses only. The process makes them unique. */
    put32(&answer, 0x5EC02D);
    put32(&answer, (uint32_t)getpid());
    put32(&answer, board->address);
    put8(&answer, 1);
    put8(&answer, 0);
    put8(&answer, 0);
    put32(&answer, COUNTS_A_REVOLUTION);
    put8(&answer, GAUGE_BITS);
    put32(&answer, TORQUE_UNIT);
    put16(&answer, TORQUE_LIMIT);
    put16(&answer, WATCHDOG_SHORTEST);
    put32(&answer, CAN_HOLD | COUNTS_SURVIVE);
    send_frame(board, &answer);
}

static void configure(struct board *board, const struct frame *request)
{
    const uint8_t *bytes = request->bytes;
    if (board->state == ENABLED) {
        refuse(board, request, 4, 0);
        return;
    }
    unsigned wrong = 0;
    if (bytes[2] != VERSION)
        wrong = 2;
    else if (get(bytes + 3, 2) < WATCHDOG_SHORTEST)
        wrong = 3;
    else if (bytes[5] > 1)
        wrong = 5;
    for (unsigned i = 0; i < MOTORS && !wrong; i++)
        if (get(bytes + 10 + 2 * i, 2) > TORQUE_LIMIT)
            wrong = 10 + 2 * i;
    if (wrong) {
        refuse(board, request, 2, wrong);
        return;
    }

    memcpy(board->configure, bytes + 2, sizeof board->configure);
    board->watchdog = 1000000 * (int64_t)get(bytes + 3, 2);
    board->hold = bytes[5] == 1;
    board->hold_time = 1000000 * (int64_t)get(bytes + 6, 2);
    board->hold_limit = (int32_t)get(bytes + 8, 2);
    for (int i = 0; i < MOTORS; i++)
        board->limit[i] = (int32_t)get(bytes + 10 + 2 * i, 2);
    motors_off(board);
    board->tripped = 0;
    board->state = READY;

    struct frame answer;
    begin(&answer, CONFIGURED, board->address, bytes[1]);
    for (unsigned i = 0; i < sizeof board->configure; i++)
        put8(&answer, board->configure[i]);
    for (int i = 0; i < MOTORS; i++)
        put32(&answer, (uint32_t)encoder(&board->plant, i));
    for (int i = 0; i < MOTORS; i++)
        put16(&answer, gauge(&board->plant, i));
    put16(&answer, status(board));
    send_frame(board, &answer);
}

static void command(struct board *board, const struct frame *request, int64_t now)
{
    const uint8_t *bytes = request->bytes;
    if (board->state == IDLE) {
        refuse(board, request, 3, 0);
        return;
    }
    int clipped = 0;
    if (board->state != ENDED) {
        if (bytes[2] & 2) {
            int32_t torque[MOTORS];
            for (int i = 0; i < MOTORS; i++) {
                int32_t wanted = get_signed16(bytes + 3 + 2 * i);
                torque[i] = clip(wanted, board->limit[i]);
                clipped |= torque[i] != wanted;
            }
            set_torques(board, torque);
            board->plant.braked = 0;
            board->state = ENABLED;
            board->last_command = now;
            board->motion_left = motion_most;
        } else {
            motors_off(board);
            board->state = READY;
        }
    }

    struct frame answer;
    begin(&answer, REPLY, board->address, bytes[1]);
    put16(&answer, status(board) | (clipped ? TORQUE_CLIPPED : 0u) | (board->damaged ? DAMAGED_INPUT : 0u));
    board->damaged = 0;
    for (int i = 0; i < MOTORS; i++)
        put16(&answer, (uint32_t)encoder(&board->plant, i));
    for (int i = 0; i < MOTORS; i++)
        put16(&answer, gauge(&board->plant, i));
    put16(&answer, (uint32_t)(board->plant.clock / 1000));
    send_frame(board, &answer);
}

static void stop(struct board *board, const struct frame *request, int64_t now)
{
    if (board->state == READY || board->state == ENABLED)
        end(board, now);
    struct frame answer;
    begin(&answer, STOPPED, board->address, request->bytes[1]);
    put16(&answer, status(board));
    send_frame(board, &answer);
}

static void answer(struct board *board, const struct frame *request, int64_t now)
{
    unsigned type = request->bytes[0] >> 4, address = request->bytes[0] & 0xF;
    if (type & 8)
        return;
    if (address != board->address && !(address == 0 && type == HELLO))
        return;
    if (request->length != frame_length(type)) {
        refuse(board, request, 6, request->length - FRAME_OVERHEAD);
        return;
    }
    switch (type) {
    case HELLO: hello(board, request); break;
    case CONFIGURE: configure(board, request); break;
    case COMMAND: command(board, request, now); break;
    case STOP: stop(board, request, now); break;
    /* It feels nothing. */
    case TACTILE_REQUEST: refuse(board, request, 6, request->length - FRAME_OVERHEAD); break;
    }
}

static void receive(struct board *board, uint8_t byte, int64_t now)
{
    if (byte) {
        if (board->collected < sizeof board->stuffed)
            board->stuffed[board->collected++] = byte;
        return;
    }
    unsigned length = board->collected;
    board->collected = 0;
    struct frame request;
    if (length == 0)
        return;
    if (length <= STUFFED_MAXIMUM && from_wire(board->stuffed, length, &request))
        answer(board, &request, now);
    else
        board->damaged = 1;
}

static int fail(const char *what)
{
    fprintf(stderr, "second_board: %s: %s\n", what, strerror(errno));
    return 1;
}

/* Raw before the path is known to anybody: a terminal that edits lines or echoes would damage the first frames. */
static int open_line(int *line, int *far_end)
{
    struct termios raw;
    *line = posix_openpt(O_RDWR | O_NOCTTY);
    if (*line < 0 || grantpt(*line) < 0 || unlockpt(*line) < 0)
        return -1;
    /* The far end stays open here too, or the line would report a hang-up whenever no host has it open. */
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

        /* The finger waits for a host that is late, and is not moved far by a board that is. No real finger does either, but
           on a busy machine both are late by more than any loop can bear. */
        int64_t now = nanoseconds();
        int64_t motion = now - then < motion_most ? now - then : motion_most;
        if (board.state == ENABLED) {
            if (motion > board.motion_left)
                motion = board.motion_left;
            board.motion_left -= motion;
        }
        advance_plant(&board.plant, motion);
        then = now;

        /* Input before the watchdog: what has arrived in time counts, however late it is looked at. */
        uint8_t bytes[512];
        ssize_t count = waits[0].revents & POLLIN ? read(board.line, bytes, sizeof bytes) : 0;
        for (ssize_t i = 0; i < count; i++)
            receive(&board, bytes[i], now);
        if (board.state == ENABLED && now - board.last_command > board.watchdog) {
            board.tripped = 1;
            end(&board, now);
        }
        if (board.holding && now >= board.hold_until)
            motors_off(&board);

        if (waits[1].revents) {
            char ignored[64];
            if (read(STDIN_FILENO, ignored, sizeof ignored) <= 0)
                return 0;
            printf("%.6f %.6f %.6f\n", board.plant.theta[0], board.plant.theta[1], board.plant.theta[2]);
            fflush(stdout);
        }
    }
}

/* The examples of the page, from the values that stand beside them. */

static void put_example_configure(struct frame *frame)
{
    put8(frame, 1);
    put16(frame, 20);
    put8(frame, 1);
    put16(frame, 2000);
    put16(frame, 5000);
    for (int i = 0; i < MOTORS; i++)
        put16(frame, 23750);
    for (int i = 0; i < MOTORS; i++)
        put32(frame, 23400);
}

static const char *const example_names[] = {"Hello",   "Identity", "Configure", "Configured", "Stop",
                                            "Stopped", "Refused",  "Command",   "Reply",      "TactileRequest", "TactileEvent"};
enum { EXAMPLES = sizeof example_names / sizeof *example_names };

static void build_example(int which, struct frame *frame)
{
    static const uint32_t encoders[MOTORS] = {100000, 0xFFFFFFFF, 0, 65536}, gauges[MOTORS] = {410, 205, 205, 410};
    switch (which) {
    case 0:
        begin(frame, HELLO, 1, 1);
        put8(frame, 1);
        put8(frame, 1);
        break;
    case 1:
        begin(frame, IDENTITY, 1, 1);
        put8(frame, 1);
        put16(frame, 1 << 1 | 1 << 2 | 1 << 3);
        put16(frame, 0x8000);
        for (unsigned i = 1; i <= 12; i++)
            put8(frame, i);
        put8(frame, 1);
        put8(frame, 2);
        put8(frame, 3);
        put32(frame, 2000);
        put8(frame, 12);
        put32(frame, 2000);
        put16(frame, 23750);
        put16(frame, 2);
        put32(frame, 1 << 0 | 1 << 1 | 1 << 2 | 1 << 3);
        break;
    case 2:
        begin(frame, CONFIGURE, 1, 2);
        put_example_configure(frame);
        break;
    case 3:
        begin(frame, CONFIGURED, 1, 2);
        put_example_configure(frame);
        for (int i = 0; i < MOTORS; i++)
            put32(frame, encoders[i]);
        for (int i = 0; i < MOTORS; i++)
            put16(frame, gauges[i]);
        put16(frame, IS_CONFIGURED | ZERO_VALID);
        break;
    case 4:
        begin(frame, STOP, 1, 3);
        break;
    case 5:
        begin(frame, STOPPED, 1, 3);
        put16(frame, IS_CONFIGURED | HAS_ENDED | ZERO_VALID);
        break;
    case 6:
        begin(frame, REFUSED, 1, 9);
        put8(frame, COMMAND);
        put8(frame, 3);
        put16(frame, 0);
        break;
    case 7:
        begin(frame, COMMAND, 1, 7);
        put8(frame, 1 | 2);
        put16(frame, 1188);
        put16(frame, 594);
        put16(frame, 0);
        put16(frame, 0xFFFF);
        break;
    case 8:
        begin(frame, REPLY, 1, 7);
        put16(frame, IS_CONFIGURED | IS_ENABLED | ZERO_VALID);
        for (int i = 0; i < MOTORS; i++)
            put16(frame, encoders[i]);
        for (int i = 0; i < MOTORS; i++)
            put16(frame, gauges[i]);
        put16(frame, 12345);
        break;
    case 9:
        begin(frame, TACTILE_REQUEST, 1, 5);
        put8(frame, 254);
        break;
    case 10:
        begin(frame, TACTILE_EVENT, 1, 5);
        put8(frame, 2);
        put8(frame, 255);
        put8(frame, 1);
        put16(frame, 300);
        put16(frame, 4095);
        put32(frame, 4000000000u);
        put8(frame, 0);
        break;
    }
}

/* Returns what is wrong with the example, or null. */
static const char *check_example(int which, const uint8_t *wire, unsigned length)
{
    struct frame own, decoded;
    uint8_t encoded[WIRE_MAXIMUM];
    build_example(which, &own);
    unsigned own_length = to_wire(&own, encoded);
    if (length == 0 || memchr(wire, 0, length) != wire + length - 1)
        return "is not ended by its only zero";
    if (!from_wire(wire, length - 1, &decoded))
        return "does not decode";
    if (decoded.length != frame_length(decoded.bytes[0] >> 4) || length != decoded.length + 2)
        return "has not the length of its type";
    if (decoded.length != own.length || memcmp(decoded.bytes, own.bytes, own.length) != 0)
        return "is not what the text beside it says";
    if (own_length != length || memcmp(encoded, wire, length) != 0)
        return "is stuffed differently";
    return NULL;
}

static int check(const char *path)
{
    FILE *page = fopen(path, "r");
    if (!page)
        return fail(path);
    int wrong = 0, found[EXAMPLES] = {0}, which = -1;
    unsigned length = 0;
    uint8_t wire[WIRE_MAXIMUM];
    char text[1024], name[32];
    if (crc32_of((const uint8_t *)"123456789", 9) != 0xCBF43926u) {
        printf("the check of 123456789 differs\n");
        wrong = 1;
    }
    while (fgets(text, sizeof text, page)) {
        if (sscanf(text, "```hex %31s", name) == 1) {
            for (which = 0; which < EXAMPLES && strcmp(name, example_names[which]) != 0; which++)
                ;
            length = 0;
            if (which == EXAMPLES) {
                printf("%s: unknown here\n", name);
                wrong = 1;
                which = -1;
            }
        } else if (strncmp(text, "```", 3) == 0 && which >= 0) {
            const char *complaint = check_example(which, wire, length);
            printf("%s: %s\n", example_names[which], complaint ? complaint : "agrees");
            wrong |= complaint != NULL;
            found[which] = 1;
            which = -1;
        } else if (which >= 0) {
            unsigned value;
            int used;
            for (const char *at = text; sscanf(at, "%2x%n", &value, &used) == 1 && length < WIRE_MAXIMUM; at += used)
                wire[length++] = (uint8_t)value;
        }
    }
    fclose(page);
    for (int i = 0; i < EXAMPLES; i++)
        if (!found[i]) {
            printf("%s: not on the page\n", example_names[i]);
            wrong = 1;
        }
    return wrong;
}

int main(int count, char **arguments)
{
    if (count == 3 && strcmp(arguments[1], "--check") == 0)
        return check(arguments[2]);
    int address = count == 2 ? atoi(arguments[1]) : 0;
    if (address < 1 || address > 15) {
        fprintf(stderr, "usage: second_board ADDRESS (1 to 15), or second_board --check PAGE\n");
        return 2;
    }
    return run((unsigned)address);
}
