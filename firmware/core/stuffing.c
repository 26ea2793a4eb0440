#include "stuffing.h"

void stuff(const uint8_t *bytes, size_t length, uint8_t *stuffed)
{
    /* Index of the byte that receives the distance to the next zero. */
    size_t distance_at = 0;
    for (size_t i = 0; i < length; i++) {
        if (bytes[i] != 0) {
            stuffed[i + 1] = bytes[i];
        } else {
            stuffed[distance_at] = (uint8_t)(i + 1 - distance_at);
            distance_at = i + 1;
        }
    }
    stuffed[distance_at] = (uint8_t)(length + 1 - distance_at);
}

size_t unstuff(const uint8_t *stuffed, size_t length, uint8_t *bytes, size_t room)
{
    /* Every stuffed byte except the first gives one byte. A distance replaced a zero, so it becomes zero again. All
       other bytes stay as they are. */
    if (length < 2 || length - 1 > room)
        return 0;
    size_t next_zero = stuffed[0];
    for (size_t i = 1; i < length; i++) {
        if (stuffed[i] == 0)
            return 0;
        if (i == next_zero) {
            bytes[i - 1] = 0;
            next_zero = i + stuffed[i];
        } else {
            bytes[i - 1] = stuffed[i];
        }
    }
    return stuffed[0] != 0 && next_zero == length ? length - 1 : 0;
}
