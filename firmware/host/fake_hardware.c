#include "fake_hardware.h"
#include "../core/protocol.h"
#include <string.h>

struct fake_hardware fake;

#define TRAITS(number)                                                                                                 \
    {                                                                                                                  \
        .address = number, .unique_number = {'f', 'a', 'k', 'e', number}, .firmware_version = {1, 0, 0},               \
        .counts_per_revolution = 2000, .gauge_bits = 12, .torque_unit = 2000, .torque_limit = 30000,                   \
        .shortest_watchdog_ms = 2,                                                                                     \
        .capabilities = CAPABILITY_HOLD | CAPABILITY_KEEPS_ZERO | CAPABILITY_EMERGENCY_STOP | CAPABILITY_TOGGLE_PIN |  \
                        (number == 2 ? CAPABILITY_TACTILE : 0),                                                       \
        .touch = {.elements = 2, .made = 50, .lost = 25, .step = 100},                                                 \
        .torque_constants = {20000, 20000, 20000, 20000}, .largest_currents = {3000000, 3000000, 3000000, 3000000},    \
    }

const struct finger_traits fake_traits[FAKE_FINGERS] = {TRAITS(1), TRAITS(2)};

uint32_t hal_microseconds(void)
{
    return fake.now;
}

size_t hal_receive(unsigned line, uint8_t *bytes, size_t room, uint32_t *arrived_at)
{
    (void)line;
    size_t taken = 0;
    while (taken < room && fake.input_length > 0) {
        bytes[taken] = *fake.input++;
        fake.input_length--;
        if (bytes[taken++] == 0)
            break;
    }
    if (taken == 0)
        fake.now += fake.gap;
    else if (bytes[taken - 1] == 0)
        *arrived_at = fake.now - fake.delay;
    return taken;
}

void hal_send(unsigned line, const uint8_t *bytes, size_t length)
{
    (void)line;
    if (length > sizeof fake.output - fake.output_length)
        return;
    memcpy(fake.output + fake.output_length, bytes, length);
    fake.output_length += length;
}

void hal_sample(unsigned finger, struct sensors *sensors)
{
    (void)finger;
    *sensors = fake.sensors;
}

void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS])
{
    memcpy(fake.currents[finger], microamperes, sizeof fake.currents[finger]);
}

bool hal_touch(unsigned finger, unsigned element, uint16_t *count)
{
    (void)finger;
    *count = fake.touch[element];
    return !fake.touch_broken[element];
}

uint16_t hal_faults(unsigned finger)
{
    (void)finger;
    uint16_t faults = fake.faults;
    if (fake.short_faults != 0 && fake.calls_without_short-- == 0) {
        faults |= fake.short_faults;
        fake.short_faults = 0;
    }
    return faults;
}

void hal_set_toggle(unsigned finger, bool high)
{
    (void)finger;
    (void)high;
}

int32_t fake_torque(unsigned finger, size_t motor, uint32_t torque_constant)
{
    /* uA * uN m/A is 1e-3 nN m. The torque is rounded to the nearest unit, because the current was rounded too. */
    int64_t unit = (int64_t)fake_traits[finger].torque_unit * 1000;
    int64_t torque = (int64_t)fake.currents[finger][motor] * torque_constant;
    return (int32_t)((torque + (torque < 0 ? -unit : unit) / 2) / unit);
}

void fake_arrive(struct board *board, const uint8_t *bytes, size_t length)
{
    fake.input = bytes;
    fake.input_length = length;
    do
        board_poll(board);
    while (fake.input_length > 0);
}

void fake_wait(struct board *board, uint32_t microseconds)
{
    for (uint32_t end = fake.now + microseconds; fake.now != end;) {
        uint32_t left = end - fake.now;
        fake.now += left < 500 ? left : 500;
        board_poll(board);
    }
}
