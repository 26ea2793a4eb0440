/* A board whose fingers are on one line. Their addresses are consecutive. */

#include "../core/board.h"
#include "../core/protocol.h"
#include "../cortex_m/line.h"
#include "plant.h"
#include "processor.h"
#include <string.h>

static const struct finger_traits common = {
    .firmware_version = {1, 0, 0},
    .counts_per_revolution = 2000,
    .gauge_bits = 12,
    .torque_unit = 2000,
    .torque_limit = 23750,
    .shortest_watchdog_ms = 2,
    .capabilities = CAPABILITY_HOLD | CAPABILITY_KEEPS_ZERO | CAPABILITY_EMERGENCY_STOP | CAPABILITY_TOGGLE_PIN |
                    CAPABILITY_TACTILE,
    .touch = {.elements = PLANT_ELEMENTS, .made = 50, .lost = 25, .step = 100},
    .torque_constants = {23400, 23400, 23400, 23400},
    .largest_currents = {2100000, 2100000, 2100000, 2100000},
};

int main(void)
{
    static struct finger_traits traits[PLANT_FINGERS];
    static struct finger fingers[PLANT_FINGERS];
    static struct board board;
    processor_start();
    plant_start();
    for (unsigned n = 0; n < PLANT_FINGERS; n++) {
        traits[n] = common;
        traits[n].address = (uint8_t)(FIRST_ADDRESS + n);
        memcpy(traits[n].unique_number, processor_name, sizeof processor_name);
        traits[n].unique_number[11] = traits[n].address;
        finger_start(&fingers[n], &traits[n], n);
    }
    board_start(&board, 0, fingers, PLANT_FINGERS);
    for (;;) {
        board_poll(&board);
        plant_poll();
        line_sleep();
    }
}
