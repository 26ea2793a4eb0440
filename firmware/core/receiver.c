#include "receiver.h"
#include "crc32.h"

/* Takes a byte that is not the delimiter. */
static void collect(struct receiver *receiver, uint8_t byte)
{
    size_t place = receiver->collected;
    if (place > STUFFED_MOST)
        return;
    receiver->collected = place + 1;
    if (place == STUFFED_MOST)
        return;
    /* The first byte is the distance to the first zero. It replaces no byte of the frame. */
    if (place == 0) {
        receiver->next_zero = byte;
        receiver->crc = CRC32_START;
        return;
    }
    /* Each later distance has replaced a zero, so it becomes zero again. All other bytes stay as they are. */
    if (place == receiver->next_zero) {
        receiver->next_zero = place + byte;
        byte = 0;
    }
    receiver->frame.bytes[place - 1] = byte;
    receiver->crc = crc32_add(receiver->crc, byte);
}

enum received receiver_take(struct receiver *receiver, uint8_t byte)
{
    if (byte != 0) {
        collect(receiver, byte);
        return RECEIVED_NOTHING;
    }
    size_t collected = receiver->collected;
    receiver->collected = 0;
    /* An empty run between two delimiters is no damage: the host sends delimiters to resynchronise. */
    if (collected == 0)
        return RECEIVED_NOTHING;
    /* The first distance is not a byte of the frame, hence the 1. The last distance must lead to the delimiter. */
    if (collected < 1 + FRAME_LEAST || collected > STUFFED_MOST || receiver->next_zero != collected ||
        receiver->crc != CRC32_WITH_CHECK)
        return RECEIVED_DAMAGE;
    receiver->frame.length = collected - 1 - FRAME_CHECK;
    return RECEIVED_FRAME;
}
