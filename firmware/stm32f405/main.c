/* A board for one finger, on an STM32F405. */

#include "../core/board.h"
#include "../core/protocol.h"
#include "../cortex_m/startup.h"
#include "../cortex_m/systick.h"
#include "clock.h"
#include "parts.h"
#include "serial.h"
#include <string.h>

/* Address of the finger. Set with `make ADDRESS=...`. */
#ifndef ADDRESS
#define ADDRESS 1
#endif

/* Adapt these values to the motors, drivers and gauges of the finger. */
static const struct finger_traits common = {
    .address = ADDRESS,
    .firmware_version = {1, 0, 0},
    .counts_per_revolution = 2000,
    .gauge_bits = 16,
    .torque_unit = 2000,
    .torque_limit = 23750,
    .shortest_watchdog_ms = 2,
    .capabilities = CAPABILITY_HOLD | CAPABILITY_EMERGENCY_STOP | CAPABILITY_TOGGLE_PIN,
    .torque_constants = {23400, 23400, 23400, 23400},
    .largest_currents = {2100000, 2100000, 2100000, 2100000},
};

/* Symbol of the linker script. */
extern const uint8_t processor_unique_number[12];

/* Handles processor faults, and the NMI that reports a failed crystal. The loop ends when the independent watchdog
   resets the processor. */
void processor_fault(void)
{
    drivers_off();
    for (;;)
        ;
}

int main(void)
{
    static struct finger_traits traits;
    static struct finger finger;
    static struct board board;
    /* The watchdog starts first, so that it also ends a hang in what follows. */
    watchdog_start();
    pins_start();
    drivers_start();
    uint32_t megahertz = clock_start();
    watchdog_feed();
    systick_start(megahertz);
    encoders_start();
    gauges_start();
    faults_start(megahertz == 168);
    traits = common;
    memcpy(traits.unique_number, processor_unique_number, sizeof traits.unique_number);
    finger_start(&finger, &traits, 0);
    board_start(&board, 0, &finger, 1);
    serial_start(megahertz == 168 ? megahertz / 2 : megahertz);
    for (;;) {
        board_poll(&board);
        sensors_poll();
        watchdog_feed();
    }
}
