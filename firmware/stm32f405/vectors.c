/* The vector table. */

#include "../cortex_m/startup.h"
#include "../cortex_m/systick.h"
#include "registers.h"
#include "serial.h"

/* Symbol of the linker script. */
extern uint32_t stack_top;

/* The interrupts of the chip follow the vectors of the processor. */
__attribute__((section(".vectors"), used)) static const union vector vectors[16 + INTERRUPT_USART1 + 1] = {
    CORTEX_M_VECTORS(&stack_top),
    [16 + INTERRUPT_USART1] = {.handler = serial_interrupt},
};
