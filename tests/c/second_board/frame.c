#include "frame.h"

unsigned frame_length(unsigned type)
{
    switch (type) {
    case HELLO: return 8;
    case CONFIGURE: return 38;
    case COMMAND: return 15;
    case STOP: return 6;
    case TACTILE_REQUEST: return 7;
    case IDENTITY: return 43;
    case CONFIGURED: return 64;
    case REPLY: return 26;
    case STOPPED: return 8;
    case REFUSED: return 10;
    case TACTILE_EVENT: return 18;
    default: return 0;
    }
}

uint32_t crc32_of(const uint8_t *bytes, unsigned length)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (unsigned i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            /* 0xEDB88320 is 0x04C11DB7 with its bits in reverse order. */
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    return crc ^ 0xFFFFFFFFu;
}

static void put(struct frame *frame, uint32_t value, unsigned bytes)
{
    while (bytes--) {
        frame->bytes[frame->length++] = (uint8_t)(value & 0xFF);
        value >>= 8;
    }
}

void put8(struct frame *frame, uint32_t value) { put(frame, value, 1); }
void put16(struct frame *frame, uint32_t value) { put(frame, value, 2); }
void put32(struct frame *frame, uint32_t value) { put(frame, value, 4); }

uint32_t get(const uint8_t *bytes, unsigned count)
{
    uint32_t value = 0;
    while (count--)
        value = value << 8 | bytes[count];
    return value;
}

int32_t get_signed16(const uint8_t *bytes)
{
    int32_t value = (int32_t)get(bytes, 2);
    return value < 0x8000 ? value : value - 0x10000;
}

void begin(struct frame *frame, unsigned type, unsigned address, unsigned sequence)
{
    frame->length = 0;
    put8(frame, type << 4 | address);
    put8(frame, sequence);
}

unsigned to_wire(struct frame *frame, uint8_t wire[WIRE_MAXIMUM])
{
    put32(frame, crc32_of(frame->bytes, frame->length));
    unsigned code = 0, out = 1;
    for (unsigned i = 0; i < frame->length; i++) {
        if (frame->bytes[i]) {
            wire[out++] = frame->bytes[i];
        } else {
            wire[code] = (uint8_t)(out - code);
            code = out++;
        }
    }
    wire[code] = (uint8_t)(out - code);
    wire[out++] = 0;
    return out;
}

int from_wire(const uint8_t *stuffed, unsigned length, struct frame *frame)
{
    frame->length = 0;
    unsigned i = 0;
    while (i < length) {
        unsigned code = stuffed[i++];
        if (code == 0 || i + code - 1 > length)
            return 0;
        for (unsigned n = 1; n < code; n++) {
            if (frame->length == FRAME_MAXIMUM)
                return 0;
            frame->bytes[frame->length++] = stuffed[i++];
        }
        /* In COBS, each code is the distance to the next zero. The last code leads to the end of the frame, where no
           zero is added. */
        if (i < length) {
            if (frame->length == FRAME_MAXIMUM)
                return 0;
            frame->bytes[frame->length++] = 0;
        }
    }
    if (frame->length < FRAME_OVERHEAD)
        return 0;
    return get(frame->bytes + frame->length - 4, 4) == crc32_of(frame->bytes, frame->length - 4);
}
