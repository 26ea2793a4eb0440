#include "line.h"
#include "../hal.h"
#include "interrupts.h"
#include "time.h"
#include <string.h>

/* The rings hold a burst of 15 Commands and the answers to them. */
enum { INPUT_ROOM = 512, OUTPUT_ROOM = 1024 };

/* Each index has only one writer: the interrupt writes `written`, the main loop `taken`. */
static struct {
    volatile size_t written, taken; /* Never reset; their difference is the number of bytes that wait. */
    volatile uint8_t bytes[INPUT_ROOM];
    /* Set for zero bytes only, because reading the clock takes a third of the time of an interrupt. */
    volatile uint32_t arrived_at[INPUT_ROOM];
} input;

/* The main loop writes `written`; only line_next, which uart_transmit calls, writes `taken`. */
static struct {
    volatile size_t written, taken; /* Never reset, like those of the input. */
    uint8_t bytes[OUTPUT_ROOM];
} output;

void line_received(uint8_t byte)
{
    size_t place = input.written % INPUT_ROOM;
    if (input.written - input.taken < INPUT_ROOM) {
        input.bytes[place] = byte;
        if (byte == 0)
            input.arrived_at[place] = time_microseconds();
        input.written++;
    }
}

bool line_next(uint8_t *byte)
{
    if (output.taken == output.written)
        return false;
    *byte = output.bytes[output.taken % OUTPUT_ROOM];
    output.taken++;
    return true;
}

void line_sleep(void)
{
    /* WFI also wakes on a masked interrupt, so a byte that arrives between the check and WFI still ends the sleep. */
    mask_interrupts();
    if (input.taken == input.written)
        __asm__ volatile("wfi" ::: "memory");
    unmask_interrupts();
}

uint32_t hal_microseconds(void)
{
    return time_microseconds();
}

size_t hal_receive(unsigned line, uint8_t *bytes, size_t room, uint32_t *arrived_at)
{
    (void)line;
    size_t taken = 0;
    while (taken < room && input.taken != input.written) {
        size_t place = input.taken % INPUT_ROOM;
        bytes[taken] = input.bytes[place];
        if (bytes[taken] == 0)
            *arrived_at = input.arrived_at[place];
        input.taken++;
        if (bytes[taken++] == 0) {
            line_frame_taken(*arrived_at);
            break;
        }
    }
    return taken;
}

void hal_send(unsigned line, const uint8_t *bytes, size_t length)
{
    (void)line;
    size_t written = output.written, place = written % OUTPUT_ROOM;
    bool fits = length <= OUTPUT_ROOM - (written - output.taken);
    if (fits) {
        /* The interrupt does not read past `written`, so the copy needs no mask. */
        size_t before_the_end = length < OUTPUT_ROOM - place ? length : OUTPUT_ROOM - place;
        memcpy(output.bytes + place, bytes, before_the_end);
        memcpy(output.bytes, bytes + before_the_end, length - before_the_end);
    }
    mask_interrupts();
    if (fits)
        output.written = written + length;
    uart_transmit();
    unmask_interrupts();
}
