/* Finds frames in a stream of bytes. */

#ifndef FIRMWARE_RECEIVER_H
#define FIRMWARE_RECEIVER_H

#include "frame.h"

/* All zeros to begin with. */
struct receiver {
    size_t collected; /* Since the last delimiter; one more than fits a frame means too many. */
    uint8_t stuffed[STUFFED_MOST];
};

enum received { RECEIVED_NOTHING, RECEIVED_FRAME, RECEIVED_DAMAGE };

/* Takes one byte. RECEIVED_FRAME: it completed `frame`. */
enum received receiver_take(struct receiver *receiver, uint8_t byte, struct frame *frame);

#endif
