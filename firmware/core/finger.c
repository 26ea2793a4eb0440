#include "finger.h"
#include "protocol.h"
#include <string.h>

static void answer_begin(const struct finger *finger, const struct frame *request, uint8_t type, struct frame *answer)
{
    frame_begin(answer, type, finger->traits->address, frame_sequence(request));
}

void finger_refuse(const struct finger *finger, const struct frame *request, uint8_t reason, uint16_t detail,
                   struct frame *answer)
{
    answer_begin(finger, request, TYPE_REFUSED, answer);
    write_refused(answer, frame_type(request), reason, detail);
}

static int32_t clip(int32_t value, int32_t limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

/* Returns 1000 * rest / constant. It avoids a 64-bit division, which takes five times as long. `rest` is below
   `constant`. */
static uint32_t thousandths(uint32_t rest, uint32_t constant)
{
    if (constant <= UINT32_MAX / 1000u)
        return rest * 1000u / constant;
    /* The quotient is below 1000, and constant / 1000 loses less than a thousandth of its value to rounding. So the
       estimate is right or too large by 1. */
    uint32_t estimate = rest / (constant / 1000u);
    return (uint64_t)estimate * constant > (uint64_t)rest * 1000u ? estimate - 1 : estimate;
}

/* Returns the current for a torque, uA. The quotient of nN m and uN m/A is in mA. Torque and current are both without
   a sign, and `magnitude` is at most 2^15. */
static uint64_t current_of(uint32_t magnitude, uint32_t unit, uint32_t constant)
{
    uint64_t product = (uint64_t)magnitude * unit;
    if (product > UINT32_MAX)
        /* The dividend is at most 2^15 * 2^32 * 1000, which fits 64 bits. */
        return product * 1000u / constant;
    uint32_t whole = (uint32_t)product / constant;
    return (uint64_t)whole * 1000u + thousandths((uint32_t)product % constant, constant);
}

/* Clamps torques to `limits` and to the currents that the drivers allow, and sets the motor currents. Returns true
   if a torque was clamped. */
static bool drive(struct finger *finger, const int16_t wanted[MOTORS], const uint16_t limits[MOTORS])
{
    bool clipped = false;
    int32_t currents[MOTORS];
    for (size_t i = 0; i < MOTORS; i++) {
        uint32_t constant = finger->terms.torque_constants[i];
        if (constant == 0)
            constant = finger->traits->torque_constants[i];
        int32_t torque = clip(wanted[i], limits[i]);
        uint64_t current = current_of((uint32_t)(torque < 0 ? -torque : torque), finger->traits->torque_unit, constant);
        uint32_t most = (uint32_t)finger->traits->largest_currents[i];
        int32_t permitted = (int32_t)(current > most ? most : current);
        finger->torques[i] = (int16_t)torque;
        currents[i] = torque < 0 ? -permitted : permitted;
        clipped = clipped || torque != wanted[i] || current > most;
    }
    hal_set_currents(finger->index, currents);
    return clipped;
}

static void motors_off(struct finger *finger)
{
    static const int32_t none[MOTORS] = {0};
    memset(finger->torques, 0, sizeof finger->torques);
    finger->holding = false;
    hal_set_currents(finger->index, none);
}

void finger_start(struct finger *finger, const struct finger_traits *traits, unsigned index)
{
    memset(finger, 0, sizeof *finger);
    finger->traits = traits;
    finger->index = index;
    finger->state = FINGER_IDLE;
    motors_off(finger);
}

/* Enters the end state from ready or enabled. */
static void end(struct finger *finger, uint32_t now)
{
    const struct configure *terms = &finger->terms;
    bool hold = finger->state == FINGER_ENABLED && terms->end_state == END_STATE_HOLD && terms->hold_time_ms > 0;
    finger->state = FINGER_ENDED;
    if (hold) {
        uint16_t limits[MOTORS];
        int16_t torques[MOTORS];
        for (size_t i = 0; i < MOTORS; i++)
            limits[i] = finger->terms.hold_torque_limit;
        memcpy(torques, finger->torques, sizeof torques);
        drive(finger, torques, limits);
        finger->holding = true;
        finger->held_since = now;
    } else {
        motors_off(finger);
    }
}

/* Returns whether more than `milliseconds` lie between two instants. The difference is taken as signed, because
   `now` may be slightly older than `since`: the main loop may read the clock before the last bytes arrive. The longest
   time, 65 535 ms, is far below the 71 minutes after which the timer wraps. */
static bool passed(uint32_t since, uint32_t now, uint16_t milliseconds)
{
    uint32_t elapsed = now - since;
    return elapsed < 0x80000000u && elapsed > 1000u * (uint32_t)milliseconds;
}

/* Returns the faults that are present. A fault is stored and takes the torque off. The hardware may report a short
   fault only once, so no other function may read the faults. */
static uint16_t take_faults(struct finger *finger)
{
    uint16_t faults = hal_faults(finger->index) & STATUS_FAULTS;
    if (faults != 0) {
        finger->latched |= faults;
        motors_off(finger);
        if (finger->state != FINGER_IDLE)
            finger->state = FINGER_ENDED;
    }
    return faults;
}

void finger_tick(struct finger *finger, uint32_t now)
{
    take_faults(finger);
    if (finger->state == FINGER_ENABLED && passed(finger->commanded_at, now, finger->terms.watchdog_ms)) {
        finger->latched |= STATUS_WATCHDOG_TRIPPED;
        end(finger, now);
    }
    if (finger->holding && passed(finger->held_since, now, finger->terms.hold_time_ms))
        motors_off(finger);
    if (finger->traits->capabilities & CAPABILITY_TACTILE)
        touch_scan(&finger->touch, &finger->traits->touch, finger->index, now);
}

static uint16_t status(const struct finger *finger)
{
    unsigned bits = finger->latched;
    if (finger->state != FINGER_IDLE)
        bits |= STATUS_CONFIGURED;
    if (finger->state == FINGER_ENABLED)
        bits |= STATUS_ENABLED;
    if (finger->state == FINGER_ENDED)
        bits |= STATUS_ENDED;
    if (finger->holding)
        bits |= STATUS_HOLDING;
    if (finger->traits->capabilities & CAPABILITY_KEEPS_ZERO)
        bits |= STATUS_ZERO_VALID;
    return (uint16_t)bits;
}

void finger_hello(struct finger *finger, const struct frame *request, uint16_t addresses, struct frame *answer)
{
    struct hello hello;
    read_hello(request, &hello);
    if (hello.lowest_version > PROTOCOL_VERSION || hello.highest_version < PROTOCOL_VERSION) {
        finger_refuse(finger, request, REASON_VERSION, PROTOCOL_VERSION | PROTOCOL_VERSION << 8, answer);
        return;
    }
    const struct finger_traits *traits = finger->traits;
    struct identity identity = {
        .version = PROTOCOL_VERSION,
        .addresses = addresses,
        .kind = KIND_REFERENCE_FIRMWARE,
        .counts_per_revolution = traits->counts_per_revolution,
        .gauge_bits = traits->gauge_bits,
        .torque_unit = traits->torque_unit,
        .torque_limit = traits->torque_limit,
        .shortest_watchdog_ms = traits->shortest_watchdog_ms,
        .capabilities = traits->capabilities,
    };
    memcpy(identity.unique_number, traits->unique_number, sizeof identity.unique_number);
    memcpy(identity.firmware_version, traits->firmware_version, sizeof identity.firmware_version);
    answer_begin(finger, request, TYPE_IDENTITY, answer);
    write_identity(answer, &identity);
}

/* Returns the offset of the first field that this board cannot carry out, or 0 if it can carry out all of them. */
static uint16_t wrong_field(const struct finger_traits *traits, const struct configure *terms)
{
    if (terms->version != PROTOCOL_VERSION)
        return FIELD_VERSION;
    if (terms->watchdog_ms < traits->shortest_watchdog_ms)
        return FIELD_WATCHDOG;
    bool can_hold = (traits->capabilities & CAPABILITY_HOLD) != 0;
    if (terms->end_state > END_STATE_HOLD || (terms->end_state == END_STATE_HOLD && !can_hold))
        return FIELD_END_STATE;
    for (uint16_t i = 0; i < MOTORS; i++)
        if (terms->torque_limits[i] > traits->torque_limit)
            return (uint16_t)(FIELD_TORQUE_LIMITS + 2 * i);
    return 0;
}

void finger_configure(struct finger *finger, const struct frame *request, struct frame *answer)
{
    struct configure terms;
    read_configure(request, &terms);
    uint16_t faults = take_faults(finger);
    uint16_t wrong = wrong_field(finger->traits, &terms);
    if (finger->state == FINGER_ENABLED) {
        finger_refuse(finger, request, REASON_RUNNING, 0, answer);
    } else if (faults != 0) {
        finger_refuse(finger, request, REASON_FAULT, faults, answer);
    } else if (wrong != 0) {
        finger_refuse(finger, request, REASON_VALUE, wrong, answer);
    } else {
        finger->terms = terms;
        finger->latched = 0;
        finger->state = FINGER_READY;
        motors_off(finger);
        struct sensors sensors;
        hal_sample(finger->index, &sensors);
        answer_begin(finger, request, TYPE_CONFIGURED, answer);
        write_configured(answer, &terms, &sensors, status(finger));
    }
}

void finger_command(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer)
{
    if (finger->state == FINGER_IDLE) {
        finger_refuse(finger, request, REASON_NOT_CONFIGURED, 0, answer);
        return;
    }
    struct command command;
    read_command(request, &command);
    hal_set_toggle(finger->index, command.toggle);
    /* The sensors are sampled before the torques are set, so that they show the effect of the previous torques. */
    struct sensors sensors;
    uint32_t sampled_at = hal_microseconds();
    hal_sample(finger->index, &sensors);
    bool clipped = false;
    if (finger->state != FINGER_ENDED && command.enable) {
        finger->state = FINGER_ENABLED;
        finger->commanded_at = now;
        clipped = drive(finger, command.torques, finger->terms.torque_limits);
    } else if (finger->state != FINGER_ENDED) {
        finger->state = FINGER_READY;
        motors_off(finger);
    }
    uint16_t reported = status(finger);
    if (clipped)
        reported |= STATUS_TORQUE_CLIPPED;
    if (finger->damaged)
        reported |= STATUS_DAMAGED_INPUT;
    finger->damaged = false;
    answer_begin(finger, request, TYPE_REPLY, answer);
    write_reply(answer, reported, &sensors, (uint16_t)(sampled_at & 0xFFFFu));
}

void finger_touch(struct finger *finger, const struct frame *request, struct frame *answer)
{
    if ((finger->traits->capabilities & CAPABILITY_TACTILE) == 0) {
        finger_refuse(finger, request, REASON_UNKNOWN_FRAME, TACTILE_REQUEST_LENGTH, answer);
        return;
    }
    struct tactile_event event = touch_fetch(&finger->touch, frame_get8(request, 2));
    answer_begin(finger, request, TYPE_TACTILE_EVENT, answer);
    write_tactile_event(answer, &event);
}

void finger_stop(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer)
{
    /* A second Stop does not prolong a hold. */
    if (finger->state == FINGER_READY || finger->state == FINGER_ENABLED)
        end(finger, now);
    answer_begin(finger, request, TYPE_STOPPED, answer);
    write_stopped(answer, status(finger));
}
