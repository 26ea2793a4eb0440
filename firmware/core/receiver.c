#include "receiver.h"

enum received receiver_take(struct receiver *receiver, uint8_t byte, struct frame *frame)
{
    if (byte != 0) {
        if (receiver->collected < STUFFED_MOST)
            receiver->stuffed[receiver->collected] = byte;
        if (receiver->collected <= STUFFED_MOST)
            receiver->collected++;
        return RECEIVED_NOTHING;
    }
    size_t length = receiver->collected;
    receiver->collected = 0;
    /* An empty run between two delimiters is no damage: the host sends delimiters to resynchronise. */
    if (length == 0)
        return RECEIVED_NOTHING;
    if (length > STUFFED_MOST || !frame_from_wire(frame, receiver->stuffed, length))
        return RECEIVED_DAMAGE;
    return RECEIVED_FRAME;
}
