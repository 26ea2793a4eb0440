/* The finger's part of the hardware layer. The line's part is in ../cortex_m/line.c. */

#include "../core/protocol.h"
#include "../cortex_m/interrupts.h"
#include "../cortex_m/line.h"
#include "parts.h"
#include "pins.h"
#include "registers.h"

/* Largest age of the newest sample that was read, us. If it is older, sensors_poll reads another one. */
enum { REFRESH = 10000 };

/* How old a sample may be when the core asks for it, us. */
enum { USABLE = 50 };

static uint32_t sampled_at;
/* The time of the sample that was read last, us. It may be before sampled_at: on a line with noise, a zero byte can
   cause a sample that nobody reads. */
static uint32_t read_at;
/* Whether nobody has read the last sample. */
static bool unread;
static bool crystal;

void faults_start(bool crystal_runs)
{
    crystal = crystal_runs;
}

/* Samples all eight sensors within 1 us. Interrupts are masked, because they would come between the samples. */
static void sample(void)
{
    mask_interrupts();
    gauges_convert();
    encoders_latch();
    gauges_confirm();
    unmask_interrupts();
    sampled_at = hal_microseconds();
    unread = true;
}

/* The sensors are sampled as soon as a frame has arrived, so that the converter works while the core checks the frame
   and the faults. This saves 4 us. */
void line_frame_taken(uint32_t arrived_at)
{
    (void)arrived_at;
    if (!unread || hal_microseconds() - sampled_at > USABLE)
        sample();
}

void hal_sample(unsigned finger, struct sensors *sensors)
{
    (void)finger;
    if (!unread || hal_microseconds() - sampled_at > USABLE)
        sample();
    unread = false;
    read_at = sampled_at;
    encoders_read(sensors->encoders);
    gauges_read(sensors->gauges);
}

void sensors_poll(void)
{
    struct sensors ignored;
    if (hal_microseconds() - read_at > REFRESH)
        hal_sample(0, &ignored);
}

/* The board has no tactile elements. */
bool hal_touch(unsigned finger, unsigned element, uint16_t *count)
{
    (void)finger;
    (void)element;
    *count = 0;
    return false;
}

void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS])
{
    (void)finger;
    drivers_set(microamperes);
}

uint16_t hal_faults(unsigned finger)
{
    (void)finger;
    unsigned faults = 0;
    /* drivers_were_stopped also reports a stop that ended before its pin is read here. */
    if (GPIOA->IDR & 1u << PIN_STOP || drivers_were_stopped())
        faults |= STATUS_EMERGENCY_STOP;
    if (!(GPIOC->IDR & 1u << PIN_SUPPLY_GOOD))
        faults |= STATUS_SUPPLY_FAULT;
    if (!(GPIOC->IDR & 1u << PIN_DRIVER_FAULT))
        faults |= STATUS_DRIVER_FAULT;
    /* Without the crystal the watchdog times and the clock of the samples are not accurate enough. */
    if (gauges_failed() || !crystal)
        faults |= STATUS_SENSOR_FAULT;
    return (uint16_t)faults;
}

void hal_set_toggle(unsigned finger, bool high)
{
    (void)finger;
    GPIOC->BSRR = high ? 1u << PIN_TOGGLE : 1u << (PIN_TOGGLE + 16);
}
