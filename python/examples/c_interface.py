"""The C interface from Python, without the package sun2xp: cffi reads the whole header sun2xp.h, and loads the shared
library. Any other language with a foreign function interface can drive the hand in the same way.

    python c_interface.py include/sun2xp.h target/release/libsun2xp.so
"""

import re
import sys

import cffi


def declarations(header: str) -> str:
    """The declarations and constants of the header. Comments and all other preprocessor lines are left out."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    # The blocks for C++ and the blocks that check the sizes of structs are left out. cffi computes the sizes itself.
    text = re.sub(r"#ifdef __(cplusplus|LP64__)\n.*?#endif", "", text, flags=re.DOTALL)
    lines = (line.strip() for line in text.splitlines())
    constant = re.compile(r"#define \w+ +\d+$")
    return "\n".join(line for line in lines if constant.match(line) or not line.startswith("#"))


def main(header: str, library: str) -> None:
    ffi = cffi.FFI()
    with open(header) as file:
        ffi.cdef(declarations(file.read()))
    sun2xp = ffi.dlopen(library)

    def check(result: int) -> None:
        if result < 0:
            raise RuntimeError(ffi.string(sun2xp.sun2xp_error_text(ffi.NULL)).decode())

    opened = ffi.new("sun2xp_hand **")
    check(sun2xp.sun2xp_open_named(b"nominal", opened))
    hand = opened[0]
    check(sun2xp.sun2xp_send_stiffness(hand, 1, [2, 0, 0, 0, 2, 0, 0, 0, 1]))
    check(sun2xp.sun2xp_send_position(hand, 1, [0.1, 0.6, 0.9]))
    check(sun2xp.sun2xp_wait(hand, 1, sun2xp.SUN2XP_WAIT_ARRIVED, 20.0))
    tip = ffi.new("struct sun2xp_tip *")
    tip.size = ffi.sizeof("struct sun2xp_tip")
    check(sun2xp.sun2xp_tip(hand, 1, tip))
    print("tip", *(f"{place:.2f}" for place in tip.position), "cm")
    if sun2xp.sun2xp_send_position(hand, 7, [0, 0, 0]) != -sun2xp.SUN2XP_ERROR_ARGUMENT:
        raise RuntimeError("a command for finger 7 was not refused as a wrong argument")
    print(ffi.string(sun2xp.sun2xp_error_text(hand)).decode())
    check(sun2xp.sun2xp_close(hand))


if __name__ == "__main__":
    main(*sys.argv[1:])
