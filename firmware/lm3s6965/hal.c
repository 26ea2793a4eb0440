/* The processor's part of the hardware layer. */

#include "../hal.h"
#include "plant.h"
#include "processor.h"

uint32_t hal_microseconds(void)
{
    return timer_microseconds();
}

size_t hal_receive(unsigned line, uint8_t *bytes, size_t room, uint32_t *arrived_at)
{
    (void)line;
    size_t taken = 0;
    while (taken < room && uart_take(&bytes[taken], arrived_at)) {
        if (bytes[taken++] == 0) {
            plant_note_frame(*arrived_at);
            break;
        }
    }
    return taken;
}

void hal_send(unsigned line, const uint8_t *bytes, size_t length)
{
    (void)line;
    uart_send(bytes, length);
}

void hal_set_toggle(unsigned finger, bool high)
{
    pin_set(finger, high);
}
