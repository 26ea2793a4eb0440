#include "clock.h"
#include "parts.h"
#include "registers.h"

/* Crystal, MHz. Set with `make HSE_MEGAHERTZ=...`. */
#ifndef HSE_MEGAHERTZ
#define HSE_MEGAHERTZ 8
#endif

/* The PLL multiplies 1 MHz by 336 and divides the result by 2. For USB it divides the 336 MHz by 7. That output must
   not exceed 48 MHz, although this port does not use it. */
enum { PLLM = HSE_MEGAHERTZ, PLLN = 336, PLLQ = 7 };

/* A crystal starts within 10 ms, and the PLL locks within 0.3 ms. Each round of the wait takes at least 8
   cycles, which are 0.5 us at 16 MHz, so the limit is 20 ms or more. */
enum { ROUNDS = 40000 };

/* The waits have a limit, so that a board without a crystal still answers and reports the fault. The waits can be
   longer than the time of the watchdog, so they feed it. */
static bool becomes(const volatile uint32_t *address, uint32_t mask, uint32_t wanted)
{
    for (uint32_t round = 0; round < ROUNDS; round++) {
        watchdog_feed();
        if ((*address & mask) == wanted)
            return true;
    }
    return false;
}

uint32_t clock_start(void)
{
    enum { INTERNAL_MEGAHERTZ = 16, MEGAHERTZ = HSE_MEGAHERTZ / PLLM * PLLN / 2 };
    RCC->APB1ENR |= RCC_APB1ENR_PWR;
    PWR_CR |= PWR_CR_VOS; /* Selects the voltage for more than 144 MHz. */
    RCC->CR |= RCC_CR_HSEON;
    if (!becomes(&RCC->CR, RCC_CR_HSERDY, RCC_CR_HSERDY))
        return INTERNAL_MEGAHERTZ;
    RCC->PLLCFGR = PLLM | PLLN << RCC_PLLCFGR_PLLN_SHIFT | RCC_PLLCFGR_PLLSRC_HSE | PLLQ << RCC_PLLCFGR_PLLQ_SHIFT;
    RCC->CR |= RCC_CR_PLLON;
    if (!becomes(&RCC->CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY))
        return INTERNAL_MEGAHERTZ;
    /* 168 MHz at 3.3 V needs five wait states (RM0090, 3.5.1, table 10). They are set before the clock rises. The
       caches are on (3.5.2). Prefetch is off, so that the caches hold what was used last and the timing can be
       computed. */
    FLASH_ACR = FLASH_ACR_LATENCY_5 | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    RCC->CFGR = RCC_CFGR_PPRE1_DIV4 | RCC_CFGR_PPRE2_DIV2;
    RCC->CFGR = RCC_CFGR_PPRE1_DIV4 | RCC_CFGR_PPRE2_DIV2 | RCC_CFGR_SW_PLL;
    /* If the switch to the PLL fails, the frequency is unknown. The watchdog then resets the processor. */
    if (!becomes(&RCC->CFGR, RCC_CFGR_SWS_MASK, RCC_CFGR_SWS_PLL))
        for (;;)
            ;
    /* A crystal that fails later causes an NMI (7.2.7), which ends in processor_fault. */
    RCC->CR |= RCC_CR_CSSON;
    return MEGAHERTZ;
}
