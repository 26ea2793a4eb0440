/* From reset to main. The vector table of each processor refers to these handlers. */

#ifndef FIRMWARE_STARTUP_H
#define FIRMWARE_STARTUP_H

/* Handler for vector 1: initialises memory and calls main. */
void reset(void);

/* Implemented by each port. Handles a processor fault: removes the torque, and never returns. */
void processor_fault(void);

union vector {
    void *stack;
    void (*handler)(void);
};

/* The sixteen vectors of every Cortex-M, for the beginning of a vector table. */
#define CORTEX_M_VECTORS(first_stack)                                                                                  \
    {.stack = (first_stack)},                                                                                          \
        {.handler = reset},                                                                                            \
        {.handler = processor_fault},                                                                                  \
        {.handler = processor_fault},                                                                                  \
        {.handler = processor_fault},                                                                                  \
        {.handler = processor_fault},                                                                                  \
        {.handler = processor_fault},                                                                                  \
    [11] = {.handler = processor_fault},                                                                               \
    [14] = {.handler = processor_fault},                                                                               \
    [15] = {.handler = systick_interrupt}

#endif
