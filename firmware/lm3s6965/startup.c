/* From reset to main: initialises memory and defines the vector table. */

#include "processor.h"

/* Symbols of the linker script. */
extern uint32_t data_begin, data_end, bss_begin, bss_end, stack_top;
extern const uint32_t data_image;

int main(void);
void reset(void);

void reset(void)
{
    const uint32_t *from = &data_image;
    for (uint32_t *to = &data_begin; to < &data_end; to++)
        *to = *from++;
    for (uint32_t *to = &bss_begin; to < &bss_end; to++)
        *to = 0;
    main();
}

/* Handles a processor fault. On a real board a hardware watchdog then resets the processor, and a reset removes the
   torque. */
static void stand_still(void)
{
    for (;;)
        ;
}

union vector {
    void *stack;
    void (*handler)(void);
};

/* Sixteen vectors of the processor, then those of the chip: 5 is UART 0, 19 is timer 0. */
__attribute__((section(".vectors"), used)) static const union vector vectors[16 + 20] = {
    {.stack = &stack_top},
    {.handler = reset},
    {.handler = stand_still},
    {.handler = stand_still},
    {.handler = stand_still},
    {.handler = stand_still},
    {.handler = stand_still},
    [11] = {.handler = stand_still},
    [14] = {.handler = stand_still},
    [15] = {.handler = systick_interrupt},
    [16 + 5] = {.handler = uart_interrupt},
    [16 + 19] = {.handler = wake_up_interrupt},
};
