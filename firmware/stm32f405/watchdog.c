/* The independent watchdog runs from its own oscillator of 17 to 47 kHz (data sheet; 32 kHz typically). At a quarter of
   this frequency, 80 counts take 6.8 ms to 18.9 ms, and 10 ms typically. The main loop feeds the watchdog at
   intervals of at most 1.6 ms (README.md, upper bound). */

#include "parts.h"
#include "registers.h"

enum { COUNTS = 80 };

void watchdog_start(void)
{
    IWDG->KR = IWDG_KR_START;
    IWDG->KR = IWDG_KR_UNLOCK;
    IWDG->PR = 0; /* The prescaler divides by 4. */
    /* This value takes effect within 0.3 ms. Until then a feed loads the reset value, 4096 counts (RM0090, 21.4.3). */
    IWDG->RLR = COUNTS - 1;
}

void watchdog_feed(void)
{
    IWDG->KR = IWDG_KR_FEED;
}
