"""Runs the image of the board against models of its registers, and checks what reaches the pins.

    check.py stm32f405.elf stm32f405.bin"""

import struct
import sys

import registers as reg
from board import UNIQUE, Board, command, configure, wrap

ENABLED, STOPPED, SUPPLY, DRIVER, SENSOR = 1 << 1, 1 << 6, 1 << 7, 1 << 8, 1 << 9


def started(**world):
    """A board after its start. `world` sets values of the models."""
    board = Board(sys.argv[1], open(sys.argv[2], "rb").read())
    for name, value in world.items():
        assert hasattr(board.registers, name), name
        setattr(board.registers, name, value)
    board.run_for(world.get("crystal", True) and 150 or 20000)
    return board


def configured():
    board = started()
    assert board.ask(configure(watchdog_ms=1000))[0] == 0xA1
    return board


def status(reply):
    assert reply[0] == 0xB1, reply.hex()
    return struct.unpack_from("<H", reply, 2)[0]


def starts_safely():
    board = started()
    writes = [(address, value) for _, address, value in board.registers.writes]
    assert writes[0] == (reg.IWDG, 0xCCCC), "the watchdog must start first"
    assert not any(address == reg.GPIOC + reg.BSRR and value & 1 << 4 for address, value in writes)
    assert not any(address == reg.TIM8 + 0x44 and value & reg.MOE for address, value in writes)
    assert board.registers.enabled() == (False, False)
    latency = next(n for n, write in enumerate(writes) if write[0] == reg.FLASH_ACR and write[1] & 7 == 5)
    switch = next(n for n, write in enumerate(writes) if write[0] == reg.RCC + 8 and write[1] & 3 == 2)
    assert latency < switch, "the wait states must be set before the clock rises"
    pll = board.registers.values[reg.RCC + 4]
    assert 8 / (pll & 63) * (pll >> 6 & 511) / 2 == 168 and pll >> 16 & 3 == 0 and pll & 1 << 22
    assert 84e6 / board.registers.values[reg.USART1 + 8] == 1e6


