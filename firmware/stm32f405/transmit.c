/* Output of the serial line on the real board. The emulated board has an output of its own (emulated.c). */

#include "../cortex_m/line.h"
#include "registers.h"
#include "serial.h"

bool serial_transmits;

void uart_transmit(void)
{
    uint8_t byte;
    bool more = true;
    while (more && USART1->SR & USART_SR_TXE) {
        more = line_next(&byte);
        if (more)
            USART1->DR = byte;
    }
    if (more != serial_transmits) {
        serial_transmits = more;
        USART1->CR1 = more ? SERIAL_RUN | USART_CR1_TXEIE : SERIAL_RUN;
    }
}
