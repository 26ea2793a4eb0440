#include "frame.h"
#include "crc32.h"
#include "stuffing.h"

uint8_t frame_type(const struct frame *frame)
{
    return (uint8_t)(frame->bytes[0] >> 4);
}

uint8_t frame_address(const struct frame *frame)
{
    return frame->bytes[0] & 0xFu;
}

uint8_t frame_sequence(const struct frame *frame)
{
    return frame->bytes[1];
}

size_t frame_body_length(const struct frame *frame)
{
    return frame->length - FRAME_PREFIX;
}

uint8_t frame_get8(const struct frame *frame, size_t offset)
{
    return frame->bytes[offset];
}

uint16_t frame_get16(const struct frame *frame, size_t offset)
{
    return (uint16_t)(frame->bytes[offset] | frame->bytes[offset + 1] << 8);
}

uint32_t frame_get32(const struct frame *frame, size_t offset)
{
    return frame_get16(frame, offset) | (uint32_t)frame_get16(frame, offset + 2) << 16;
}

void frame_begin(struct frame *frame, uint8_t type, uint8_t address, uint8_t sequence)
{
    frame->length = 0;
    frame_put8(frame, (uint8_t)(type << 4 | address));
    frame_put8(frame, sequence);
}

void frame_put8(struct frame *frame, uint8_t value)
{
    frame->bytes[frame->length++] = value;
}

void frame_put16(struct frame *frame, uint16_t value)
{
    frame_put8(frame, (uint8_t)(value & 0xFFu));
    frame_put8(frame, (uint8_t)(value >> 8));
}

void frame_put32(struct frame *frame, uint32_t value)
{
    frame_put16(frame, (uint16_t)(value & 0xFFFFu));
    frame_put16(frame, (uint16_t)(value >> 16));
}

size_t frame_to_wire(const struct frame *frame, uint8_t wire[WIRE_MOST])
{
    struct stuffing stuffing;
    stuff_begin(&stuffing, wire);
    uint32_t crc = CRC32_START;
    for (size_t i = 0; i < frame->length; i++) {
        crc = crc32_add(crc, frame->bytes[i]);
        stuff(&stuffing, frame->bytes[i]);
    }
    for (size_t i = 0; i < FRAME_CHECK; i++)
        stuff(&stuffing, (uint8_t)(~crc >> 8 * i & 0xFFu));
    stuff_end(&stuffing);
    *stuffing.next++ = 0;
    return (size_t)(stuffing.next - wire);
}
