/* The handlers of processor.c, for the vector table. */

#ifndef FIRMWARE_INTERRUPT_HANDLERS_H
#define FIRMWARE_INTERRUPT_HANDLERS_H

void wake_up_interrupt(void);
void uart_interrupt(void);

#endif
