#include "messages.h"
#include "protocol.h"

void read_hello(const struct frame *frame, struct hello *hello)
{
    hello->lowest_version = frame_get8(frame, 2);
    hello->highest_version = frame_get8(frame, 3);
}

void read_configure(const struct frame *frame, struct configure *configure)
{
    configure->version = frame_get8(frame, FIELD_VERSION);
    configure->watchdog_ms = frame_get16(frame, FIELD_WATCHDOG);
    configure->end_state = frame_get8(frame, FIELD_END_STATE);
    configure->hold_time_ms = frame_get16(frame, 6);
    configure->hold_torque_limit = frame_get16(frame, 8);
    for (size_t i = 0; i < MOTORS; i++) {
        configure->torque_limits[i] = frame_get16(frame, FIELD_TORQUE_LIMITS + 2 * i);
        configure->torque_constants[i] = frame_get32(frame, 18 + 4 * i);
    }
}

/* Converts from two's complement. A cast of an out-of-range value would be implementation-defined. */
static int16_t as_signed(uint16_t value)
{
    return (int16_t)(value < 0x8000u ? (int32_t)value : (int32_t)value - 0x10000);
}

void read_command(const struct frame *frame, struct command *command)
{
    uint8_t flags = frame_get8(frame, 2);
    command->toggle = (flags & FLAG_TOGGLE) != 0;
    command->enable = (flags & FLAG_ENABLE) != 0;
    for (size_t i = 0; i < MOTORS; i++)
        command->torques[i] = as_signed(frame_get16(frame, 3 + 2 * i));
}

void write_identity(struct frame *frame, const struct identity *identity)
{
    frame_put8(frame, identity->version);
    frame_put16(frame, identity->addresses);
    frame_put16(frame, identity->kind);
    for (size_t i = 0; i < sizeof identity->unique_number; i++)
        frame_put8(frame, identity->unique_number[i]);
    for (size_t i = 0; i < sizeof identity->firmware_version; i++)
        frame_put8(frame, identity->firmware_version[i]);
    frame_put32(frame, identity->counts_per_revolution);
    frame_put8(frame, identity->gauge_bits);
    frame_put32(frame, identity->torque_unit);
    frame_put16(frame, identity->torque_limit);
    frame_put16(frame, identity->shortest_watchdog_ms);
    frame_put32(frame, identity->capabilities);
}

static void write_gauges(struct frame *frame, const struct sensors *sensors)
{
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(frame, sensors->gauges[i]);
}

void write_configured(struct frame *frame, const struct configure *terms, const struct sensors *sensors,
                      uint16_t status)
{
    frame_put8(frame, terms->version);
    frame_put16(frame, terms->watchdog_ms);
    frame_put8(frame, terms->end_state);
    frame_put16(frame, terms->hold_time_ms);
    frame_put16(frame, terms->hold_torque_limit);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(frame, terms->torque_limits[i]);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put32(frame, terms->torque_constants[i]);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put32(frame, (uint32_t)sensors->encoders[i]);
    write_gauges(frame, sensors);
    frame_put16(frame, status);
}

void write_reply(struct frame *frame, uint16_t status, const struct sensors *sensors, uint16_t sampled_at)
{
    frame_put16(frame, status);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(frame, (uint16_t)((uint32_t)sensors->encoders[i] & 0xFFFFu));
    write_gauges(frame, sensors);
    frame_put16(frame, sampled_at);
}

void write_tactile_event(struct frame *frame, const struct tactile_event *event)
{
    frame_put8(frame, event->waiting);
    frame_put8(frame, event->number);
    frame_put8(frame, event->change);
    frame_put16(frame, event->element);
    frame_put16(frame, event->count);
    frame_put32(frame, event->noticed_at);
    frame_put8(frame, event->lost);
}

void write_stopped(struct frame *frame, uint16_t status)
{
    frame_put16(frame, status);
}

void write_refused(struct frame *frame, uint8_t type, uint8_t reason, uint16_t detail)
{
    frame_put8(frame, type);
    frame_put8(frame, reason);
    frame_put16(frame, detail);
}
