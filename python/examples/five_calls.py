"""The five calls of 1990 from Python, without the package sun2xp: cffi reads the declarations of the C header, and
loads the shared library. Any other language with a foreign function interface can drive the hand in the same way.

    python five_calls.py include/Sun2Xp.h target/release/libsun2xp.so
"""

import re
import sys

import cffi

CALLS = ["OpenHand", "CloseHand", "SendPosD", "SendKxD", "GetPosD", "HandError"]


def declarations(header: str) -> str:
    """The declarations of the calls in the text of the header."""
    found = {}
    without_comments = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    for declaration, name in re.findall(r"^((?:const )?\w+ \*?(\w+)\([^;{]*\);)", without_comments, re.MULTILINE):
        if name in CALLS:
            found[name] = declaration
    missing = set(CALLS) - set(found)
    assert not missing, f"the header does not declare {missing}"
    return "\n".join(found.values())


def main(header: str, library: str) -> None:
    ffi = cffi.FFI()
    with open(header) as file:
        ffi.cdef(declarations(file.read()))
    hand = ffi.dlopen(library)

    def check(result: int) -> None:
        if result != 0:
            raise RuntimeError(ffi.string(hand.HandError()).decode())

    check(hand.OpenHand())
    check(hand.SendKxD(1, ffi.new("double[9]", [2, 0, 0, 0, 2, 0, 0, 0, 1])))
    check(hand.SendPosD(1, ffi.new("double[3]", [0.1, 0.6, 0.9])))
    joints = ffi.new("double[3]")
    check(hand.GetPosD(1, joints))
    print("joints", *(f"{joint:.3f}" for joint in joints))
    if hand.SendPosD(7, joints) != -1:
        raise RuntimeError("the hand accepted a command for finger 7")
    print(ffi.string(hand.HandError()).decode())
    check(hand.CloseHand())


if __name__ == "__main__":
    main(*sys.argv[1:])
