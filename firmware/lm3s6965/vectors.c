/* The vector table, and the handler of processor faults. */

#include "../cortex_m/startup.h"
#include "../cortex_m/systick.h"
#include "interrupt_handlers.h"

/* Symbol of the linker script. */
extern uint32_t stack_top;

/* Loops for ever. The emulated board does not use its watchdog, so nothing resets the board. */
void processor_fault(void)
{
    for (;;)
        ;
}

/* The interrupts of the chip follow the vectors of the processor: 5 is UART 0, 19 is timer 0. */
__attribute__((section(".vectors"), used)) static const union vector vectors[16 + 20] = {
    CORTEX_M_VECTORS(&stack_top),
    [16 + 5] = {.handler = uart_interrupt},
    [16 + 19] = {.handler = wake_up_interrupt},
};
