/* Tests the firmware against the test vectors.

       vectors protocol/vectors.json

   The program reads the file line by line: every vector is an object on its own line. The program can test a board of
   your own design too: write a hardware layer like fake_hardware.c for this board, and keep the rest. */

#include "fake_hardware.h"
#include "../core/protocol.h"
#include "vector_line.h"
#include <stdio.h>
#include <string.h>

/* Frames */

static size_t frames_in(const uint8_t *bytes, size_t length, struct frame *last, unsigned *damaged)
{
    struct receiver receiver = {0};
    size_t found = 0;
    for (size_t i = 0; i < length; i++) {
        enum received received = receiver_take(&receiver, bytes[i]);
        if (received == RECEIVED_FRAME) {
            found++;
            *last = receiver.frame;
        } else if (received == RECEIVED_DAMAGE) {
            (*damaged)++;
        }
    }
    return found;
}

static void terms_of_line(struct configure *terms)
{
    terms->version = (uint8_t)number("version", 0);
    terms->watchdog_ms = (uint16_t)number("watchdog_ms", 0);
    terms->end_state = (uint8_t)number("end_state", 0);
    terms->hold_time_ms = (uint16_t)number("hold_time_ms", 0);
    terms->hold_torque_limit = (uint16_t)number("hold_torque_limit", 0);
    for (size_t i = 0; i < MOTORS; i++) {
        terms->torque_limits[i] = (uint16_t)number("torque_limits", i);
        terms->torque_constants[i] = (uint32_t)number("torque_constants", i);
    }
}

/* Reads a request and compares it field by field. */
static void check_request(const struct frame *frame)
{
    if (frame_type(frame) == TYPE_HELLO) {
        struct hello hello;
        read_hello(frame, &hello);
        expect(hello.lowest_version == number("lowest_version", 0), "lowest version");
        expect(hello.highest_version == number("highest_version", 0), "highest version");
    } else if (frame_type(frame) == TYPE_CONFIGURE) {
        struct configure terms, wanted;
        read_configure(frame, &terms);
        terms_of_line(&wanted);
        expect(terms.version == wanted.version && terms.watchdog_ms == wanted.watchdog_ms, "version or watchdog");
        expect(terms.end_state == wanted.end_state, "end state");
        expect(terms.hold_time_ms == wanted.hold_time_ms, "hold time");
        expect(terms.hold_torque_limit == wanted.hold_torque_limit, "hold torque limit");
        for (size_t i = 0; i < MOTORS; i++) {
            expect(terms.torque_limits[i] == wanted.torque_limits[i], "torque limits");
            expect(terms.torque_constants[i] == wanted.torque_constants[i], "torque constants");
        }
    } else if (frame_type(frame) == TYPE_COMMAND) {
        struct command command;
        read_command(frame, &command);
        expect(command.toggle == (number("toggle", 0) != 0), "toggle");
        expect(command.enable == (number("enable", 0) != 0), "enable");
        for (size_t i = 0; i < MOTORS; i++)
            expect(command.torques[i] == number("torques", i), "torques");
    }
}

/* Writes an answer from the fields of its vector. The caller compares the bytes. Returns false for frames that this
   board never sends. */
