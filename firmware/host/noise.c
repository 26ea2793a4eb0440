/* Runs the firmware with anything that a cable can deliver. Build it with -fsanitize=address,undefined.

       noise STREAMS SEED

   Each stream is a sequence of random bytes, or a sequence of frames, some of which are damaged. A pause follows some
   of the streams. The program always checks that answers are whole frames of this board, that no frame with a wrong
   checksum passes, and that no motor has torque unless it is enabled or holding. After some of the streams it also
   checks that the next good frame is answered, and that the watchdog trips in a long silence. */

#include "fake_hardware.h"
#include "../core/protocol.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state;

/* PCG32. */
static uint32_t any(void)
{
    uint64_t old = state;
    state = old * 6364136223846793005u + 1442695040888963407u;
    uint32_t shifted = (uint32_t)((old >> 18 ^ old) >> 27), turn = (uint32_t)(old >> 59);
    return shifted >> turn | shifted << (-turn & 31u);
}

static uint32_t below(uint32_t limit)
{
    return any() % limit;
}

static unsigned long long stream_number;

static void require(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "stream %llu: %s\n", stream_number, what);
    exit(1);
}

/* An independent implementation of the firmware's checksum: it works bit by bit. */
static uint32_t slow_check(const uint8_t *bytes, size_t length)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1u ? 0xEDB88320u : 0);
    }
    return ~crc;
}

static struct finger fingers[FAKE_FINGERS];
static struct board board;
static unsigned long long accepted, answered, enabled;

/* Writes a request whose fields are mostly valid. The firmware must also cope with invalid fields. */
static size_t some_request(uint8_t wire[WIRE_MOST])
{
    struct frame frame;
    static const uint8_t types[5] = {TYPE_HELLO, TYPE_CONFIGURE, TYPE_COMMAND, TYPE_STOP, TYPE_TACTILE_REQUEST};
    uint8_t type = below(8) == 0 ? (uint8_t)below(16) : types[below(5)];
    uint8_t address = (uint8_t)(below(8) == 0 ? below(16) : 1 + below(2));
    frame_begin(&frame, type, address, (uint8_t)any());
    if (type == TYPE_CONFIGURE && below(4) != 0) {
        frame_put8(&frame, PROTOCOL_VERSION);
        frame_put16(&frame, (uint16_t)(2 + below(30)));
        frame_put8(&frame, (uint8_t)below(2));
        frame_put16(&frame, (uint16_t)below(100));
        frame_put16(&frame, (uint16_t)any());
        for (size_t i = 0; i < MOTORS; i++)
            frame_put16(&frame, (uint16_t)below(30001));
        for (size_t i = 0; i < MOTORS; i++)
            frame_put32(&frame, below(3) == 0 ? 0 : any() >> below(32));
    } else {
        static const size_t lengths[TYPE_TACTILE_REQUEST + 1] = {
            [TYPE_HELLO] = HELLO_LENGTH,
            [TYPE_CONFIGURE] = CONFIGURE_LENGTH,
            [TYPE_COMMAND] = COMMAND_LENGTH,
            [TYPE_STOP] = STOP_LENGTH,
            [TYPE_TACTILE_REQUEST] = TACTILE_REQUEST_LENGTH,
        };
        bool exact = type <= TYPE_TACTILE_REQUEST && below(16) != 0;
        size_t length = exact ? lengths[type] : below(FRAME_MOST - FRAME_LEAST + 1);
        for (size_t i = 0; i < length; i++)
            frame_put8(&frame, (uint8_t)(below(2) == 0 ? below(4) : any()));
    }
    return frame_to_wire(&frame, wire);
}

static size_t damage(uint8_t *bytes, size_t length)
{
    size_t place = below((uint32_t)length);
    switch (below(4)) {
    case 0:
        bytes[place] ^= (uint8_t)(1u << below(8));
        return length;
    case 1:
        bytes[place] = (uint8_t)any();
        return length;
    case 2:
        memmove(bytes + place, bytes + place + 1, length - place - 1);
        return length - 1;
    default:
        return place;
    }
}

