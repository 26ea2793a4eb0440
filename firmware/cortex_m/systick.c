#include "systick.h"
#include "time.h"

#define REGISTER(name, address) static volatile uint32_t *const name = (volatile uint32_t *)address

REGISTER(control, 0xE000E010u);
REGISTER(reload, 0xE000E014u);
REGISTER(value, 0xE000E018u);

/* Selects the processor clock, enables the interrupt, and starts the counter. */
enum { CONTROL_RUN = 7 };

/* SysTick is a down counter of 24 bits. */
enum { MOST_COUNTS = 1 << 24 };

static uint32_t counts_per_microsecond, last_count;

/* A round takes 2^round_bits us. */
static unsigned round_bits;
static volatile uint32_t rounds;

void systick_start(uint32_t megahertz)
{
    counts_per_microsecond = megahertz;
    /* The longest round that fits: 65 ms at 168 MHz. If the processor is emulated, and the host stops the emulator for
       longer than a round, rounds are lost. */
    while (megahertz << (round_bits + 1) <= MOST_COUNTS)
        round_bits++;
    last_count = (megahertz << round_bits) - 1;
    *reload = last_count;
    *value = 0;
    *control = CONTROL_RUN;
}

void systick_interrupt(void)
{
    rounds++;
}

/* SysTick preempts every other interrupt, so the rounds stay correct when an interrupt calls this function. */
uint32_t time_microseconds(void)
{
    static volatile uint32_t latest;
    uint32_t round, left, now;
    do {
        round = rounds;
        left = *value;
    } while (round != rounds);
    now = (round << round_bits) + (last_count - left) / counts_per_microsecond;
    /* SysTick may wrap slightly before its interrupt runs. Until then the latest value is kept, so that time never
       runs backward. */
    if (now - latest < 0x80000000u)
        latest = now;
    return latest;
}
