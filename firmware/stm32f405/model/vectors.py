"""Runs the firmware image on the model of the board. Sends it the conversations of protocol/vectors.json, then noise.

    vectors.py stm32f405.elf stm32f405.bin protocol/vectors.json"""

import json
import random
import struct
import sys

from board import Board, unwrap, wrap

TYPES = {0x9: "Identity", 0xA: "Configured", 0xB: "Reply", 0xC: "Stopped", 0xD: "Refused", 0xE: "TactileEvent"}
STATUS_AT = {0xA: 58, 0xB: 2, 0xC: 2}
STOP, SUPPLY, DRIVER = 1 << 6, 1 << 7, 1 << 8
ZERO_VALID = 1 << 5
# Longest wait in a conversation, ms. Conversations with longer waits are left out, because the model is slow.
LONGEST = 200
STREAMS = 60


def started():
    board = Board(sys.argv[1], open(sys.argv[2], "rb").read())
    board.run_for(150)
    return board


def answer_of(board, wire):
    """The frame that the board sends within 0.6 ms of the last byte, or None."""
    board.registers.sent.clear()
    board.registers.byte_cycles = 840
    last = board.send(wire, 2_000_000)
    board.run(lambda: board.registers.now >= last + 168 * 600)
    sent = bytes(byte for _, byte in board.registers.sent)
    return unwrap(sent) if sent else None


def check(board, step):
    frame = answer_of(board, bytes.fromhex(step["send"]))
    if step["answer"] == "none":
        assert frame is None, f"no answer expected, but the board sent {frame.hex()}"
        return
    assert frame is not None, "no answer"
    kind = frame[0] >> 4
    assert TYPES[kind] == step["answer"], f"{step['answer']} expected, but the board sent {frame.hex()}"
    if "status" in step:
        status = struct.unpack_from("<H", frame, STATUS_AT[kind])[0]
        assert (status ^ step["status"]) & ~ZERO_VALID == 0, f"status {status:#x}"
    if "reason" in step:
        found, expected = (frame[3], frame[4] | frame[5] << 8), (step["reason"], step["detail"])
        assert found == expected, f"reason and detail {found}, but {expected} expected"


def possible(step):
    """Whether the model can run this step. It cannot run a long wait or inject a sensor fault."""
    return step.get("wait_ms", 0) <= LONGEST and step.get("faults", 0) & ~(STOP | SUPPLY | DRIVER) == 0


def converse(conversation):
    board = started()
    for step in conversation["steps"]:
        if "wait_ms" in step:
            board.run_for(1000 * step["wait_ms"])
        elif "faults" in step:
            registers, faults = board.registers, step["faults"]
            registers.supply, registers.driver_fault = not faults & SUPPLY, bool(faults & DRIVER)
            registers.stop = False
            if faults & STOP:
                registers.press_stop()
            board.run_for(50)
        elif "torques" in step:
            assert board.registers.enabled() == (any(step["torques"]),) * 2, step
        else:
            check(board, step)


def noise():
    """Random bytes and damaged frames: the board answers the next good frame, and no motor ever has torque."""
    board, any_byte = started(), random.Random(1)
    for _ in range(STREAMS):
        good = bytearray(wrap(0x11, any_byte.randrange(256), bytes([1, 1])))
        good[any_byte.randrange(len(good))] ^= 1 << any_byte.randrange(8)
        other = bytes(any_byte.randrange(256) for _ in range(any_byte.randrange(200)))
        # By chance, these bytes may contain a good frame. Its answer is ignored.
        answer_of(board, bytes(good) if any_byte.random() < 0.5 else other)
        sequence = any_byte.randrange(256)
        frame = answer_of(board, b"\0" + wrap(0x11, sequence, bytes([1, 1])))
        assert frame is not None and frame[:2] == bytes([0x91, sequence]), "no answer to a good frame after noise"
        enabled, overruns = board.registers.enabled(), board.registers.overruns
        assert enabled == (False, False) and overruns == 0, f"enabled {enabled}, {overruns} overruns after noise"


if __name__ == "__main__":
    with open(sys.argv[3]) as file:
        conversations = json.load(file)["conversations"]
    left_out = 0
    for conversation in conversations:
        if not all(map(possible, conversation["steps"])):
            left_out += 1
            continue
        try:
            converse(conversation)
        except AssertionError as failure:
            sys.exit(f"{conversation['name']}: {failure}")
    noise()
    passed = f"passed: {len(conversations) - left_out} conversations and {STREAMS} streams of noise"
    print(f"{passed}. Left out, because the model cannot run them: {left_out} conversations")
