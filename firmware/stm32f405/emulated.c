/* The processor of the emulated board: netduinoplus2 in QEMU. It differs from the real board in five ways:

   - The emulator has no clock tree. The processor runs at 168 MHz from the start.
   - The board sleeps between bytes, to leave processor time to other programs. A byte or SysTick ends the sleep.
     SysTick cannot be the clock as well: on a busy machine the emulator loses some SysTick interrupts. TIM2 is the
     clock.
   - The emulated USART always has room for output, and raises no interrupt to report this. Output is written without
     reading the status, because every read costs the emulator a round through its main loop.
   - The plant replaces encoders, converter and drivers.
   - There is no watchdog, so nothing resets the processor after processor_fault. */

#include "../cortex_m/line.h"
#include "../cortex_m/startup.h"
#include "../cortex_m/systick.h"
#include "../cortex_m/time.h"
#include "../emulated/processor.h"
#include "registers.h"
#include "serial.h"

enum { CLOCK_MEGAHERTZ = 168, WAKE_UP_MICROSECONDS = 500 };

/* The emulated timers count at 1 GHz. */
enum { TIMER_MEGAHERTZ = 1000 };

#define SYSTICK ((volatile uint32_t *)0xE000E010u)

const uint8_t processor_name[8] = {'s', 't', 'm', '3', '2', 'f', '4', '5'};

void processor_start(void)
{
    TIM2->PSC = TIMER_MEGAHERTZ - 1;
    TIM2->CR1 = TIM_CR1_CEN;
    SYSTICK[1] = CLOCK_MEGAHERTZ * WAKE_UP_MICROSECONDS - 1;
    SYSTICK[2] = 0;
    SYSTICK[0] = 7; /* Processor clock, interrupt, on. */
    serial_start(CLOCK_MEGAHERTZ / 2);
}

uint32_t time_microseconds(void)
{
    return TIM2->CNT;
}

bool serial_transmits;

void uart_transmit(void)
{
    uint8_t byte;
    while (line_next(&byte))
        USART1->DR = byte;
}

/* The only purpose of this interrupt is to end line_sleep. */
void systick_interrupt(void)
{
}

void pin_set(unsigned pin, bool high)
{
    GPIOC->BSRR = high ? 1u << pin : 1u << (pin + 16);
}

void processor_fault(void)
{
    for (;;)
        ;
}
