"""Runs the firmware image of the board on an emulated Cortex-M4 (Unicorn), with models of the peripheral registers.

Time is the number of processor cycles that the model computes."""

import struct
import zlib
from collections import OrderedDict

from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import UC_ARM_REG_LR, UC_ARM_REG_PRIMASK, UC_ARM_REG_SP, UC_ARM_REG_XPSR, UC_CPU_ARM_CORTEX_M4

from cycles import REFILL, Program
from registers import MEGAHERTZ, SYSTICK, Registers, bus_wait

FLASH, SRAM, SYSTEM = 0x08000000, 0x20000000, 0x1FFF7000
UNIQUE = bytes(range(0xA0, 0xAC))
# An exception pushes eight registers in 12 cycles and pops them in 10.
ENTRY, EXIT = 12, 10
# The bits of xPSR that make the next instructions conditional (IT). Entering an exception clears them.
CONDITIONAL = 0x0600FC00
# Exception handlers return to this address.
RETURN = FLASH + 0xFFFF0
# At 168 MHz, the flash needs five wait states to read a line of 16 bytes.
LINE, WAIT_STATES, CACHE_LINES = 16, 5, 64


class Board:
    """A board with the firmware image. With `cached`, the flash has the accelerator that RM0090, 3.5.2, describes: the
    64 lines of instructions that were used last need no wait states. Prefetch is off. A load of a constant beside the
    code always waits. A load from the table of the checksum does not wait, because the table is in the cache for data.
    Without `cached`, every new line and every load waits, even a load from SRAM. The times are then upper bounds."""

    def __init__(self, image, binary, cached=True):
        self.program = Program(image)
        self.registers = Registers()
        self.cached = cached
        self.arrivals = []
        self.handling = False
        self.blocks = {}
        self.lines = OrderedDict()
        self.end = 0
        self.until = None
        self.instructions = 0
        self.longest_handler = 0
        self.rounds = 0
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
        self.uc.mem_map(FLASH, 0x100000)
        self.uc.mem_map(SRAM, 0x20000)
        self.uc.mem_map(SYSTEM, 0x1000)
        self.uc.mem_write(FLASH, binary)
        self.uc.mem_write(0x1FFF7A10, UNIQUE)
        for base, size in ((0x40000000, 0x30000), (0xE000E000, 0x1000)):
            self.uc.mmio_map(base, size, self.read, base, self.write, base)
        self.uc.hook_add(UC_HOOK_BLOCK, self.block)
        stack, start = struct.unpack_from("<II", binary)
        self.uc.reg_write(UC_ARM_REG_SP, stack)
        self.pc = start | 1

    def read(self, uc, offset, size, base):
        self.registers.now += bus_wait(base)
        return self.registers.read(base + offset) & (1 << 8 * size) - 1

    def write(self, uc, offset, size, value, base):
        self.registers.now += bus_wait(base)
        self.registers.write(base + offset, value)

    def block(self, uc, address, size, data):
        """Called before each basic block. Interrupts are taken only here."""
        registers = self.registers
        while self.arrivals and self.arrivals[0][0] <= registers.now:
            registers.receive(self.arrivals.pop(0)[1])
        if not self.handling and (self.until() or self.interrupted() or self.clock_wrapped()):
            self.pc = address | 1
            uc.emu_stop()
            return
        if (address, size) not in self.blocks:
            self.blocks[address, size] = self.program.block(address, size)
        cycles, count, constants, loads = self.blocks[address, size]
        registers.now += cycles
        if address != self.end:
            registers.now += REFILL
        registers.now += WAIT_STATES * (self.fetch(address, size) + (constants if self.cached else loads))
        self.end = address + size
        self.instructions += count

    def fetch(self, address, size):
        """The number of lines that the flash must read for these instructions."""
        misses = 0
        for line in range(address // LINE, (address + size - 1) // LINE + 1):
            if line == (self.end - 1) // LINE:
                continue
            if not self.cached or self.lines.pop(line, None) is None:
                misses += 1
            self.lines[line] = True
            if len(self.lines) > CACHE_LINES:
                self.lines.popitem(last=False)
        return misses

    def interrupted(self):
        return self.registers.interrupts() and not self.uc.reg_read(UC_ARM_REG_PRIMASK)

    def clock_wrapped(self):
        """Whether SysTick requests its interrupt."""
        reload = self.registers.values.get(SYSTICK + 4, 0)
        return reload != 0 and self.registers.now // (reload + 1) > self.rounds

    def run(self, until):
        """Runs the firmware until the condition holds."""
        self.until = until
        while True:
            self.uc.emu_start(self.pc, 0xFFFFFFFE)
            if self.clock_wrapped():
                self.rounds += 1
                self.call("systick_interrupt")
            elif self.interrupted():
                self.call("serial_interrupt")
            if until():
                return

    def call(self, handler):
        """Runs an exception handler to its end."""
        context = self.uc.context_save()
        begin = self.registers.now
        self.registers.now += ENTRY
        self.handling = True
        self.uc.reg_write(UC_ARM_REG_SP, self.uc.reg_read(UC_ARM_REG_SP) - 32)
        self.uc.reg_write(UC_ARM_REG_LR, RETURN | 1)
        self.uc.reg_write(UC_ARM_REG_XPSR, self.uc.reg_read(UC_ARM_REG_XPSR) & ~CONDITIONAL)
        self.uc.emu_start(self.program.symbols[handler] | 1, RETURN)
        self.handling = False
        self.end = 0
        self.registers.now += EXIT
        self.longest_handler = max(self.longest_handler, self.registers.now - begin)
        self.uc.context_restore(context)

    def run_for(self, microseconds):
        end = self.registers.now + int(microseconds * MEGAHERTZ)
        self.run(lambda: self.registers.now >= end)

    def send(self, wire, baud, after=0):
        """Sends bytes to the board. Returns the time at which the last of them arrives, in cycles."""
        byte = MEGAHERTZ * 10_000_000 // baud
        begin = self.registers.now + after
        self.arrivals += [(begin + (n + 1) * byte, value) for n, value in enumerate(wire)]
        return self.arrivals[-1][0]

    def ask(self, wire, baud=1_000_000):
        """Sends a request and returns the frame of the answer, without its checksum."""
        self.registers.sent.clear()
        self.send(wire, baud)
        end = self.registers.now + 2000 * MEGAHERTZ
        sent = self.registers.sent
        self.run(lambda: bool(sent) and sent[-1][1] == 0 or self.registers.now >= end)
        return unwrap(bytes(byte for _, byte in sent))


def wrap(header, sequence, body=b""):
    """A frame on the wire (docs/board-protocol.md)."""
    frame = bytes([header, sequence]) + body
    frame += struct.pack("<I", zlib.crc32(frame))
    return b"".join(bytes([len(part) + 1]) + part for part in frame.split(b"\0")) + b"\0"


def unwrap(wire):
    assert wire.endswith(b"\0"), f"no whole answer: {wire.hex()}"
    rest, parts = wire[:-1], []
    while rest:
        parts.append(rest[1 : rest[0]])
        rest = rest[rest[0] :]
    frame = b"\0".join(parts)
    assert struct.unpack("<I", frame[-4:])[0] == zlib.crc32(frame[:-4]), "the checksum of the answer is wrong"
    return frame[:-4]


def configure(limits=(23750,) * 4, constants=(23400,) * 4, watchdog_ms=18):
    return wrap(0x21, 1, struct.pack("<BHBHH4H4I", 1, watchdog_ms, 0, 0, 0, *limits, *constants))


def command(torques, sequence=7, flags=3):
    return wrap(0x31, sequence, struct.pack("<B4h", flags, *torques))
