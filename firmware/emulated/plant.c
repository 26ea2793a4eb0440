#include "plant.h"
#include "../cortex_m/line.h"
#include "processor.h"
#include <string.h>

struct request {
    uint8_t finger, sample;
    uint16_t unused;
    uint32_t now, arrived_at, set_at;
    int32_t currents[MOTORS];
};

struct answer {
    int32_t encoders[MOTORS];
    uint16_t gauges[MOTORS];
    uint16_t faults;
    uint16_t touch[PLANT_ELEMENTS];
    uint16_t unused;
};

/* How old the plant's last answer may become before plant_poll queries the plant again, us. */
enum { REFRESH = 5000 };

static struct {
    int32_t currents[MOTORS];
    uint32_t set_at, asked_at;
    uint16_t faults;
    uint16_t touch[PLANT_ELEMENTS];
} fingers[PLANT_FINGERS];

/* Operations of semihosting. */
enum { OPEN = 1, WRITE = 5, READ = 6 };
enum { OPEN_READ_AND_WRITE = 3 };

static int to_plant, from_plant;

static uint32_t frame_arrived_at;

static int semihost(int operation, const void *parameters)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = parameters;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static int open_file(const char *name)
{
    const struct {
        const char *name;
        uint32_t mode, length;
    } parameters = {name, OPEN_READ_AND_WRITE, strlen(name)};
    return semihost(OPEN, &parameters);
}

static void transfer(int operation, int file, void *bytes, size_t length)
{
    struct {
        int file;
        void *bytes;
        size_t length;
    } parameters = {file, bytes, length};
    /* The call returns the number of bytes that are left. */
    while (parameters.length > 0) {
        size_t left = (size_t)semihost(operation, &parameters);
        parameters.bytes = (uint8_t *)parameters.bytes + (parameters.length - left);
        parameters.length = left;
    }
}

static void ask(unsigned finger, bool sample, struct answer *answer)
{
    struct request request = {.finger = (uint8_t)finger, .sample = sample, .now = hal_microseconds()};
    request.arrived_at = frame_arrived_at;
    request.set_at = fingers[finger].set_at;
    memcpy(request.currents, fingers[finger].currents, sizeof request.currents);
    fingers[finger].asked_at = request.now;
    transfer(WRITE, to_plant, &request, sizeof request);
    transfer(READ, from_plant, answer, sizeof *answer);
    fingers[finger].faults = answer->faults;
    memcpy(fingers[finger].touch, answer->touch, sizeof answer->touch);
}

void plant_start(void)
{
    to_plant = open_file("plant_to");
    from_plant = open_file("plant_from");
    /* The tactile elements are unreadable until the plant answers. */
    for (unsigned finger = 0; finger < PLANT_FINGERS; finger++)
        memset(fingers[finger].touch, 0xFF, sizeof fingers[finger].touch);
}

void plant_poll(void)
{
    for (unsigned finger = 0; finger < PLANT_FINGERS; finger++) {
        struct answer ignored = {0};
        if (hal_microseconds() - fingers[finger].asked_at > REFRESH)
            ask(finger, false, &ignored);
    }
}

void line_frame_taken(uint32_t arrived_at)
{
    frame_arrived_at = arrived_at;
}

/* The fingers' part of the hardware layer */

void hal_sample(unsigned finger, struct sensors *sensors)
{
    struct answer answer = {0};
    ask(finger, true, &answer);
    memcpy(sensors->encoders, answer.encoders, sizeof sensors->encoders);
    memcpy(sensors->gauges, answer.gauges, sizeof sensors->gauges);
}

void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS])
{
    memcpy(fingers[finger].currents, microamperes, sizeof fingers[finger].currents);
    fingers[finger].set_at = hal_microseconds();
}

/* A count of 0xFFFF stands for an element that cannot be read. */
bool hal_touch(unsigned finger, unsigned element, uint16_t *count)
{
    *count = fingers[finger].touch[element];
    return *count != 0xFFFF;
}

uint16_t hal_faults(unsigned finger)
{
    return fingers[finger].faults;
}

void hal_set_toggle(unsigned finger, bool high)
{
    pin_set(finger, high);
}
