/* The pins of the board, as a list for pins.c and for the table in README.md.

   PIN(port, number, mode, alternate, pull, name, signal, connection). `name` is how the sources refer to the pin. An
   alternate function of 0 means none. The alternate functions are those of table 9 in the processor's data sheet. */

#ifndef FIRMWARE_PINS_H
#define FIRMWARE_PINS_H

#include <stdint.h>

/* Sections 8.4.1 (mode) and 8.4.4 (pull) of the chip's reference manual, RM0090. */
enum pin_mode { INPUT = 0, OUTPUT = 1, ALTERNATE = 2 };
enum pin_pull { NO_PULL = 0, PULL_UP = 1, PULL_DOWN = 2 };

#define PINS(PIN)                                                                                                      \
    PIN(A, 9, ALTERNATE, 7, NO_PULL, TRANSMIT, "USART1_TX", "serial line to the host")                                 \
    PIN(A, 10, ALTERNATE, 7, PULL_UP, RECEIVE, "USART1_RX", "serial line from the host")                               \
    PIN(A, 15, ALTERNATE, 1, NO_PULL, ENCODER_1A, "TIM2_CH1", "encoder 1, A")                                          \
    PIN(B, 3, ALTERNATE, 1, NO_PULL, ENCODER_1B, "TIM2_CH2", "encoder 1, B")                                           \
    PIN(A, 0, ALTERNATE, 2, NO_PULL, ENCODER_2A, "TIM5_CH1", "encoder 2, A")                                           \
    PIN(A, 1, ALTERNATE, 2, NO_PULL, ENCODER_2B, "TIM5_CH2", "encoder 2, B")                                           \
    PIN(B, 4, ALTERNATE, 2, NO_PULL, ENCODER_3A, "TIM3_CH1", "encoder 3, A")                                           \
    PIN(B, 5, ALTERNATE, 2, NO_PULL, ENCODER_3B, "TIM3_CH2", "encoder 3, B")                                           \
    PIN(B, 6, ALTERNATE, 2, NO_PULL, ENCODER_4A, "TIM4_CH1", "encoder 4, A")                                           \
    PIN(B, 7, ALTERNATE, 2, NO_PULL, ENCODER_4B, "TIM4_CH2", "encoder 4, B")                                           \
    PIN(C, 6, ALTERNATE, 3, PULL_DOWN, CURRENT_1, "TIM8_CH1", "current reference 1, through the filter")               \
    PIN(C, 7, ALTERNATE, 3, PULL_DOWN, CURRENT_2, "TIM8_CH2", "current reference 2, through the filter")               \
    PIN(C, 8, ALTERNATE, 3, PULL_DOWN, CURRENT_3, "TIM8_CH3", "current reference 3, through the filter")               \
    PIN(C, 9, ALTERNATE, 3, PULL_DOWN, CURRENT_4, "TIM8_CH4", "current reference 4, through the filter")               \
    PIN(C, 0, OUTPUT, 0, PULL_DOWN, DIRECTION_1, "output", "direction of driver 1; high is positive")                  \
    PIN(C, 1, OUTPUT, 0, PULL_DOWN, DIRECTION_2, "output", "direction of driver 2; high is positive")                  \
    PIN(C, 2, OUTPUT, 0, PULL_DOWN, DIRECTION_3, "output", "direction of driver 3; high is positive")                  \
    PIN(C, 3, OUTPUT, 0, PULL_DOWN, DIRECTION_4, "output", "direction of driver 4; high is positive")                  \
    PIN(C, 4, OUTPUT, 0, PULL_DOWN, ENABLE, "output", "enable of all four drivers; 4.7 kOhm to ground")                \
    PIN(A, 6, ALTERNATE, 3, PULL_UP, STOP, "TIM8_BKIN", "emergency stop contact: low runs, high or open stops")        \
    PIN(C, 10, INPUT, 0, PULL_UP, DRIVER_FAULT, "input", "fault outputs of the drivers, open drain; low is a fault")   \
    PIN(C, 11, INPUT, 0, PULL_DOWN, SUPPLY_GOOD, "input", "motor supply; high is good, low or open is a fault")        \
    PIN(B, 13, ALTERNATE, 5, NO_PULL, GAUGE_CLOCK, "SPI2_SCK", "converter, SCLK")                                      \
    PIN(B, 14, ALTERNATE, 5, PULL_UP, GAUGE_DATA, "SPI2_MISO", "converter, DOUTA")                                     \
    PIN(B, 12, OUTPUT, 0, PULL_UP, GAUGE_SELECT, "output", "converter, CS; low selects")                               \
    PIN(B, 1, OUTPUT, 0, PULL_DOWN, GAUGE_CONVERT, "output", "converter, CONVST A and B; rising edge samples")         \
    PIN(B, 15, OUTPUT, 0, PULL_DOWN, GAUGE_RESET, "output", "converter, RESET; high resets")                           \
    PIN(B, 0, INPUT, 0, PULL_DOWN, GAUGE_BUSY, "input", "converter, BUSY")                                             \
    PIN(C, 12, OUTPUT, 0, PULL_DOWN, TOGGLE, "output", "toggle bit, for an oscilloscope")

/* Defines PIN_<name> for each pin: the number of the pin within its port. */
#define PIN_NUMBER(port, number, mode, alternate, pull, name, signal, connection) PIN_##name = number,
enum { PINS(PIN_NUMBER) };
#undef PIN_NUMBER

#endif
