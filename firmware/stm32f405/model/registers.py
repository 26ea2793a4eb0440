"""Models of the registers of the STM32F405 that the firmware uses (RM0090), of the converter, and of the wires."""

MEGAHERTZ = 168
GPIOA, GPIOB, GPIOC = 0x40020000, 0x40020400, 0x40020800
TIM2, TIM3, TIM4, TIM5, TIM8 = 0x40000000, 0x40000400, 0x40000800, 0x40000C00, 0x40010400
RCC, FLASH_ACR, IWDG, SPI2, USART1, SYSTICK = 0x40023800, 0x40023C00, 0x40003000, 0x40003800, 0x40011000, 0xE000E010
IDR, ODR, BSRR = 0x10, 0x14, 0x18
SR_RXNE, SR_TXE = 1 << 5, 1 << 7
CR1_RXNEIE, CR1_TXEIE = 1 << 5, 1 << 7
MOE = 1 << 15

# Times of the converter, cycles. BUSY rises within 45 ns, and falls after at most 4.15 us. This is the limit of the
# AD7606 with 8 channels, the slowest variant.
BUSY_BEGINS, BUSY_ENDS = 8, 8 + int(4.15 * MEGAHERTZ)
# Duration of an SPI word, cycles: 16 bits at 10.5 MHz, and the synchronisation with the bus.
SPI_WORD = 16 * 16 + 12


def bus_wait(address):
    """Cycles that an access to a register waits for its bus: AHB, APB2 at half and APB1 at a quarter of the clock."""
    if address >= 0xE0000000:
        return 0
    return 2 if address >= 0x40020000 else 6 if address >= 0x40010000 else 12


class Registers:
    """The values of all registers, and what the world outside does. `self.now` counts cycles."""

    def __init__(self):
        self.now = 0
        self.values = {RCC: 0x83, TIM8 + 0x44: 0}
        self.writes = []
        self.crystal = True
        self.converter = True
        self.gauges = [100, -100, 0, 32000]
        self.stop = False
        self.driver_fault = False
        self.supply = True
        self.converted_at = -10**9
        self.spi_at = None
        self.channel = 0
        self.received = None
        self.overruns = 0
        self.byte_cycles = 1680
        self.shift_ends = 0
        self.held = None
        self.sent = []
        self.fed_at = None
        self.longest_unfed = 0

    def inputs(self, port):
        if port == GPIOA:
            return self.stop << 6
        if port == GPIOC:
            return (not self.driver_fault) << 10 | self.supply << 11
        since = self.now - self.converted_at
        return int(self.converter and BUSY_BEGINS <= since < BUSY_ENDS)

    def usart_status(self):
        if self.held is not None and self.now >= self.shift_ends:
            self.shift_ends += self.byte_cycles
            self.held = None
        return (SR_RXNE if self.received is not None else 0) | (SR_TXE if self.held is None else 0)

    def receive(self, byte):
        """A byte has arrived from the line."""
        self.overruns += self.received is not None
        self.received = byte

    def interrupts(self):
        """Whether USART1 requests its interrupt."""
        control, status = self.values.get(USART1 + 0x0C, 0), self.usart_status()
        return bool(control & CR1_RXNEIE and status & SR_RXNE or control & CR1_TXEIE and status & SR_TXE)

    def read(self, address):
        value = self.values.get(address, 0)
        if address == RCC:
            return value | (value >> 16 & self.crystal) << 17 | (value >> 24 & 1) << 25
        if address == RCC + 0x08:
            return value | (value & 3) << 2
        if address in (GPIOA + IDR, GPIOB + IDR, GPIOC + IDR):
            return self.inputs(address - IDR)
        if address == SYSTICK + 8:
            reload = self.values.get(SYSTICK + 4, 0)
            return reload - self.now % (reload + 1)
        if address == USART1:
            return self.usart_status()
        if address == USART1 + 4:
            byte, self.received = self.received or 0, None
            return byte
        if address == SPI2 + 8:
            return 2 | int(self.spi_at is not None and self.now >= self.spi_at)
        if address == SPI2 + 0x0C:
            self.spi_at = None
            self.channel += 1
            return self.gauges[self.channel - 1] & 0xFFFF
        return value

    def write(self, address, value):
        self.writes.append((self.now, address, value))
        if address in (GPIOA + BSRR, GPIOB + BSRR, GPIOC + BSRR):
            port = address - BSRR
            outputs = self.values.get(port + ODR, 0)
            self.values[port + ODR] = outputs & ~(value >> 16) | value & 0xFFFF
            if port == GPIOB and value & 1 << 1:
                self.converted_at, self.channel = self.now, 0
        elif address == SPI2 + 0x0C:
            self.spi_at = self.now + SPI_WORD
        elif address == USART1 + 4:
            self.usart_status()
            self.sent.append((self.now, value & 0xFF))
            if self.now >= self.shift_ends:
                self.shift_ends = self.now + self.byte_cycles
            else:
                assert self.held is None, "a byte was written before the last one had left"
                self.held = value
        elif address == IWDG:
            if self.fed_at is not None and value == 0xAAAA:
                self.longest_unfed = max(self.longest_unfed, self.now - self.fed_at)
            if value in (0xAAAA, 0xCCCC):
                self.fed_at = self.now
        elif address == TIM8 + 0x44:
            # The break input keeps MOE clear.
            self.values[address] = value & ~MOE if self.stop else value
        elif address == TIM8 + 0x10:
            self.values[address] = self.values.get(address, 0) & value
        else:
            self.values[address] = value

    def press_stop(self):
        """Opens the emergency stop: the break input clears MOE and sets BIF."""
        self.stop = True
        self.values[TIM8 + 0x44] = self.values.get(TIM8 + 0x44, 0) & ~MOE
        self.values[TIM8 + 0x10] = self.values.get(TIM8 + 0x10, 0) | 1 << 7

    def enabled(self):
        """The enable pin of the drivers, and whether the PWM outputs are on. Current flows only with both."""
        return bool(self.values.get(GPIOC + ODR, 0) & 1 << 4), bool(self.values.get(TIM8 + 0x44, 0) & MOE)
