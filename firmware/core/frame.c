#include "frame.h"
#include "crc32.h"
#include "stuffing.h"
#include <string.h>

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
    /* Only the used bytes are copied: the whole struct takes a microsecond more on a small processor. */
    struct frame checked;
    checked.length = frame->length;
    memcpy(checked.bytes, frame->bytes, frame->length);
    frame_put32(&checked, crc32(frame->bytes, frame->length));
    stuff(checked.bytes, checked.length, wire);
    wire[checked.length + 1] = 0;
    return checked.length + 2;
}

bool frame_from_wire(struct frame *frame, const uint8_t *stuffed, size_t length)
{
    size_t whole = unstuff(stuffed, length, frame->bytes, sizeof frame->bytes);
    if (whole < FRAME_LEAST)
        return false;
    frame->length = whole - FRAME_CHECK;
    return frame_get32(frame, frame->length) == crc32(frame->bytes, frame->length);
}
