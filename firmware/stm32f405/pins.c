#include "pins.h"
#include "parts.h"
#include "registers.h"

struct pin {
    struct gpio *port;
    uint8_t number, mode, alternate, pull;
};

#define PIN_ENTRY(port, number, mode, alternate, pull, name, signal, connection)                                       \
    {GPIO##port, number, mode, alternate, pull},

static const struct pin pins[] = {PINS(PIN_ENTRY)};

/* Sets the bits of one pin to `value`. The register has `width` bits for each pin. */
static void set_field(volatile uint32_t *address, unsigned pin, unsigned width, uint32_t value)
{
    uint32_t mask = ((1u << width) - 1) << width * pin;
    *address = (*address & ~mask) | value << width * pin;
}

void pins_start(void)
{
    RCC->AHB1ENR |= RCC_AHB1ENR_GPIOA | RCC_AHB1ENR_GPIOB | RCC_AHB1ENR_GPIOC;
    /* A port that was just enabled needs two clock cycles before the first access (RM0090, 7.3.10, and the errata of
       the processor). This read takes these two cycles. */
    (void)RCC->AHB1ENR;
    GPIOB->BSRR = 1u << PIN_GAUGE_SELECT;
    for (unsigned i = 0; i < sizeof pins / sizeof pins[0]; i++) {
        const struct pin *pin = &pins[i];
        set_field(&pin->port->AFR[pin->number / 8], pin->number % 8, 4, pin->alternate);
        set_field(&pin->port->PUPDR, pin->number, 2, pin->pull);
        set_field(&pin->port->MODER, pin->number, 2, pin->mode);
    }
    /* The clock of the gauge converter has 10.5 MHz. With the speed setting after a reset and a load of 50 pF, a pin
       follows only up to 4 MHz (data sheet, I/O AC characteristics). The converter would then shift wrong bits, and
       nothing would reveal it. The medium speed suffices for 25 MHz. All other outputs switch at lower rates. They
       keep the slow setting, because slow edges disturb less. */
    set_field(&GPIOB->OSPEEDR, PIN_GAUGE_CLOCK, 2, GPIO_OSPEEDR_MEDIUM);
}