def drives_every_pin_that_the_table_names():
    registers = started().registers
    mode = lambda port, pin: registers.values[port] >> 2 * pin & 3
    function = lambda port, pin: registers.values[port + 0x20 + pin // 8 * 4] >> pin % 8 * 4 & 15
    alternates = {
        reg.GPIOA: {9: 7, 10: 7, 15: 1, 0: 2, 1: 2, 6: 3},
        reg.GPIOB: {3: 1, 4: 2, 5: 2, 6: 2, 7: 2, 13: 5, 14: 5},
        reg.GPIOC: {6: 3, 7: 3, 8: 3, 9: 3},
    }
    for port, pins in alternates.items():
        for pin, wanted in pins.items():
            assert (mode(port, pin), function(port, pin)) == (2, wanted), (hex(port), pin)
    for port, pins in {reg.GPIOB: (12, 1, 15), reg.GPIOC: (0, 1, 2, 3, 4, 12)}.items():
        assert all(mode(port, pin) == 1 for pin in pins)
    assert registers.values[reg.GPIOB + 8] >> 2 * 13 & 3 >= 1, "the clock of the converter needs a faster output"


def says_its_own_number():
    identity = started().ask(wrap(0x11, 1, bytes([1, 1])))
    assert identity[0] == 0x91 and identity[7:19] == UNIQUE, identity.hex()


def reports_its_sensors():
    board = configured()
    values = board.registers.values
    values[reg.TIM2 + 0x24], values[reg.TIM5 + 0x24] = 0xFFFFFFFE, 70000
    values[reg.TIM3 + 0x24], values[reg.TIM4 + 0x24] = 65530, 9
    first = struct.unpack_from("<4H4H", board.ask(command([0] * 4, flags=0)), 4)
    assert first == (0xFFFE, 70000 & 0xFFFF, 65530, 9, 32868, 32668, 32768, 64768), first
    # The two counters of 16 bits wrap, in opposite directions.
    values[reg.TIM3 + 0x24], values[reg.TIM4 + 0x24] = 5, 65535
    board.run_for(15000)
    counts = struct.unpack_from("<4i", board.ask(configure(watchdog_ms=1000)), 34)
    assert counts == (-2, 70000, 5, -1), counts


def counts_while_the_line_carries_noise():
    board = configured()
    # A zero byte is a delimiter, and every delimiter begins a sample. The 16 bits of TIM3 wrap.
    for turned in range(0, 80001, 5000):
        board.registers.values[reg.TIM3 + 0x24] = turned & 0xFFFF
        board.send(bytes(1), 1_000_000)
        board.run_for(5000)
    counts = struct.unpack_from("<4i", board.ask(configure(watchdog_ms=1000)), 34)
    assert counts[2] == 80000, counts


def drives_the_motors():
    board = configured()
    registers = board.registers
    assert registers.enabled() == (False, False)
    # A unit of the command is 2000 nN m, and 2000 nN m / 23.4 mN m/A is 85.47 uA. A step of the PWM is 500 uA.
    reply = board.ask(command([1000, -2000, 0, 23750]))
    assert status(reply) & ENABLED and registers.enabled() == (True, True)
    steps = [registers.values[reg.TIM8 + 0x34 + 4 * motor] for motor in range(4)]
    assert steps == [170, 341, 0, 4059], steps
    assert registers.values[reg.GPIOC + reg.ODR] & 15 == 0b1101
    assert registers.values[reg.GPIOC + reg.ODR] & 1 << 12, "the toggle bit"
    board.ask(command([0] * 4))
    assert registers.enabled() == (False, False)


def stops_when_nobody_commands():
    board = started()
    board.ask(configure(watchdog_ms=2))
    board.ask(command([1000] * 4))
    board.run_for(1500)
    assert board.registers.enabled() == (True, True)
    board.run_for(700)
    assert board.registers.enabled() == (False, False)


def stops_by_every_fault():
    def no_converter(registers):
        registers.converter = False

    def open_bridge(registers):
        registers.gauges[2] = 0x7FFF

    def supply(registers):
        registers.supply = False

    def driver(registers):
        registers.driver_fault = True

    stop = reg.Registers.press_stop
    faults = {stop: STOPPED, supply: SUPPLY, driver: DRIVER, no_converter: SENSOR, open_bridge: SENSOR}
    for cause, bit in faults.items():
        board = configured()
        assert status(board.ask(command([1000] * 4))) & ENABLED
        cause(board.registers)
        for _ in range(3):
            reply = board.ask(command([1000] * 4))
        board.run_for(100)
        assert board.registers.enabled() == (False, False), cause
        assert status(board.ask(command([1000] * 4))) & bit, cause
        assert board.registers.enabled() == (False, False), cause


def notices_a_short_press_of_the_stop():
    board = configured()
    board.ask(command([1000] * 4))
    board.registers.press_stop()
    board.registers.stop = False
    board.run_for(50)
    assert board.registers.enabled() == (False, False)
    assert status(board.ask(command([1000] * 4))) & STOPPED


def refuses_to_move_without_a_crystal():
    board = started(crystal=False)
    assert 16e6 / board.registers.values[reg.USART1 + 8] == 1e6
    # The model counts 168 cycles in a us even without the crystal, so a byte at 1 Mbaud takes 1680 cycles.
    board.registers.byte_cycles = 1680
    refused = board.ask(configure(), baud=1_000_000)
    assert refused[0] == 0xD1 and refused[3] == 5 and refused[4] | refused[5] << 8 == SENSOR, refused.hex()
    assert board.registers.longest_unfed < 168 * 3000


def removes_the_torque_when_the_processor_faults():
    board = configured()
    board.ask(command([1000] * 4))
    assert board.registers.enabled() == (True, True)
    board.pc = board.program.symbols["processor_fault"] | 1
    fed = board.registers.fed_at
    board.run_for(100)
    assert board.registers.enabled() == (False, False)
    assert board.registers.fed_at == fed, "the watchdog must be left to reset the processor"


def feeds_the_watchdog():
    board = configured()
    for _ in range(5):
        board.ask(command([1000] * 4))
    board.run_for(12000)
    # With the fastest oscillator, the watchdog resets the processor after 6.8 ms.
    assert board.registers.longest_unfed < 168 * 500, board.registers.longest_unfed / 168
    assert board.registers.overruns == 0


CHECKS = [
    starts_safely,
    drives_every_pin_that_the_table_names,
    says_its_own_number,
    reports_its_sensors,
    counts_while_the_line_carries_noise,
    drives_the_motors,
    stops_when_nobody_commands,
    stops_by_every_fault,
    notices_a_short_press_of_the_stop,
    refuses_to_move_without_a_crystal,
    removes_the_torque_when_the_processor_faults,
    feeds_the_watchdog,
]

if __name__ == "__main__":
    for check in CHECKS:
        check()
        print(check.__name__.replace("_", " "))