static bool write_answer(struct frame *frame, uint8_t type)
{
    struct sensors sensors = {0};
    bool has_status = type == TYPE_CONFIGURED || type == TYPE_REPLY || type == TYPE_STOPPED;
    uint16_t status = has_status ? (uint16_t)number("status", 0) : 0;
    for (size_t i = 0; i < MOTORS && (type == TYPE_CONFIGURED || type == TYPE_REPLY); i++) {
        sensors.encoders[i] = (int32_t)number("encoders", i);
        sensors.gauges[i] = (uint16_t)number("gauges", i);
    }
    frame_begin(frame, type, (uint8_t)number("address", 0), (uint8_t)number("sequence", 0));
    if (type == TYPE_IDENTITY) {
        struct identity identity = {
            .version = (uint8_t)number("version", 0),
            .addresses = (uint16_t)number("addresses", 0),
            .kind = (uint16_t)number("board_kind", 0),
            .counts_per_revolution = (uint32_t)number("counts_per_revolution", 0),
            .gauge_bits = (uint8_t)number("gauge_bits", 0),
            .torque_unit = (uint32_t)number("torque_unit", 0),
            .torque_limit = (uint16_t)number("torque_limit", 0),
            .shortest_watchdog_ms = (uint16_t)number("shortest_watchdog_ms", 0),
            .capabilities = (uint32_t)number("capabilities", 0),
        };
        for (size_t i = 0; i < sizeof identity.unique_number; i++)
            identity.unique_number[i] = (uint8_t)number("unique_number", i);
        for (size_t i = 0; i < sizeof identity.firmware_version; i++)
            identity.firmware_version[i] = (uint8_t)number("firmware_version", i);
        write_identity(frame, &identity);
    } else if (type == TYPE_CONFIGURED) {
        struct configure terms;
        terms_of_line(&terms);
        write_configured(frame, &terms, &sensors, status);
    } else if (type == TYPE_REPLY) {
        write_reply(frame, status, &sensors, (uint16_t)number("sampled_at", 0));
    } else if (type == TYPE_STOPPED) {
        write_stopped(frame, status);
    } else if (type == TYPE_TACTILE_EVENT) {
        struct tactile_event event = {
            .waiting = (uint8_t)number("waiting", 0),
            .number = (uint8_t)number("number", 0),
            .change = (uint8_t)number("change", 0),
            .element = (uint16_t)number("element", 0),
            .count = (uint16_t)number("count", 0),
            .noticed_at = (uint32_t)number("noticed_at", 0),
            .lost = (uint8_t)number("lost", 0),
        };
        write_tactile_event(frame, &event);
    } else if (type == TYPE_REFUSED) {
        uint8_t request = (uint8_t)number("request", 0), reason = (uint8_t)number("reason", 0);
        write_refused(frame, request, reason, (uint16_t)number("detail", 0));
    } else {
        return false;
    }
    return true;
}

static void check_frame(void)
{
    uint8_t wire[BYTES_MOST], again[WIRE_MOST];
    size_t length = bytes_of("wire", wire);
    struct frame frame, written;
    unsigned damaged = 0;
    int good = frames_in(wire, length, &frame, &damaged) == 1 && damaged == 0;
    expect(good, "exactly one good frame");
    if (!good)
        return;
    expect(frame_address(&frame) == number("address", 0) && frame_sequence(&frame) == number("sequence", 0), "prefix");
    expect(frame_to_wire(&frame, again) == length && memcmp(wire, again, length) == 0, "same bytes when stuffed again");
    if ((frame_type(&frame) & TYPE_IS_ANSWER) == 0) {
        check_request(&frame);
    } else if (write_answer(&written, frame_type(&frame))) {
        expect(frame_to_wire(&written, again) == length && memcmp(wire, again, length) == 0, "same bytes when written");
    }
}

static const uint8_t good_frame[] = {0x07, 0x41, 0x03, 0x01, 0x3D, 0xB2, 0x31, 0x00};

/* Checks that a bad frame is rejected and the good frame after it is found. */
static void check_bad(void)
{
    uint8_t wire[BYTES_MOST + sizeof good_frame];
    size_t length = bytes_of("wire", wire);
    struct frame frame;
    unsigned damaged = 0;
    memcpy(wire + length, good_frame, sizeof good_frame);
    expect(frames_in(wire, length + sizeof good_frame, &frame, &damaged) == 1, "only the next frame accepted");
    expect(damaged == 1, "damage counted once");
    expect(frame_sequence(&frame) == 3, "sequence number of the next frame");
}

/* A board and a conversation with it */

static struct finger fingers[1];
static struct board board;

