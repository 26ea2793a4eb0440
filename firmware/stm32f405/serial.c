/* One interrupt for each byte. At 2 Mbaud a byte takes 5 us, or 840 cycles. The interrupt takes 186 of them with the
   cache of the flash, and at most 321 (README.md). The interrupt records when each zero byte arrived. A DMA, the
   alternative, relieves the processor but does not record when a zero byte arrived: this USART cannot detect a zero
   byte, and reports silence only one character later. */

#include "serial.h"
#include "../cortex_m/line.h"
#include "registers.h"

/* Set with `make BAUD=...`. */
#ifndef BAUD
#define BAUD 1000000
#endif

/* SysTick has priority 0 and must preempt this interrupt (cortex_m/systick.h). */
enum { PRIORITY = 0x10 };

void serial_start(uint32_t megahertz)
{
    RCC->APB2ENR |= RCC_APB2ENR_USART1;
    (void)RCC->APB2ENR;
    /* A bit takes 16 times the divider, in bus cycles. The register holds the divider in units of 1/16, so its value is
       the number of bus cycles in a bit (RM0090, 30.3.4). */
    USART1->BRR = (megahertz * 1000000u + BAUD / 2u) / BAUD;
    USART1->CR1 = SERIAL_RUN;
    NVIC_IPR[INTERRUPT_USART1] = PRIORITY;
    NVIC_ISER[INTERRUPT_USART1 / 32] = 1u << INTERRUPT_USART1 % 32;
}

void serial_interrupt(void)
{
    uint32_t status = USART1->SR;
    /* Reading DR also ends an overrun, which has lost a byte. The checksum reveals the loss. */
    if (status & USART_SR_RXNE)
        line_received((uint8_t)USART1->DR);
    else if (status & USART_SR_ORE)
        (void)USART1->DR;
    if (serial_transmits)
        uart_transmit();
}
