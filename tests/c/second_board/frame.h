/* Frames of the protocol and their encoding on the line. */

#ifndef FRAME_H
#define FRAME_H

#include <stdint.h>

enum { HELLO = 0x1, CONFIGURE = 0x2, COMMAND = 0x3, STOP = 0x4, TACTILE_REQUEST = 0x6 };
enum { IDENTITY = 0x9, CONFIGURED = 0xA, REPLY = 0xB, STOPPED = 0xC, REFUSED = 0xD, TACTILE_EVENT = 0xE };

enum { FRAME_OVERHEAD = 6, FRAME_MAXIMUM = 128, STUFFED_MAXIMUM = 129, WIRE_MAXIMUM = 130 };

struct frame {
    unsigned length;
    uint8_t bytes[FRAME_MAXIMUM];
};

/* Returns the total length of a frame of this type, or 0 for a type that this version of the protocol
   does not have. */
unsigned frame_length(unsigned type);

uint32_t crc32_of(const uint8_t *bytes, unsigned length);

/* Frames are written from the first byte to the last. */
void begin(struct frame *frame, unsigned type, unsigned address, unsigned sequence);
void put8(struct frame *frame, uint32_t value);
void put16(struct frame *frame, uint32_t value);
void put32(struct frame *frame, uint32_t value);

/* Reads a number from a received frame. The least significant byte comes first. */
uint32_t get(const uint8_t *bytes, unsigned count);
int32_t get_signed16(const uint8_t *bytes);

/* Appends the checksum, stuffs the bytes, and appends the delimiter. Returns the number of bytes for the line. */
unsigned to_wire(struct frame *frame, uint8_t wire[WIRE_MAXIMUM]);

/* Decodes the bytes between two delimiters. Returns 0 for a bad frame, else 1 and the frame with its checksum. */
int from_wire(const uint8_t *stuffed, unsigned length, struct frame *frame);

#endif
