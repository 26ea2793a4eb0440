#include "board.h"
#include "protocol.h"
#include <string.h>

void board_start(struct board *board, unsigned line, struct finger *fingers, size_t count)
{
    memset(board, 0, sizeof *board);
    board->line = line;
    board->fingers = fingers;
    board->count = count;
}

/* The finger that a request addresses, or NULL if it is not on this board. */
static struct finger *meant(struct board *board, const struct frame *request)
{
    if (frame_address(request) == ANY_ADDRESS)
        return frame_type(request) == TYPE_HELLO && board->count > 0 ? &board->fingers[0] : NULL;
    for (size_t i = 0; i < board->count; i++)
        if (board->fingers[i].traits->address == frame_address(request))
            return &board->fingers[i];
    return NULL;
}

static uint16_t addresses(const struct board *board)
{
    unsigned bits = 0;
    for (size_t i = 0; i < board->count; i++)
        bits |= 1u << board->fingers[i].traits->address;
    return (uint16_t)bits;
}

/* The body length of a request type, or -1 if this board does not know the type. */
static int expected_length(uint8_t type)
{
    switch (type) {
    case TYPE_HELLO: return HELLO_LENGTH;
    case TYPE_CONFIGURE: return CONFIGURE_LENGTH;
    case TYPE_COMMAND: return COMMAND_LENGTH;
    case TYPE_STOP: return STOP_LENGTH;
    case TYPE_TACTILE_REQUEST: return TACTILE_REQUEST_LENGTH;
    default: return -1;
    }
}

static void answer(struct board *board, const struct frame *request, uint32_t arrived_at)
{
    /* Answers are never answered: a short-circuited line echoes what was sent. */
    struct finger *finger = frame_type(request) & TYPE_IS_ANSWER ? NULL : meant(board, request);
    if (finger == NULL)
        return;
    /* Applies every time-out that expired before this request arrived. */
    finger_tick(finger, arrived_at);

    struct frame reply;
    size_t length = frame_body_length(request);
    if ((int)length != expected_length(frame_type(request))) {
        finger_refuse(finger, request, REASON_UNKNOWN_FRAME, (uint16_t)length, &reply);
    } else {
        switch (frame_type(request)) {
        case TYPE_HELLO: finger_hello(finger, request, addresses(board), &reply); break;
        case TYPE_CONFIGURE: finger_configure(finger, request, &reply); break;
        case TYPE_COMMAND: finger_command(finger, request, arrived_at, &reply); break;
        case TYPE_TACTILE_REQUEST: finger_touch(finger, request, &reply); break;
        default: finger_stop(finger, request, arrived_at, &reply); break;
        }
    }
    uint8_t wire[WIRE_MOST];
    hal_send(board->line, wire, frame_to_wire(&reply, wire));
}

void board_poll(struct board *board)
{
    uint8_t bytes[64];
    size_t taken = 0;
    uint32_t now = hal_microseconds(), arrived_at = now;
    /* Takes at most 32 runs of bytes: a line that never falls silent must not keep the watchdogs from running. */
    for (int runs = 0; runs < 32 && (taken = hal_receive(board->line, bytes, sizeof bytes, &arrived_at)) > 0; runs++) {
        for (size_t i = 0; i < taken; i++) {
            enum received received = receiver_take(&board->receiver, bytes[i]);
            if (received == RECEIVED_FRAME)
                answer(board, &board->receiver.frame, arrived_at);
            for (size_t n = 0; received == RECEIVED_DAMAGE && n < board->count; n++)
                board->fingers[n].damaged = true;
        }
    }
    /* A time-out must not overtake a Command that arrived before it and waits in the buffer. If no input is left,
       everything that arrived until the time `now` has been taken. Otherwise, only what arrived before the last frame
       has certainly been taken. */
    if (taken > 0 || (int32_t)(arrived_at - now) > 0)
        now = arrived_at;
    for (size_t n = 0; n < board->count; n++)
        finger_tick(&board->fingers[n], now);
}