static void check_motors(void)
{
    for (unsigned n = 0; n < FAKE_FINGERS; n++) {
        bool may = fingers[n].state == FINGER_ENABLED || fingers[n].holding;
        for (size_t i = 0; i < MOTORS; i++) {
            int32_t current = fake.currents[n][i], torque = fingers[n].torques[i];
            require(may || (current == 0 && torque == 0), "torque on a motor that is off");
            require(abs(torque) <= fingers[n].terms.torque_limits[i], "torque beyond its limit");
            require(abs(current) <= fake_traits[n].largest_currents[i], "current beyond its limit");
        }
    }
}

/* Checks that the output consists of answers of this board only. */
static void check_output(void)
{
    struct receiver receiver = {0};
    const struct frame *frame = &receiver.frame;
    for (size_t i = 0; i < fake.output_length; i++) {
        enum received received = receiver_take(&receiver, fake.output[i]);
        require(received != RECEIVED_DAMAGE, "a damaged answer");
        if (received == RECEIVED_FRAME) {
            require((frame_type(frame) & TYPE_IS_ANSWER) != 0, "an answer that is a request");
            require(frame_address(frame) == 1 || frame_address(frame) == 2, "an answer of another finger");
            answered++;
        }
    }
    require(receiver.collected == 0, "half an answer");
    fake.output_length = 0;
}

static struct receiver observer;

static void arrive(const uint8_t *bytes, size_t length)
{
    const struct frame *frame = &observer.frame;
    for (size_t i = 0; i < length; i++) {
        if (receiver_take(&observer, bytes[i]) == RECEIVED_FRAME) {
            uint32_t check = frame_get32(frame, frame->length);
            require(slow_check(frame->bytes, frame->length) == check, "a frame with a wrong checksum passed");
            accepted++;
        }
    }
    /* The bytes arrive in pieces, as from a driver. */
    while (length > 0) {
        size_t piece = 1 + below((uint32_t)length);
        fake_arrive(&board, bytes, piece);
        check_output();
        check_motors();
        bytes += piece;
        length -= piece;
    }
    enabled += fingers[0].state == FINGER_ENABLED;
}

static void one_stream(void)
{
    static uint8_t bytes[2048];
    size_t length = 0;
    if (below(2) == 0) {
        length = below(400);
        for (size_t i = 0; i < length; i++)
            bytes[i] = (uint8_t)(below(16) == 0 ? 0 : any());
    } else {
        for (uint32_t frames = 1 + below(6); frames > 0; frames--) {
            size_t added = some_request(bytes + length);
            length += below(3) == 0 ? damage(bytes + length, added) : added;
        }
    }
    fake.faults = below(20) == 0 ? (uint16_t)any() : 0;
    arrive(bytes, length);
    if (below(4) == 0) {
        fake_wait(&board, below(40) * 1000);
        check_motors();
    }
    /* The delimiter ends any open frame, so the Hello after it must be answered. */
    static const uint8_t delimiter = 0, hello[] = {0x09, 0x11, 0x01, 0x01, 0x01, 0x06, 0x84, 0x3F, 0xA6, 0x00};
    if (below(4) == 0) {
        arrive(&delimiter, 1);
        unsigned long long before = answered;
        arrive(hello, sizeof hello);
        require(answered == before + 1, "a good frame was lost");
    }
    /* Silence longer than the longest watchdog and hold times together, 131 s, must stop every motor. */
    if (below(64) == 0) {
        fake_wait(&board, 132000000);
        for (unsigned n = 0; n < FAKE_FINGERS; n++)
            require(fingers[n].state != FINGER_ENABLED && !fingers[n].holding, "the watchdog did not trip");
    }
}

int main(int count, char **arguments)
{
    unsigned long long streams = count > 1 ? strtoull(arguments[1], NULL, 10) : 100000;
    state = count > 2 ? strtoull(arguments[2], NULL, 10) : 1;
    for (unsigned n = 0; n < FAKE_FINGERS; n++)
        finger_start(&fingers[n], &fake_traits[n], n);
    board_start(&board, 0, fingers, FAKE_FINGERS);
    for (stream_number = 0; stream_number < streams; stream_number++)
        one_stream();
    printf("%llu streams, %llu frames accepted, %llu answers, finger 1 was enabled at the end of %llu inputs\n",
           streams, accepted, answered, enabled);
    if (answered == 0 || enabled == 0) {
        const char *what = answered == 0 ? "no frame was answered" : "finger 1 was never enabled";
        fprintf(stderr, "%s: run more streams\n", what);
        return 1;
    }
    return 0;
}
