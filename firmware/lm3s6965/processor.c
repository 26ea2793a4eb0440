#include "../emulated/processor.h"
#include "../cortex_m/line.h"
#include "../cortex_m/systick.h"
#include "interrupt_handlers.h"

/* Registers, named after the LM3S6965's data sheet and ARM's manual of the Cortex-M3. */

#define REGISTER(name, address) static volatile uint32_t *const name = (volatile uint32_t *)address

REGISTER(clock_interrupts, 0x400FE050u);
REGISTER(clock_configuration, 0x400FE060u);
REGISTER(peripheral_clocks, 0x400FE104u);
REGISTER(port_clocks, 0x400FE108u);
REGISTER(port_a, 0x40004000u);
REGISTER(port_f, 0x40025000u);
REGISTER(timer_mode, 0x40030004u);
REGISTER(timer_control, 0x4003000Cu);
REGISTER(timer_interrupt_mask, 0x40030018u);
REGISTER(timer_interrupt_clear, 0x40030024u);
REGISTER(timer_reload, 0x40030028u);
REGISTER(interrupt_enable, 0xE000E100u);
REGISTER(interrupt_priorities, 0xE000E400u);

/* Registers of a port, as word offsets. */
enum { PORT_DIRECTION = 0x400 / 4, PORT_ALTERNATE = 0x420 / 4, PORT_DIGITAL = 0x51C / 4 };

static struct {
    volatile uint32_t data, error, unused[4], flags, unused_too, low_power, divider, divider_fraction, line_control,
        control, interrupt_level, interrupt_mask, interrupts_raw, interrupts, interrupt_clear;
} *const uart = (void *)0x4000C000u;

enum { RECEIVE_EMPTY = 1 << 4, TRANSMIT_FULL = 1 << 5 };
/* The causes of the interrupts: the receive FIFO has filled to its level; the transmit FIFO has drained to its level;
   the line is silent, and the receive FIFO holds fewer bytes than its level. */
enum { INTERRUPT_RECEIVED = 1 << 4, INTERRUPT_ROOM = 1 << 5, INTERRUPT_SILENCE = 1 << 6 };

enum { CLOCK_MEGAHERTZ = 50, WAKE_UP_MICROSECONDS = 500, BAUD = 1000000 };

const uint8_t processor_name[8] = {'l', 'm', '3', 's', '6', '9', '6', '5'};

/* The only purpose of this interrupt is to wake the main loop. */
void wake_up_interrupt(void)
{
    *timer_interrupt_clear = 1;
}

void uart_interrupt(void)
{
    uart->interrupt_clear = INTERRUPT_RECEIVED | INTERRUPT_SILENCE | INTERRUPT_ROOM;
    while (!(uart->flags & RECEIVE_EMPTY))
        line_received((uint8_t)uart->data);
    uart_transmit();
}

void uart_transmit(void)
{
    uint8_t byte;
    bool more = true;
    while (more && !(uart->flags & TRANSMIT_FULL)) {
        more = line_next(&byte);
        if (more)
            uart->data = byte;
    }
    uart->interrupt_mask = INTERRUPT_RECEIVED | INTERRUPT_SILENCE | (more ? INTERRUPT_ROOM : 0u);
}

void pin_set(unsigned pin, bool high)
{
    /* Bits 2 to 9 of the address select the pins to write. */
    port_f[1u << pin] = high ? 0xFFu : 0u;
}

/* Sets the clock to 50 MHz. The PLL makes 200 MHz from a crystal of 8 MHz, and a divider divides this clock by 4. */
static void start_clock(void)
{
    const uint32_t divided = 3u << 23 | 1u << 22 | 0xEu << 6, bypass = 1u << 11, locked = 1u << 6;
    *clock_configuration = divided | bypass;
    while (!(*clock_interrupts & locked))
        ;
    *clock_configuration = divided;
}

static void start_uart(void)
{
    enum { WHOLE = CLOCK_MEGAHERTZ * 1000000 / (16 * BAUD), FRACTION_64 = CLOCK_MEGAHERTZ * 1000000 / BAUD * 4 % 64 };
    /* The UART uses pins 0 and 1 of port A. */
    port_a[PORT_ALTERNATE] = port_a[PORT_DIGITAL] = 3u;
    uart->divider = WHOLE;
    uart->divider_fraction = FRACTION_64;
    uart->line_control = 3u << 5 | 1u << 4; /* Eight bits, FIFOs on. */
    uart->control = 1u << 9 | 1u << 8 | 1u << 0;
    uart->interrupt_mask = INTERRUPT_RECEIVED | INTERRUPT_SILENCE;
}

void processor_start(void)
{
    start_clock();
    *peripheral_clocks = 1u << 0 | 1u << 16;
    *port_clocks = 1u << 0 | 1u << 5;
    port_f[PORT_DIRECTION] = port_f[PORT_DIGITAL] = 0xFFu;
    start_uart();
    systick_start(CLOCK_MEGAHERTZ);
    *timer_mode = 2; /* Periodic. */
    *timer_reload = CLOCK_MEGAHERTZ * WAKE_UP_MICROSECONDS - 1;
    *timer_interrupt_mask = 1;
    *timer_control = 1;
    /* A word holds four priorities. UART 0 is interrupt 5, and timer 0 is interrupt 19. SysTick keeps priority 0, the
       highest. */
    interrupt_priorities[5 / 4] = 0x80u << 8;
    interrupt_priorities[19 / 4] = 0x80u << 24;
    *interrupt_enable = 1u << 5 | 1u << 19;
}