static void power_up(void)
{
    uint32_t now = fake.now;
    memset(&fake, 0, sizeof fake);
    /* The first power-up sets the clock shortly before its wrap, and later ones keep it. So the clock wraps during a
       conversation, which must not matter. */
    fake.now = now == 0 ? 0xFFFFFFFFu - 50000u : now;
    finger_start(&fingers[0], &fake_traits[0], 0);
    board_start(&board, 0, fingers, 1);
}

static void say(const char *name)
{
    uint8_t wire[BYTES_MOST];
    size_t length = bytes_of(name, wire);
    fake.output_length = 0;
    fake_arrive(&board, wire, length);
}

static void check_ignored(void)
{
    power_up();
    say("wire");
    expect(fake.output_length == 0, "no answer");
    expect(!fingers[0].damaged, "not taken for damage");
}

/* Sends a request and checks the answer. */
static void check_exchange(void)
{
    say("send");
    struct frame answer = {0};
    unsigned damaged = 0;
    size_t found = frames_in(fake.output, fake.output_length, &answer, &damaged);
    bool silent = text_is("answer", "none");
    expect(found == (silent ? 0 : 1) && damaged == 0, "number of answers");
    if (silent || found != 1)
        return;
    expect(frame_address(&answer) == 1, "address");
    if (text_is("answer", "Refused")) {
        expect(frame_type(&answer) == TYPE_REFUSED, "type of the answer");
        expect(frame_get8(&answer, 3) == number("reason", 0), "reason");
        expect(frame_get16(&answer, 4) == number("detail", 0), "detail");
    } else if (text_is("answer", "Identity")) {
        expect(frame_type(&answer) == TYPE_IDENTITY, "type of the answer");
    } else {
        bool configured = text_is("answer", "Configured"), stopped = text_is("answer", "Stopped");
        uint8_t type = configured ? TYPE_CONFIGURED : stopped ? TYPE_STOPPED : TYPE_REPLY;
        expect(frame_type(&answer) == type, "type of the answer");
        unsigned status = frame_get16(&answer, configured ? 58 : 2);
        expect((status & ~(unsigned)STATUS_ZERO_VALID) == number("status", 0), "status");
    }
}

static void check_step(void)
{
    if (value("wait_ms") != NULL) {
        fake_wait(&board, 1000 * (uint32_t)number("wait_ms", 0));
    } else if (value("faults") != NULL) {
        fake.faults = (uint16_t)number("faults", 0);
    } else if (value("torques") != NULL) {
        for (size_t i = 0; i < MOTORS; i++)
            expect(fake_torque(0, i, 23400) == number("torques", i), "torques");
    } else {
        check_exchange();
    }
}

int main(int count, char **arguments)
{
    static char line[LINE_MOST];
    void (*check)(void) = NULL;
    unsigned vectors = 0;
    if (count != 2) {
        fprintf(stderr, "usage: vectors protocol/vectors.json\n");
        return 2;
    }
    FILE *file = fopen(arguments[1], "r");
    if (file == NULL) {
        perror(arguments[1]);
        return 2;
    }
    current_line = line;
    while (fgets(line, sizeof line, file) != NULL) {
        line_number++;
        if (strncmp(line, "\"frames\"", 8) == 0) {
            check = check_frame;
        } else if (strncmp(line, "\"bad\"", 5) == 0) {
            check = check_bad;
        } else if (strncmp(line, "\"ignored\"", 9) == 0) {
            check = check_ignored;
        } else if (strncmp(line, "\"conversations\"", 15) == 0) {
            check = check_step;
        } else if (value("steps") != NULL) {
            strcpy(conversation, line);
            power_up();
        } else if (line[0] == '{' && check != NULL) {
            check();
            vectors++;
        }
    }
    fclose(file);
    printf("%u vectors, %u checks, %u failures\n", vectors, checked, failures);
    bool complete = vectors > 100;
    if (!complete)
        printf("more than 100 vectors expected: give protocol/vectors.json, with one vector in each line\n");
    return failures == 0 && complete ? 0 : 1;
}
