/* Compares the currents that the core sets with those computed in 64-bit arithmetic, for torques, units, torque
   constants and limits of all sizes. */

#include "fake_hardware.h"
#include "../core/protocol.h"
#include <stdio.h>

static struct finger_traits traits;
static struct finger finger;
static int failures;

static uint32_t any(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 32);
}

/* A number of 1 to 32 bits, or one close to a value at which the core changes its method of computation. */
static uint32_t any_size(void)
{
    static const uint32_t edges[] = {1, 1000, 999000, 1000000, UINT32_MAX / 1000u, UINT32_MAX};
    uint32_t number = any() % 4 == 0 ? edges[any() % 6] + any() % 5 - 2 : any() >> any() % 32;
    return number > 0 ? number : 1;
}

static void configure(const uint32_t constants[MOTORS], uint16_t limit)
{
    struct frame request, answer;
    frame_begin(&request, TYPE_CONFIGURE, 1, 0);
    frame_put8(&request, PROTOCOL_VERSION);
    frame_put16(&request, 20);
    frame_put8(&request, END_STATE_RELEASE);
    frame_put32(&request, 0);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(&request, limit);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put32(&request, constants[i]);
    finger_start(&finger, &traits, 0);
    finger_configure(&finger, &request, &answer);
}

/* Commands torques. Returns whether the Reply says that a torque was clipped. */
static bool command(const int16_t torques[MOTORS])
{
    struct frame request, answer;
    frame_begin(&request, TYPE_COMMAND, 1, 0);
    frame_put8(&request, FLAG_ENABLE);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(&request, (uint16_t)torques[i]);
    finger_command(&finger, &request, 0, &answer);
    return (frame_get16(&answer, 2) & STATUS_TORQUE_CLIPPED) != 0;
}

static int64_t clip(int64_t value, int64_t limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

int main(void)
{
    for (int round = 0; round < 1000000; round++) {
        uint32_t constants[MOTORS];
        int16_t torques[MOTORS];
        uint16_t limit = any() % 2 == 0 ? 32767 : (uint16_t)(any() % 32768);
        traits = fake_traits[0];
        traits.torque_limit = 32767;
        traits.torque_unit = any() % 2 == 0 ? 2000 : any_size();
        for (size_t i = 0; i < MOTORS; i++) {
            traits.largest_currents[i] = any() % 2 == 0 ? INT32_MAX : (int32_t)(any() >> 1 >> any() % 31);
            traits.torque_constants[i] = any_size();
            constants[i] = any() % 8 == 0 ? 0 : any_size();
            torques[i] = (int16_t)((int32_t)(any() % 65536) - 32768);
        }
        configure(constants, limit);
        bool reported = command(torques), clipped = false;
        for (size_t i = 0; i < MOTORS; i++) {
            int64_t torque = clip(torques[i], limit);
            int64_t current = torque * traits.torque_unit * 1000;
            current /= constants[i] > 0 ? constants[i] : traits.torque_constants[i];
            int64_t wanted = clip(current, traits.largest_currents[i]);
            clipped = clipped || torque != torques[i] || wanted != current;
            if (finger.torques[i] != torque || fake.currents[0][i] != wanted)
                failures++;
        }
        if (reported != clipped)
            failures++;
    }
    printf("currents: %d failures\n", failures);
    return failures > 0;
}
