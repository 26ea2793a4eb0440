"""Cycles of the instructions of a Cortex-M4 (Technical Reference Manual r0p1, 3.3.1), as an upper bound: a taken branch
refills the pipeline in 3 cycles, a division takes 12, and a load or store 2, although many overlap."""

import re
import subprocess

REFILL = 3


def registers(operands):
    """Number of registers in a list such as {r4, r5, r7-r9, lr}."""
    count = 0
    for part in re.search(r"\{(.*)\}", operands).group(1).split(","):
        names = part.strip().split("-")
        count += 1 if len(names) == 1 else int(names[1][1:]) - int(names[0][1:]) + 1
    return count


def cost(name, operands):
    """Cycles of an instruction that does not branch. The caller adds the refill of the pipeline after a
    jump."""
    if name in ("push", "pop") or name.startswith(("ldm", "stm")):
        return 1 + registers(operands)
    if name in ("ldrd", "strd"):
        return 3
    if name.startswith(("ldr", "str", "mla", "mls", "tb", "cps", "dsb", "isb")):
        return 2
    if name.startswith(("udiv", "sdiv")):
        return 12
    return 1


class Program:
    """The disassembled image: cycles of each instruction, and addresses of symbols."""

    def __init__(self, image):
        run = lambda *command: subprocess.run(command, capture_output=True, text=True, check=True).stdout
        self.instructions = {}
        pattern = re.compile(r"^\s*([0-9a-f]+):\t([0-9a-f ]+?)\s*\t(\S+)\s*(.*)$")
        for line in run("arm-none-eabi-objdump", "-d", image).splitlines():
            found = pattern.match(line)
            if found and not found.group(3).startswith("."):
                name = found.group(3).split(".")[0]
                size = len(found.group(2).replace(" ", "")) // 2
                # Whether the instruction loads a constant that is stored beside the code, and whether it loads at all.
                loads = ("[pc" in found.group(4), name.startswith(("ldr", "ldm", "pop", "tb")))
                self.instructions[int(found.group(1), 16)] = (size, cost(name, found.group(4)), loads)
        self.symbols = {}
        for line in run("arm-none-eabi-nm", image).splitlines():
            words = line.split()
            if len(words) == 3:
                self.symbols[words[2]] = int(words[0], 16)

    def block(self, begin, size):
        """Returns four sums over the `size` bytes of code from `begin` on: cycles, instructions, loads of constants,
        and loads of any kind."""
        cycles = count = constants = loads = 0
        address = begin
        while address < begin + size:
            length, cost_of_this, (is_constant, is_load) = self.instructions[address]
            address += length
            cycles += cost_of_this
            count += 1
            constants += is_constant
            loads += is_load
        return cycles, count, constants, loads
