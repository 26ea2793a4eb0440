/* Finds frames in a stream of bytes. Each byte is decoded as it arrives, so that little is left to do when a frame
   ends. */

#ifndef FIRMWARE_RECEIVER_H
#define FIRMWARE_RECEIVER_H

#include "frame.h"

/* Must be all zeros at the start. */
struct receiver {
    size_t collected; /* Bytes since the last delimiter. Stays at STUFFED_MOST + 1 once there are too many. */
    size_t next_zero; /* Index of the next byte that stands for a zero. The first byte after a delimiter has index 0. */
    uint32_t crc;     /* CRC of the decoded bytes. */
    struct frame frame;
};

enum received { RECEIVED_NOTHING, RECEIVED_FRAME, RECEIVED_DAMAGE };

/* Takes one byte. Returns RECEIVED_FRAME if the byte completed `receiver->frame`, which stays until the next call. */
enum received receiver_take(struct receiver *receiver, uint8_t byte);

#endif
