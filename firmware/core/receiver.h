/* Finds frames in a stream of bytes. */

#ifndef FIRMWARE_RECEIVER_H
#define FIRMWARE_RECEIVER_H

#include "frame.h"

/* Must be all zeros at the start. */
struct receiver {
    size_t collected; /* Bytes since the last delimiter. Stays at STUFFED_MOST + 1 once there are too many. */
    uint8_t stuffed[STUFFED_MOST];
};

enum received { RECEIVED_NOTHING, RECEIVED_FRAME, RECEIVED_DAMAGE };

/* Takes one byte. Returns RECEIVED_FRAME if the byte completed `frame`. */
enum received receiver_take(struct receiver *receiver, uint8_t byte, struct frame *frame);

#endif
