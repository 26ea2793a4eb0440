#include "stuffing.h"

void stuff_begin(struct stuffing *stuffing, uint8_t *stuffed)
{
    stuffing->distance_at = stuffed;
    stuffing->next = stuffed + 1;
}

/* The last distance leads to the end of the bytes, as if a zero followed them. */
void stuff_end(struct stuffing *stuffing)
{
    *stuffing->distance_at = (uint8_t)(stuffing->next - stuffing->distance_at);
}

void stuff(struct stuffing *stuffing, uint8_t byte)
{
    if (byte == 0) {
        stuff_end(stuffing);
        stuffing->distance_at = stuffing->next;
    }
    *stuffing->next++ = byte;
}
