/* A frame: header, sequence number, body and checksum; and its bytes on the wire. */

#ifndef FIRMWARE_FRAME_H
#define FIRMWARE_FRAME_H

#include <stddef.h>
#include <stdint.h>

enum {
    FRAME_PREFIX = 2, /* Header and sequence number. */
    FRAME_CHECK = 4,
    FRAME_LEAST = FRAME_PREFIX + FRAME_CHECK,
    FRAME_MOST = 128,
    STUFFED_MOST = FRAME_MOST + 1,
    WIRE_MOST = STUFFED_MOST + 1
};

/* A frame without its checksum. The checksum of a received frame has been verified. If the frame is sent,
   frame_to_wire appends the checksum. */
struct frame {
    size_t length;
    uint8_t bytes[FRAME_MOST];
};

uint8_t frame_type(const struct frame *frame);
uint8_t frame_address(const struct frame *frame);
uint8_t frame_sequence(const struct frame *frame);
size_t frame_body_length(const struct frame *frame);

/* Little-endian numbers. `offset` counts from the header, as in the tables of the protocol. */
uint8_t frame_get8(const struct frame *frame, size_t offset);
uint16_t frame_get16(const struct frame *frame, size_t offset);
uint32_t frame_get32(const struct frame *frame, size_t offset);

void frame_begin(struct frame *frame, uint8_t type, uint8_t address, uint8_t sequence);
void frame_put8(struct frame *frame, uint8_t value);
void frame_put16(struct frame *frame, uint16_t value);
void frame_put32(struct frame *frame, uint32_t value);

/* Appends the checksum, stuffs the bytes, and then appends the delimiter. Returns the length on the wire. */
size_t frame_to_wire(const struct frame *frame, uint8_t wire[WIRE_MOST]);

#endif
