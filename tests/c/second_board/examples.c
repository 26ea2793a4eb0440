/* Builds the example frames of docs/board-protocol.md from the values that the page states, and compares them with the
   bytes on the page. */

#include "examples.h"
#include "board.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

static const uint32_t example_encoders[MOTORS] = {100000, 0xFFFFFFFF, 0, 65536};
static const uint32_t example_gauges[MOTORS] = {410, 205, 205, 410};

static void put_example_configure(struct frame *frame)
{
    put8(frame, 1);
    put16(frame, 20);
    put8(frame, 1);
    put16(frame, 2000);
    put16(frame, 5000);
    for (int i = 0; i < MOTORS; i++)
        put16(frame, 23750);
    for (int i = 0; i < MOTORS; i++)
        put32(frame, 23400);
}

static void hello(struct frame *frame)
{
    begin(frame, HELLO, 1, 1);
    put8(frame, 1);
    put8(frame, 1);
}

static void identity(struct frame *frame)
{
    begin(frame, IDENTITY, 1, 1);
    put8(frame, 1);
    put16(frame, 1 << 1 | 1 << 2 | 1 << 3);
    put16(frame, 0x8000);
    for (unsigned i = 1; i <= 12; i++)
        put8(frame, i);
    put8(frame, 1);
    put8(frame, 2);
    put8(frame, 3);
    put32(frame, 2000);
    put8(frame, 12);
    put32(frame, 2000);
    put16(frame, 23750);
    put16(frame, 2);
    put32(frame, 1 << 0 | 1 << 1 | 1 << 2 | 1 << 3);
}

static void configure(struct frame *frame)
{
    begin(frame, CONFIGURE, 1, 2);
    put_example_configure(frame);
}

static void configured(struct frame *frame)
{
    begin(frame, CONFIGURED, 1, 2);
    put_example_configure(frame);
    for (int i = 0; i < MOTORS; i++)
        put32(frame, example_encoders[i]);
    for (int i = 0; i < MOTORS; i++)
        put16(frame, example_gauges[i]);
    put16(frame, IS_CONFIGURED | ZERO_VALID);
}

static void stop(struct frame *frame)
{
    begin(frame, STOP, 1, 3);
}

static void stopped(struct frame *frame)
{
    begin(frame, STOPPED, 1, 3);
    put16(frame, IS_CONFIGURED | HAS_ENDED | ZERO_VALID);
}

static void refused(struct frame *frame)
{
    begin(frame, REFUSED, 1, 9);
    put8(frame, COMMAND);
    put8(frame, 3);
    put16(frame, 0);
}

static void command(struct frame *frame)
{
    begin(frame, COMMAND, 1, 7);
    put8(frame, 1 | 2);
    put16(frame, 1188);
    put16(frame, 594);
    put16(frame, 0);
    put16(frame, 0xFFFF);
}

static void reply(struct frame *frame)
{
    begin(frame, REPLY, 1, 7);
    put16(frame, IS_CONFIGURED | IS_ENABLED | ZERO_VALID);
    for (int i = 0; i < MOTORS; i++)
        put16(frame, example_encoders[i]);
    for (int i = 0; i < MOTORS; i++)
        put16(frame, example_gauges[i]);
    put16(frame, 12345);
}

static void tactile_request(struct frame *frame)
{
    begin(frame, TACTILE_REQUEST, 1, 5);
    put8(frame, 254);
}

static void tactile_event(struct frame *frame)
{
    begin(frame, TACTILE_EVENT, 1, 5);
    put8(frame, 2);
    put8(frame, 255);
    put8(frame, 1);
    put16(frame, 300);
    put16(frame, 4095);
    put32(frame, 4000000000u);
    put8(frame, 0);
}

static const struct {
    const char *name;
    void (*build)(struct frame *frame);
} examples[] = {
    {"Hello", hello},
    {"Identity", identity},
    {"Configure", configure},
    {"Configured", configured},
    {"Stop", stop},
    {"Stopped", stopped},
    {"Refused", refused},
    {"Command", command},
    {"Reply", reply},
    {"TactileRequest", tactile_request},
    {"TactileEvent", tactile_event},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

/* Returns what is wrong with the example, or NULL. */
static const char *check_example(int which, const uint8_t *wire, unsigned length)
{
    struct frame own, decoded;
    uint8_t encoded[WIRE_MAXIMUM];
    examples[which].build(&own);
    unsigned own_length = to_wire(&own, encoded);
    if (length == 0 || memchr(wire, 0, length) != wire + length - 1)
        return "is not ended by its only zero";
    if (!from_wire(wire, length - 1, &decoded))
        return "does not decode";
    if (decoded.length != frame_length(decoded.bytes[0] >> 4) || length != decoded.length + 2)
        return "does not have the length of its type";
    if (decoded.length != own.length || memcmp(decoded.bytes, own.bytes, own.length) != 0)
        return "is not what the text beside it says";
    if (own_length != length || memcmp(encoded, wire, length) != 0)
        return "is stuffed differently";
    return NULL;
}

/* The example that is being read from the page. */
struct reading {
    int which;
    unsigned length;
    uint8_t wire[WIRE_MAXIMUM];
    int found[EXAMPLES];
    int wrong;
};

static void begin_example(struct reading *reading, const char *name)
{
    reading->length = 0;
    for (reading->which = 0; reading->which < EXAMPLES; reading->which++)
        if (strcmp(name, examples[reading->which].name) == 0)
            return;
    printf("%s: no example has this name: add it to examples.c, or correct the name on the page\n", name);
    reading->wrong = 1;
    reading->which = -1;
}

static void end_example(struct reading *reading)
{
    const char *complaint = check_example(reading->which, reading->wire, reading->length);
    printf("%s: %s\n", examples[reading->which].name, complaint ? complaint : "agrees");
    reading->wrong |= complaint != NULL;
    reading->found[reading->which] = 1;
    reading->which = -1;
}

static void read_bytes(struct reading *reading, const char *text)
{
    unsigned value;
    int used;
    for (; sscanf(text, "%2x%n", &value, &used) == 1 && reading->length < WIRE_MAXIMUM; text += used)
        reading->wire[reading->length++] = (uint8_t)value;
}

int check_page(const char *path)
{
    struct reading reading = {.which = -1};
    char text[1024], name[32];
    FILE *page = fopen(path, "r");
    if (!page) {
        fprintf(stderr, "second_board: %s: %s\n", path, strerror(errno));
        return 1;
    }
    if (crc32_of((const uint8_t *)"123456789", 9) != 0xCBF43926u) {
        printf("the CRC-32 of 123456789 is not 0xCBF43926: correct crc32_of\n");
        reading.wrong = 1;
    }
    while (fgets(text, sizeof text, page)) {
        if (sscanf(text, "```hex %31s", name) == 1)
            begin_example(&reading, name);
        else if (strncmp(text, "```", 3) == 0 && reading.which >= 0)
            end_example(&reading);
        else if (reading.which >= 0)
            read_bytes(&reading, text);
    }
    fclose(page);
    for (int i = 0; i < EXAMPLES; i++)
        if (!reading.found[i]) {
            printf("%s: not on the page: add it to %s, or remove it from examples.c\n", examples[i].name, path);
            reading.wrong = 1;
        }
    return reading.wrong;
}
