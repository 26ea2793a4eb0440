/* The gauges, through an AD7606-4 or the first four channels of an AD7606 (Analog Devices). The rising edge of CONVST
   samples all channels. BUSY rises within 45 ns and falls after at most 4.15 us. Then the 16-bit results of channels 1
   to 4 follow each other on DOUTA. The figures are those of the data sheet; the code has never run with the part. */

#include "../cortex_m/time.h"
#include "parts.h"
#include "pins.h"
#include "registers.h"
#include <string.h>

/* Largest number of rounds of a wait. A round takes at least 14 cycles, so the limit is 16 us or more. The conversion
   takes 4.15 us and a word 1.6 us. */
enum { ROUNDS = 200 };

/* Number of conversions in a row that may fail. The next failure is reported. At 500 Hz, gauges that fail are therefore
   reported within 6 ms. */
enum { FAILURES_MOST = 2 };

static uint16_t latest[MOTORS];
static unsigned failures;
static bool begun;

void gauges_start(void)
{
    RCC->APB1ENR |= RCC_APB1ENR_SPI2;
    (void)RCC->APB1ENR;
    /* SCLK has 42 MHz / 4 and idles high. Each bit is read on a falling edge, because the converter shifts on the
       rising edge that follows: CPOL = 1, CPHA = 0. */
    SPI2->CR1 = SPI_CR1_DFF_16 | SPI_CR1_SSM | SPI_CR1_SSI | SPI_CR1_BR_DIV4 | SPI_CR1_MSTR | SPI_CR1_CPOL;
    SPI2->CR1 |= SPI_CR1_SPE;
    /* The converter requires a reset of 50 ns or more after power-up. */
    GPIOB->BSRR = 1u << PIN_GAUGE_RESET;
    for (uint32_t begin = time_microseconds(); time_microseconds() - begin < 2;)
        ;
    GPIOB->BSRR = 1u << (PIN_GAUGE_RESET + 16);
}

void gauges_convert(void)
{
    GPIOB->BSRR = 1u << PIN_GAUGE_CONVERT;
}

/* A converter that is absent or has no power does not become busy. */
void gauges_confirm(void)
{
    begun = (GPIOB->IDR & 1u << PIN_GAUGE_BUSY) != 0;
    GPIOB->BSRR = 1u << (PIN_GAUGE_CONVERT + 16);
}

/* Waits until the bits of `mask` in a register equal `wanted`. Returns false if they do not after ROUNDS rounds. */
static bool becomes(const volatile uint32_t *address, uint32_t mask, uint32_t wanted)
{
    for (unsigned round = 0; round < ROUNDS; round++)
        if ((*address & mask) == wanted)
            return true;
    return false;
}

/* Returns false if the converter does not answer. */
static bool fetch(uint16_t raw[MOTORS])
{
    if (!begun || !becomes(&GPIOB->IDR, 1u << PIN_GAUGE_BUSY, 0))
        return false;
    bool whole = true;
    GPIOB->BSRR = 1u << (PIN_GAUGE_SELECT + 16);
    for (unsigned channel = 0; channel < MOTORS && whole; channel++) {
        SPI2->DR = 0;
        whole = becomes(&SPI2->SR, SPI_SR_RXNE, SPI_SR_RXNE);
        raw[channel] = (uint16_t)SPI2->DR;
    }
    GPIOB->BSRR = 1u << PIN_GAUGE_SELECT;
    return whole;
}

void gauges_read(uint16_t counts[MOTORS])
{
    uint16_t raw[MOTORS];
    bool good = fetch(raw);
    for (unsigned channel = 0; channel < MOTORS && good; channel++) {
        /* The ends of the range mean an open bridge, an amplifier without power, or an overload. */
        good = raw[channel] != 0x7FFF && raw[channel] != 0x8000;
    }
    if (good)
        for (unsigned channel = 0; channel < MOTORS; channel++)
            /* Converts two's complement to offset binary, 0 to 65535. */
            latest[channel] = raw[channel] ^ 0x8000u;
    failures = good ? 0 : failures + 1;
    memcpy(counts, latest, sizeof latest);
}

bool gauges_failed(void)
{
    return failures > FAILURES_MOST;
}
