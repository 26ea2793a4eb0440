/* Tests receive_sample of c_examples/Can.c with late frames of the previous exchange. */
#define main main_of_the_example
#include "Can.c"
#undef main
#include "Sun2Xp.h"
#include "check.h"

static struct can_bus far_end;
static struct drives drives;

static void send_numbers(unsigned identifier, int number)
{
    int numbers[4] = {number, number, number, number};

    CHECK(can_send(&far_end, 1, identifier + 1, numbers) == 0);
}

/* Returns the result of receive_sample for the frames that have arrived. */
static int sampled(struct sun2xp_io_sample *sample)
{
    memset(sample, 0, sizeof *sample);
    return receive_sample(&drives, sample, 0);
}

int main(void)
{
    struct sun2xp_io_sample sample;

    CHECK(can_open(&far_end, "./", 0) == 0 && can_open(&drives.bus, "./", 1) == 0);
    drives.finger = 1;
    send_numbers(CAN_ENCODERS, 1);
    send_numbers(CAN_ENCODERS, 2);
    CHECK(sampled(&sample) == ETIMEDOUT);
    send_numbers(CAN_TENSIONS, 100);
    send_numbers(CAN_ENCODERS, 3);
    CHECK(sampled(&sample) == ETIMEDOUT);
    send_numbers(CAN_TENSIONS, 100);
    send_numbers(CAN_ENCODERS, 4);
    send_numbers(CAN_TENSIONS, 200);
    CHECK(sampled(&sample) == 0);
    CHECK(sample.encoders[3] == 4 && fabs(sample.tensions[3] - 200 * TENSION_UNIT) < 1e-9 && sample.faults == 0);
    return 0;
}
