#include "board.h"
#include <string.h>
#include <unistd.h>

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
    /* A board never blocks. Bytes that nobody reads are lost, as on a real line. */
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
    /* The process number makes the unique numbers of two boards with the same address differ. */
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
            board->motion_left = MOTION_MOST;
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
    /* This board has no tactile sensors. */
    case TACTILE_REQUEST: refuse(board, request, 6, request->length - FRAME_OVERHEAD); break;
    }
}

void receive(struct board *board, uint8_t byte, int64_t now)
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

void watch_time(struct board *board, int64_t now)
{
    if (board->state == ENABLED && now - board->last_command > board->watchdog) {
        board->tripped = 1;
        end(board, now);
    }
    if (board->holding && now >= board->hold_until)
        motors_off(board);
}
